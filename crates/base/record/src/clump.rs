//! The record `clumps`: a JSON object for each shape of rigid clumps.

use crate::{Map, RecordError};
use geom::Vec3;
use serde::{Deserialize, Serialize};

/// One shape; lengths are in the frame that it was given in.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ClumpRecord {
    /// Centre of mass [m].
    pub centre: [f64; 3],
    /// Principal moments of inertia of density 1 [m⁵].
    #[serde(default)]
    pub inertia: [f64; 3],
    /// Quaternion w, x, y, z that turns the principal axes from along x, y, z to where they are in the frame that the shape was given in; absent in
    /// runs that do not tell.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axes: Option<[f64; 4]>,
    /// Index of its material.
    #[serde(default)]
    pub material: u16,
    /// Name.
    pub name: String,
    /// Smallest and largest scale [–] of the clumps that may come; absent: none comes.
    pub scales: Option<(f64, f64)>,
    /// x, y, z, radius [m] of each sphere.
    pub spheres: Vec<[f64; 4]>,
    /// Volume [m³].
    pub volume: f64,
}

impl ClumpRecord {
    /// The shapes of a record, by index.
    ///
    /// # Errors
    /// An index that is missing, JSON of something else, sizes that are not above 0.
    pub fn from_map(stream: &str, map: &Map) -> Result<Vec<ClumpRecord>, RecordError> {
        let wrong = |i: usize, why: String| {
            RecordError::new(stream, format!("its record 'clumps', index {i}: {why}"), "run dem-run again")
        };
        let one = |i: usize| {
            let json = map.get(&i.to_string()).ok_or_else(|| wrong(i, "is missing".to_owned()))?;
            let shape: ClumpRecord = serde_json::from_str(json).map_err(|e| wrong(i, e.to_string()))?;
            crate::error::check_name(stream, &format!("its record 'clumps', index {i}"), &shape.name)?;
            let sound = shape.scales.is_none_or(|(low, high)| 0.0 < low && low <= high && high.is_finite());
            let spheres = shape.spheres.iter().all(|s| s[3] > 0.0 && s.iter().all(|x| x.is_finite()));
            match sound && spheres && !shape.spheres.is_empty() {
                true => Ok(shape),
                false => Err(wrong(i, "wanted: scales above 0, spheres with radii above 0".to_owned())),
            }
        };
        (0..map.len()).map(one).collect()
    }

    /// The record.
    pub fn to_map(shapes: &[ClumpRecord]) -> Map {
        shapes.iter().enumerate().map(|(k, shape)| (k.to_string(), crate::json(shape))).collect()
    }

    /// Radius of the sphere that holds the largest clump that may come [m]; 0 when none comes.
    pub fn reach(&self) -> f64 {
        let centre = Vec3::from(self.centre);
        let one = |s: &[f64; 4]| (Vec3::new(s[0], s[1], s[2]) - centre).norm() + s[3];
        self.spheres.iter().map(one).fold(0.0, f64::max) * self.scales.map_or(0.0, |s| s.1)
    }
}
