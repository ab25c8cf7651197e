//! The visual hull: everything that no silhouette excludes.
//!
//! ```text
//! d(x) = min over views of  s(P x) Z/f        s: signed distance to the edge of the mask [px],  Z: depth,  f: focal length [px]
//! ```
//!
//! Laurentini (1994), doi:10.1109/34.273735. The stone is inside: the hull is an upper bound of it, and does not enter its hollows. d is sampled
//! from coarse to fine, and its surface is taken by surface nets.

mod agreement;
mod carve;
mod region;

use crate::camera::Camera;
use crate::field::Field;
use geom::Vec3;
use geom::mesh::TriMesh;
use remesh::Samples;
use std::sync::Arc;
use thiserror::Error;

pub use agreement::Agreement;
pub use carve::carve;
pub(crate) use carve::spread;
pub use region::region;

/// A photograph for carving: where the stone is on it, and where it was taken from.
#[derive(Debug, Clone)]
pub struct View {
    pub camera: Camera,
    /// Signed distance to the edge of the mask.
    pub field: Arc<Field>,
}

impl View {
    /// Signed distance of a point to the cone of the silhouette [m], about; above 0 inside.
    pub fn distance(&self, p: &Vec3) -> f64 {
        let ([x, y], depth) = self.camera.project(p);
        if !(depth > 0.0) {
            return f64::from(f32::MIN);
        }
        self.field.at(x, y) * depth / self.camera.mean_focal()
    }
}

/// Numbers of photographs in a sentence.
fn listed(numbers: &[usize]) -> String {
    numbers.iter().map(|number| format!("number {number}")).collect::<Vec<_>>().join(", ")
}

/// Why there is no hull.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum HullError {
    #[error("{0} views are too few: a hull needs at least 3 photographs from different sides")]
    Few(usize),
    #[error(
        "the cameras look past each other: no point is in front of all of them; check the poses, their order and their unit"
    )]
    Apart,
    #[error(
        "the silhouettes have no common part: at the best place {seen} of {views} views agree, not {}; check the poses, the order of the photographs and the direction of the turn",
        listed(.others)
    )]
    Empty { seen: usize, views: usize, others: Vec<usize> },
    #[error(
        "the silhouettes do not close around the stone: no photograph sees it from the side that stays open; add views from more sides"
    )]
    Open,
}

/// The hull of some views, with about `cells` cells along its longest side.
///
/// # Errors
/// Views that have no common part, or leave a side open.
pub fn hull(views: &[View], cells: usize) -> Result<(TriMesh, Samples), HullError> {
    let samples = carve(views, &region(views)?, cells);
    let mesh = remesh::surface(samples.clone()).ok_or(HullError::Apart)?;
    Ok((mesh, samples))
}
