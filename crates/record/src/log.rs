//! Messages of the topic `/log`.

use serde::{Deserialize, Serialize};

/// Why a run was stopped that a signal ended.
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
}

impl LogMessage {
    /// Something that the user should know.
    pub fn note(time: f64, text: &str) -> LogMessage {
        LogMessage { kind: "note".to_owned(), text: text.to_owned(), time }
    }

    /// Why a run was stopped.
    pub fn stopped(time: f64, text: &str) -> LogMessage {
        LogMessage { kind: STOPPED.to_owned(), text: text.to_owned(), time }
    }

    /// Whether it says that the run was stopped.
    pub fn is_stop(&self) -> bool {
        self.kind == STOPPED
    }
}
