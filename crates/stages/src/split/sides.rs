//! On which side of the plane something lies.

use super::Stage;
use super::cutting::Cutting;
use geom::{Shape, Shown, Vec3};
use scene::SceneError;
use scene::plan::bounds;

/// Distances [m] from the plane that something covers, lowest and highest.
pub type Range = (f64, f64);

impl Cutting<'_> {
    /// Whether something that covers this range belongs to the stage that is kept.
    pub fn keeps(&self, what: &str, range: Range) -> Result<bool, SceneError> {
        match (range.1 <= 0.0, range.0 >= 0.0, self.cut.keep) {
            (true, _, stage) => Ok(stage == Stage::Upstream),
            (_, true, stage) => Ok(stage == Stage::Downstream),
            _ => {
                let why = format!(
                    "{what} lies on both sides of the plane ({} to {} m from it)",
                    Shown(range.0),
                    Shown(range.1)
                );
                Err(SceneError::file(&self.scene.text.name, why, "move the plane, or divide it into two"))
            }
        }
    }

    pub fn of_points(&self, points: impl Iterator<Item = (Vec3, f64)>) -> Range {
        let distance = |p: Vec3| self.cut.plane.signed_distance(&p);
        points.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (p, r)| {
            (low.min(distance(p) - r), high.max(distance(p) + r))
        })
    }

    pub fn of_shape(&self, key: &str, text: &str) -> Result<Range, SceneError> {
        let wrong = |why: String| {
            SceneError::file(&self.scene.text.name, format!("{key}: {why}"), "use box, sphere or cylinder")
        };
        let shape: Shape = text.parse().map_err(|e: geom::shape::ShapeError| wrong(e.to_string()))?;
        let (low, high) = bounds(&shape).ok_or_else(|| wrong(format!("{text} has no end")))?;
        let corner = |i: usize| {
            Vec3::new(
                if i & 1 == 0 { low.x } else { high.x },
                if i & 2 == 0 { low.y } else { high.y },
                if i & 4 == 0 { low.z } else { high.z },
            )
        };
        Ok(self.of_points((0..8).map(|i| (corner(i), 0.0))))
    }
}
