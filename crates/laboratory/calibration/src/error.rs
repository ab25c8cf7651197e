//! Why a calibration cannot go on.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// A place in a file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Location {
    /// The file, as it was named.
    pub file: String,
    /// Line and column, from 1; a column of 0 is not known.
    pub at: Option<(usize, usize)>,
}

impl Location {
    /// A line of a file, from 1.
    pub fn line(file: &str, line: usize) -> Location {
        Location { file: file.to_owned(), at: Some((line, 0)) }
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.at {
            Some((line, 0)) => write!(f, "{}:{line}", self.file),
            Some((line, column)) => write!(f, "{}:{line}:{column}", self.file),
            None => f.write_str(&self.file),
        }
    }
}

/// Why a calibration cannot go on.
#[derive(Debug, Error)]
pub enum CalibrateError {
    #[error("{0}")]
    Usage(String),
    #[error("{place}: {message}")]
    Recipe { place: Location, message: String },
    #[error("{place}: {message}")]
    Data { place: Location, message: String },
    #[error("{}: {what}", .path.display())]
    File { path: PathBuf, what: &'static str, source: io::Error },
    #[error("{}: {message}", .folder.display())]
    Folder { folder: PathBuf, message: String },
    #[error("test '{test}': {message}")]
    Test { test: String, message: String },
    #[error("{0}")]
    Failed(String),
    #[error("stopped by a signal: {done} runs are finished: the same command continues")]
    Signal { done: usize },
}

/// What can fail in a calibration.
pub type Result<T, E = CalibrateError> = std::result::Result<T, E>;

/// Turns the error of a file into one that names it.
pub(crate) fn file<'a>(path: &'a Path, what: &'static str) -> impl FnOnce(io::Error) -> CalibrateError + 'a {
    move |source| CalibrateError::File { path: path.to_owned(), what, source }
}

/// `; did you mean 'x'?` for the nearest known name, or the list of known names.
pub(crate) fn hint<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    match scene::nearest(name, known.clone()) {
        Some(near) => format!("; did you mean '{near}'?"),
        None => format!("; known here: {}", known.collect::<Vec<_>>().join(", ")),
    }
}
