//! Messages of the topics `/log` and `/crossings/watermark`.

use crate::{RecordError, StopCause, topic};
use serde::{Deserialize, Serialize};

/// The text of a message about a run that a signal stopped; what stopped it is in [`LogMessage::stop`].
pub const SIGNAL: &str = "by a signal";

/// `kind` of a message that says why a run was stopped.
const STOPPED: &str = "stopped";

/// A message of the topic [`crate::topic::LOG`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LogMessage {
    /// `note`, or `stopped`.
    pub kind: String,
    /// The text.
    pub text: String,
    /// Simulated time [s].
    pub time: f64,
    /// What stopped the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stop: Option<StopCause>,
}

impl LogMessage {
    /// Something that the user should know.
    pub fn note(time: f64, text: &str) -> LogMessage {
        LogMessage { kind: "note".to_owned(), text: text.to_owned(), time, stop: None }
    }

    /// Why a run was stopped.
    pub fn stopped(time: f64, text: &str, cause: StopCause) -> LogMessage {
        LogMessage { kind: STOPPED.to_owned(), text: text.to_owned(), time, stop: Some(cause) }
    }

    /// The message of some bytes that says why the run was stopped, if they do.
    pub fn read_stop(data: &[u8]) -> Option<LogMessage> {
        serde_json::from_slice(data).ok().filter(LogMessage::is_stop)
    }

    /// Whether it says that the run was stopped.
    pub fn is_stop(&self) -> bool {
        self.kind == STOPPED
    }
}

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
            RecordError::new(stream, format!("{}: {e}", topic::WATERMARK), "expected {\"until\": seconds}")
        };
        serde_json::from_slice(data).map_err(wrong)
    }
}
