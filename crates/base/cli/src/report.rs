//! The report of a tool: one summary line, and fields for `--report`.

use serde::Serialize;
use serde_json::{Map, Value};

/// What was done.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Report {
    /// One line for stderr, without the tool's name.
    pub summary: String,
    /// Counts, sizes and settings, in the order of the file.
    pub fields: Map<String, Value>,
}

impl Report {
    /// A report that so far is only its summary line.
    pub fn new(summary: impl Into<String>) -> Report {
        Report { summary: summary.into(), fields: Map::new() }
    }

    /// Adds a field; what cannot be JSON (a number that is not finite) becomes null.
    pub fn with(mut self, key: &str, value: impl Serialize) -> Report {
        self.fields.insert(key.to_owned(), serde_json::to_value(value).unwrap_or(Value::Null));
        self
    }

    /// Adds every field of a struct or map.
    pub fn with_all(mut self, fields: &impl Serialize) -> Report {
        if let Ok(Value::Object(map)) = serde_json::to_value(fields) {
            self.fields.extend(map);
        }
        self
    }
}
