//! Errors of a run.

use dem::SetupError;
use record::RecordError;
use scene::SceneError;
use stream::mcap::McapError;
use thiserror::Error;

/// Why a run failed.
#[derive(Debug, Error)]
#[allow(missing_docs)]
pub enum RunError {
    #[error("{0}")]
    Scene(#[from] SceneError),
    #[error("{0}")]
    Setup(#[from] SetupError),
    #[error("{0}")]
    Mcap(#[from] McapError),
    #[error("{0}")]
    State(#[from] stream::state::StateError),
}

impl From<RecordError> for RunError {
    fn from(error: RecordError) -> RunError {
        RunError::Scene(error.into())
    }
}
