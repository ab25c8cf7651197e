//! On which side of the plane something lies, and the column in which particles start and come down to it: unbounded planes near that
//! column act on them before the cut.

use super::Stage;
use super::cutting::{Cutting, Range};
use super::sources::places;
use geom::{Plane, Shape, Shown, Vec3};
use scene::Result;
use scene::plan::bounds;

/// Corners of all shapes that particles start in [m], and their projections half a diameter before the cut.
pub struct Column(Vec<Vec3>);

impl Column {
    /// Whether a plane comes nearer to it than this [m], or cuts it.
    pub fn meets(&self, plane: &Plane, near: f64) -> bool {
        self.0.iter().any(|corner| plane.signed_distance(corner) < near)
    }
}

impl Cutting<'_> {
    /// Whether something that covers this range belongs to the stage that is kept.
    pub fn keeps(&self, what: &str, range: Range) -> Result<bool> {
        match (range.1 <= 0.0, range.0 >= 0.0, self.cut.keep) {
            (true, _, stage) => Ok(stage == Stage::Upstream),
            (_, true, stage) => Ok(stage == Stage::Downstream),
            _ => {
                let (low, high) = (Shown(range.0), Shown(range.1));
                let why = format!("{what} lies on both sides of the plane ({low} to {high} m from it)");
                Err(self.wrong(why, "move the plane, or divide it into two"))
            }
        }
    }

    pub fn of_points(&self, points: impl Iterator<Item = (Vec3, f64)>) -> Range {
        let distance = |p: Vec3| self.cut.plane.signed_distance(&p);
        points.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (p, r)| {
            (low.min(distance(p) - r), high.max(distance(p) + r))
        })
    }

    pub fn of_shape(&self, key: &str, text: &str) -> Result<Range> {
        let wrong = |why: String| self.wrong(format!("{key}: {why}"), "use box, sphere or cylinder");
        let shape: Shape = text.parse().map_err(|e: geom::shape::ShapeError| wrong(e.to_string()))?;
        let (low, high) = bounds(&shape).ok_or_else(|| wrong(format!("{text} is infinite")))?;
        Ok(self.of_points(corners(low, high).into_iter().map(|corner| (corner, 0.0))))
    }

    /// The column of the stage upstream; `None` where all its grains come in by inlets.
    pub fn column(&self) -> Option<Column> {
        let m = &self.scene.keys;
        let mut starts: Vec<Vec3> = m.body.iter().map(|b| b.position.into()).collect();
        for shape in m.fill.iter().map(|f| &f.shape).chain(m.insert.iter().map(|f| &f.shape)) {
            let shape: Option<Shape> = shape.parse().ok();
            if let Some((low, high)) = shape.as_ref().and_then(bounds) {
                starts.extend(corners(low, high));
            }
        }
        for entry in &m.particles {
            starts.extend(places(self.scene, entry).unwrap_or_default());
        }
        let cut = &self.cut.plane;
        let before = |p: &Vec3| p - cut.normal * (cut.signed_distance(p) + 0.5 * self.largest).max(0.0);
        let down = |p: &Vec3| p - cut.normal * (cut.signed_distance(p) + 0.5 * self.largest);
        let corners: Vec<Vec3> = starts.iter().map(before).chain(starts.iter().map(down)).collect();
        (!corners.is_empty()).then_some(Column(corners))
    }
}

/// The corners of a box between two of them [m].
fn corners(low: Vec3, high: Vec3) -> [Vec3; 8] {
    let side = |corner: usize, axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
    std::array::from_fn(|corner| Vec3::from_fn(|axis, _| side(corner, axis)))
}
