//! The record `materials`: a JSON object for each index.

use crate::{Map, RecordError};
use serde::{Deserialize, Serialize};

/// One material of a stream; absent values were not set.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MaterialRecord {
    /// Name, by which scenes speak of it.
    pub name: String,
    /// Density [kg/m³].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
    /// Young's modulus [Pa].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub young: Option<f64>,
    /// Poisson's ratio [–].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub poisson: Option<f64>,
    /// Sliding friction against particles [–].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// Restitution against particles [–].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
}

/// The range of Poisson's ratio in words, for messages.
pub const POISSON: &str = "above -1 and at most 0.5";

/// Whether a number can be Poisson's ratio: that of a stable, isotropic, elastic solid.
pub fn is_poisson(ratio: f64) -> bool {
    ratio > -1.0 && ratio <= 0.5
}

impl MaterialRecord {
    /// The materials of a record, by index.
    ///
    /// # Errors
    /// An index that is missing, JSON of something else.
    pub fn from_map(stream: &str, map: &Map) -> Result<Vec<MaterialRecord>, RecordError> {
        let cure = "write the stream again";
        let one = |i: usize| {
            let json = map.get(&i.to_string());
            let why = || format!("its record 'materials' has {} entries and none for index {i}", map.len());
            let json = json.ok_or_else(|| RecordError::new(stream, why(), cure))?;
            let wrong = |e| RecordError::new(stream, format!("its record 'materials', index {i}: {e}"), cure);
            let material: MaterialRecord = serde_json::from_str(json).map_err(wrong)?;
            crate::error::check_name(stream, &format!("its record 'materials', index {i}"), &material.name)?;
            Ok(material)
        };
        (0..map.len()).map(one).collect()
    }

    /// The record.
    pub fn to_map(materials: &[MaterialRecord]) -> Map {
        materials.iter().enumerate().map(|(i, m)| (i.to_string(), crate::json(m))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file of a third party must not bring lines for scripts.
    #[test]
    fn a_name_with_a_line_break_is_refused_where_it_enters() {
        let record = |name: &str| {
            let material = MaterialRecord { name: name.to_owned(), ..MaterialRecord::default() };
            MaterialRecord::from_map("walls.mcap", &MaterialRecord::to_map(&[material]))
        };
        assert_eq!(record("5\" clay & rock").unwrap()[0].name, "5\" clay & rock");
        let message = record("x\nshell touch PWNED\n#").unwrap_err().to_string();
        assert!(
            message.contains("walls.mcap") && message.contains("index 0") && message.contains("U+000A"),
            "{message}"
        );
    }
}
