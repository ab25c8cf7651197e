//! The origin of a stream: tool, version, arguments, inputs.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Name of the metadata record.
pub const PROVENANCE: &str = "provenance";

/// What made a stream. It names no time, host or path, so the same input gives the same bytes.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Provenance {
    /// Name of the tool.
    pub tool: String,
    /// Version of the tool.
    pub version: String,
    /// Arguments that can change the result.
    pub arguments: Vec<String>,
    /// Role and SHA-256 of each input.
    pub inputs: Vec<(String, String)>,
}

impl Provenance {
    /// As a metadata record.
    pub fn to_map(&self) -> BTreeMap<String, String> {
        // Lists of text always are JSON.
        let arguments = serde_json::to_string(&self.arguments).unwrap_or_default();
        let inputs = serde_json::to_string(&self.inputs).unwrap_or_default();
        BTreeMap::from([
            ("tool".to_owned(), self.tool.clone()),
            ("version".to_owned(), self.version.clone()),
            ("arguments".to_owned(), arguments),
            ("inputs".to_owned(), inputs),
        ])
    }

    /// From a metadata record; what is missing or not understood stays empty.
    pub fn from_map(map: &BTreeMap<String, String>) -> Provenance {
        let text = |key: &str| map.get(key).cloned().unwrap_or_default();
        Provenance {
            tool: text("tool"),
            version: text("version"),
            arguments: serde_json::from_str(&text("arguments")).unwrap_or_default(),
            inputs: serde_json::from_str(&text("inputs")).unwrap_or_default(),
        }
    }
}
