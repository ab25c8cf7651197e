//! What a stream says about its clumps: the metadata record `clumps`, a JSON object for each index.

use crate::error::SceneError;
use crate::plan::Draft;
use dem::setup::ClumpShape;
use geom::Vec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Scales are written as text: the last digit may differ [–].
pub(crate) const SLACK: f64 = 1e-12;

/// One shape of a stream: what others need of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct ClumpInfo {
    /// Name.
    pub name: String,
    /// Volume [m³].
    pub volume: f64,
    /// Centre of mass in the frame that it was given in [m].
    pub centre: [f64; 3],
    /// x, y, z, radius [m] of each sphere in that frame.
    pub spheres: Vec<[f64; 4]>,
    /// Smallest and largest scale of those that may come; absent: none does.
    pub scales: Option<(f64, f64)>,
}

/// The shapes of a record, by index.
///
/// # Errors
/// An index that is missing, JSON that is none of a shape.
pub(crate) fn from_map(stream: &str, map: &BTreeMap<String, String>) -> Result<Vec<ClumpInfo>, SceneError> {
    let wrong = |i: usize, why: String| {
        SceneError::file(stream, format!("its record 'clumps', index {i}: {why}"), "run dem-run again")
    };
    let one = |i: usize| {
        let json = map.get(&i.to_string()).ok_or_else(|| wrong(i, "is missing".to_owned()))?;
        let info: ClumpInfo = serde_json::from_str(json).map_err(|e| wrong(i, e.to_string()))?;
        let sound = info.scales.is_none_or(|(low, high)| 0.0 < low && low <= high && high.is_finite());
        let spheres = info.spheres.iter().all(|s| s[3] > 0.0 && s.iter().all(|x| x.is_finite()));
        match sound && spheres && !info.spheres.is_empty() {
            true => Ok(info),
            false => Err(wrong(i, "wanted: scales above 0, spheres with radii above 0".to_owned())),
        }
    };
    (0..map.len()).map(one).collect()
}

impl ClumpInfo {
    /// Radius of the sphere that holds the largest that may come [m]; 0 when none does.
    pub fn reach(&self) -> f64 {
        let centre = Vec3::from(self.centre);
        let one = |s: &[f64; 4]| (Vec3::new(s[0], s[1], s[2]) - centre).norm() + s[3];
        self.spheres.iter().map(one).fold(0.0, f64::max) * self.scales.map_or(0.0, |s| s.1)
    }

    /// Whether a shape of the scene is the same, but for rounding.
    fn is(&self, shape: &ClumpShape) -> bool {
        let size = shape.reach();
        let near = |a: &[f64; 4], (c, r): &(Vec3, f64)| {
            let at = shape.centre + shape.frame * c;
            (Vec3::new(a[0], a[1], a[2]) - at).norm() < 1e-9 * size && (a[3] - r).abs() < 1e-9 * size
        };
        self.spheres.len() == shape.spheres.len()
            && (self.volume - shape.volume).abs() < 1e-9 * shape.volume
            && self.spheres.iter().zip(&shape.spheres).all(|(a, b)| near(a, b))
    }
}

impl Draft<'_> {
    /// Index of the scene's shape for each of a stream's that may come; the engine is told of them.
    pub(crate) fn clumps_of(&mut self, stream: &str, infos: &[ClumpInfo]) -> Result<Vec<u32>, SceneError> {
        let mut found = Vec::with_capacity(infos.len());
        for info in infos {
            let Some((low, high)) = info.scales else {
                found.push(u32::MAX);
                continue;
            };
            let shape = self.clump(stream, &info.name)?;
            if !self.clumps.shapes.get(shape as usize).is_some_and(|s| info.is(s)) {
                let why = format!("its clump '{}' has other spheres than the scene's", info.name);
                return Err(SceneError::file(stream, why, "cut both stages from one plant with stage-split"));
            }
            self.clumps.entries.push((shape, low * (1.0 - SLACK), high * (1.0 + SLACK)));
            found.push(shape);
        }
        Ok(found)
    }
}
