//! What can go wrong with a run on LAMMPS.

use crate::refusal::Refusal;
use run::RunError;
use scene::{SceneError, SceneSetupError};
use thiserror::Error;

/// Why a run on LAMMPS failed.
#[derive(Debug, Error)]
#[allow(missing_docs)]
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
    #[error(
        "{folder}: holds something else than this run: give another --dir, or remove it (another scene, LAMMPS or number of grains is another run)"
    )]
    OtherDeck { folder: String },
    #[error("LAMMPS {how} at t = {time} s: {words}")]
    Died { how: String, time: geom::Shown, words: String },
    #[error("the dump of LAMMPS is wrong after t = {time} s: {what}")]
    Dump { time: geom::Shown, what: String },
}

/// What can fail with LAMMPS.
pub type Result<T, E = LammpsError> = std::result::Result<T, E>;
