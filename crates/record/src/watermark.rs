//! Messages of the topic `/crossings/watermark`.

use crate::{RecordError, topic};
use serde::{Deserialize, Serialize};

/// No crossing comes after this message that is earlier than `until`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Watermark {
    /// Time [s].
    pub until: f64,
}

impl Watermark {
    /// The message.
    pub fn to_json(self) -> Vec<u8> {
        crate::json(&self).into_bytes()
    }

    /// The watermark of a message.
    ///
    /// # Errors
    /// Other JSON than is wanted.
    pub fn read(stream: &str, data: &[u8]) -> Result<Watermark, RecordError> {
        let wrong = |e| {
            RecordError::new(stream, format!("{}: {e}", topic::WATERMARK), "wanted: {\"until\": seconds}")
        };
        serde_json::from_slice(data).map_err(wrong)
    }
}
