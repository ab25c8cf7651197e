//! Why a record or table cannot be used.

use thiserror::Error;

/// A file that holds something else than wanted.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{name}: {why}; {cure}")]
pub struct RecordError {
    /// The file or stream.
    pub name: String,
    /// What is wrong.
    pub why: String,
    /// What to do.
    pub cure: String,
}

impl RecordError {
    /// An error of the stream `name`.
    pub fn new(name: &str, why: impl Into<String>, cure: impl Into<String>) -> RecordError {
        RecordError { name: name.to_owned(), why: why.into(), cure: cure.into() }
    }
}

/// A positive number of a metadata record.
///
/// # Errors
/// A key that is missing, or not a positive number.
pub fn positive(stream: &str, record: &str, map: &crate::Map, key: &str) -> Result<f64, RecordError> {
    let value = map.get(key).and_then(|t| t.parse::<f64>().ok()).filter(|v| *v > 0.0 && v.is_finite());
    value.ok_or_else(|| {
        let found = map.get(key).map_or("nothing", String::as_str);
        let why = format!("record '{record}': {key} = {found}");
        RecordError::new(stream, why, "expected a number above 0")
    })
}
