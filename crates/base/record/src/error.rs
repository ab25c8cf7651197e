//! Why a record or table cannot be used.

use crate::name;
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

/// Refuses a name with control characters; `place` says where in the stream it stands.
///
/// # Errors
/// Such a name.
pub(crate) fn check_name(stream: &str, place: &str, name: &str) -> Result<(), RecordError> {
    let Some(c) = name::forbidden(name) else { return Ok(()) };
    let why = format!("{place}: the name {name:?} has {}", name::in_words(c));
    Err(RecordError::new(stream, why, name::CURE))
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
