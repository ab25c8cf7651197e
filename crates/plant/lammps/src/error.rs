//! What can go wrong with a run on LAMMPS.

use run::RunError;
use scene::{SceneError, SceneSetupError};
use std::fmt;
use thiserror::Error;

/// Why a run on LAMMPS failed.
#[derive(Debug, Error)]
pub enum LammpsError {
    #[error("LAMMPS cannot run this scene: {}", .0.iter().map(Refusal::to_string).collect::<Vec<_>>().join("; "))]
    Cannot(Vec<Refusal>),
    #[error("{0}")]
    Scene(#[from] SceneError),
    #[error("{0}")]
    Setup(#[from] SceneSetupError),
    #[error("{0}")]
    Run(#[from] RunError),
    #[error(
        "{program}: cannot start it ({error}): install LAMMPS (Debian: apt install lammps), or name it with --lmp PROGRAM"
    )]
    Start { program: String, error: std::io::Error },
    #[error("{program}: is not LAMMPS: '{program} -h' does not print a version")]
    NotLammps { program: String },
    #[error("{folder}: cannot write the deck: {error}")]
    Deck { folder: String, error: std::io::Error },
    #[error("{folder}: cannot use the folder: {error}")]
    Folder { folder: String, error: std::io::Error },
    #[error("{folder}: holds another run: {what}: give another folder")]
    OtherDeck { folder: String, what: String },
    #[error(
        "{folder}: another dem-lammps works there, or the LAMMPS of one that was killed, which ends soon: wait, or end it"
    )]
    Busy { folder: String },
    #[error("LAMMPS {how} at t = {time} s: {words}")]
    Died { how: String, time: geom::Shown, words: String },
    #[error("the dump of LAMMPS is wrong after t = {time} s: {what}")]
    Dump { time: geom::Shown, what: String },
}

/// What can fail with LAMMPS.
pub type Result<T, E = LammpsError> = std::result::Result<T, E>;

/// Something that LAMMPS cannot do.
#[derive(Debug, Clone, PartialEq)]
pub struct Refusal {
    /// Key or name in the scene.
    pub what: String,
    pub why: String,
    /// The nearest that LAMMPS can do, as an instruction.
    pub nearest: String,
}

impl Refusal {
    pub fn new(what: impl Into<String>, why: impl Into<String>, nearest: impl Into<String>) -> Refusal {
        Refusal { what: what.into(), why: why.into(), nearest: nearest.into() }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}: {}: {}", self.what, self.why, self.nearest)
    }
}
