//! The column in which particles start and come down to the cut: unbounded planes near it act on them before the cut.

use super::cutting::Cutting;
use super::sources::places;
use geom::{Plane, Shape, Vec3};
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
    /// Of the stage upstream; `None` where all its grains come in by inlets.
    pub fn column(&self) -> Option<Column> {
        let m = &self.scene.keys;
        let mut starts: Vec<Vec3> = m.body.iter().map(|b| b.position.into()).collect();
        for shape in m.fill.iter().map(|f| &f.shape).chain(m.insert.iter().map(|f| &f.shape)) {
            let shape: Option<Shape> = shape.parse().ok();
            if let Some((low, high)) = shape.as_ref().and_then(bounds) {
                let side = |i: usize, axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
                starts.extend((0..8).map(|i| Vec3::new(side(i, 0), side(i, 1), side(i, 2))));
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
