//! What a laboratory test refuses, and what can go wrong while it runs.

use record::StopCause;
use scene::{Place, SceneError, SceneSetupError};
use std::path::PathBuf;
use thiserror::Error;

/// The result of most functions here.
pub type Result<T> = std::result::Result<T, LabError>;

/// Why a laboratory test failed.
#[derive(Debug, Error)]
pub enum LabError {
    /// The command line asks for something that cannot be.
    #[error("{0}")]
    Usage(String),
    /// The sample has a key that the test itself sets, or lacks one.
    #[error("{file}: {what}: {cure}")]
    Sample { file: String, what: String, cure: String },
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A sample whose grains the engine refuses.
    #[error("{place}: {source}")]
    Setup { place: Place, source: Box<SceneSetupError> },
    #[error("{}: {what}", .file.display())]
    File { file: PathBuf, what: &'static str, source: std::io::Error },
    /// A file that a program has written, but not as expected.
    #[error("{}: {what}", .file.display())]
    Content { file: PathBuf, what: String },
    #[error("{program}: cannot be started: install it beside lab-test")]
    Start { program: String, source: std::io::Error },
    /// A program that failed, with its last line.
    #[error("{specimen}: {program} {how}: {words}")]
    Program { specimen: String, program: String, how: String, words: String },
    /// A guard has stopped the run of a specimen.
    #[error("{run}: stopped by a guard at {reached}: {why}")]
    Stopped { run: String, reached: String, why: String, cause: StopCause },
    #[error("cannot start threads")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    #[error(
        "{}: another process makes a specimen there with another sample, other options or programs: wait for its end, or give another --dir", .folder.display()
    )]
    Busy { folder: PathBuf },
    #[error("a signal has stopped a program")]
    Interrupted,
    #[error("stopped by a signal: {done} of {all} specimens are finished")]
    Signal { done: usize, all: usize },
}

impl LabError {
    pub(crate) fn file(
        file: impl Into<PathBuf>,
        what: &'static str,
    ) -> impl FnOnce(std::io::Error) -> LabError {
        let file = file.into();
        move |source| LabError::File { file, what, source }
    }
}
