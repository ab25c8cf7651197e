//! Errors of stages.

use record::RecordError;
use scene::SceneError;
use stream::mcap::McapError;
use thiserror::Error;

/// Why a stage failed.
#[derive(Debug, Error)]
pub enum StageError {
    #[error("{0}")]
    Scene(#[from] SceneError),
    #[error("{0}")]
    Mcap(#[from] McapError),
}

impl From<RecordError> for StageError {
    fn from(error: RecordError) -> StageError {
        StageError::Scene(error.into())
    }
}
