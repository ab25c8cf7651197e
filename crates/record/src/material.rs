//! What a stream says about its materials: the metadata record `materials`, a JSON object for each index.

use crate::error::SceneError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Name of the metadata record.
pub const MATERIALS: &str = "materials";

/// One material of a stream; absent values were not set.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MaterialInfo {
    /// Name.
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

/// The materials of a record, by index.
///
/// # Errors
/// An index that is missing, JSON that is none of a material.
pub fn from_map(stream: &str, map: &BTreeMap<String, String>) -> Result<Vec<MaterialInfo>, SceneError> {
    let cure = "write the stream again";
    (0..map.len())
        .map(|i| {
            let json = map.get(&i.to_string());
            let why = || format!("its record 'materials' has {} entries and none for index {i}", map.len());
            let json = json.ok_or_else(|| SceneError::file(stream, why(), cure))?;
            let wrong = |e| SceneError::file(stream, format!("its record 'materials', index {i}: {e}"), cure);
            serde_json::from_str(json).map_err(wrong)
        })
        .collect()
}

/// The record for the materials of a run.
pub(crate) fn to_map(materials: &[dem::setup::Material]) -> BTreeMap<String, String> {
    let info = |m: &dem::setup::Material| MaterialInfo {
        name: m.name.clone(),
        density: (m.density > crate::plan::NO_DENSITY).then_some(m.density),
        young: Some(m.young),
        poisson: Some(m.poisson),
        friction: None,
        restitution: None,
    };
    // A struct of numbers and text always is JSON.
    let json = |m| serde_json::to_string(&info(m)).unwrap_or_default();
    materials.iter().enumerate().map(|(i, m)| (i.to_string(), json(m))).collect()
}
