//! Errors of a run.

use dem::{Halt, SetupError};
use record::RecordError;
use scene::{SceneError, SceneSetupError};
use stream::mcap::McapError;
use thiserror::Error;

/// Why a run failed.
#[derive(Debug, Error)]
pub enum RunError {
    #[error("{0}")]
    Scene(#[from] SceneError),
    #[error("{0}")]
    Setup(#[from] SceneSetupError),
    #[error("{0}")]
    Mcap(#[from] McapError),
    #[error("{0}")]
    State(#[from] stream::state::StateError),
}

/// What can fail in a run.
pub type Result<T, E = RunError> = std::result::Result<T, E>;

impl From<RecordError> for RunError {
    fn from(error: RecordError) -> RunError {
        RunError::Scene(error.into())
    }
}

impl From<SetupError> for RunError {
    fn from(error: SetupError) -> RunError {
        RunError::Setup(error.into())
    }
}

/// Why a frame could not be written.
pub(crate) enum Ended {
    /// A guard of the engine.
    Guard(Halt),
    /// An input or an output.
    Failed(RunError),
}

impl From<Halt> for Ended {
    fn from(halt: Halt) -> Ended {
        Ended::Guard(halt)
    }
}

impl<E: Into<RunError>> From<E> for Ended {
    fn from(error: E) -> Ended {
        Ended::Failed(error.into())
    }
}
