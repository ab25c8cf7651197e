//! What several test programs ask.

use cloud::from_bytes;

/// The error and its causes on one line.
pub fn refused(bytes: impl AsRef<[u8]>) -> String {
    let error = from_bytes(bytes.as_ref().to_vec()).unwrap_err();
    let mut text = error.to_string();
    let mut cause = std::error::Error::source(&error);
    while let Some(c) = cause {
        text += &format!(": {c}");
        cause = c.source();
    }
    text
}
