//! Thin walls as they are drawn: faces, and lines on them that let a reader see their shape.

mod mesh;
mod plane;

use crate::appearance::scale::{Range, around};
use crate::{SurfaceShape, WallSurface};
use geom::{Plane, Vec3};

/// A plane or mesh, ready to draw; all at t = 0.
pub(crate) struct Sheet<'a> {
    /// Name and motion.
    pub surface: &'a WallSurface,
    /// Corners [m].
    pub vertices: Vec<Vec3>,
    /// Three corners each.
    pub faces: Vec<[u32; 3]>,
    /// Of a mesh: the number of each face in the run, which may hold others, without area.
    pub parts: Vec<u32>,
    /// Ends of straight lines [m]: edges of a mesh, the grid of a plane.
    pub lines: Vec<[Vec3; 2]>,
    /// How much a line hides [–]: edges are the shape of a mesh, a grid only lies on its plane.
    pub ink: f32,
    /// Whether it is the whole surface of a body, which has no inside to look at.
    pub closed: bool,
    /// Whether the camera must see all of it: a plane goes on for ever.
    pub whole: bool,
}

/// The sheets of all surfaces: meshes as they are, planes as far as `extent` [m], the box of all else, reaches.
pub(crate) fn sheets(surfaces: &[WallSurface], extent: [Range; 3]) -> Vec<Sheet<'_>> {
    let meshes = surfaces.iter().filter_map(|s| match &s.shape {
        SurfaceShape::Mesh(mesh) => Some(box_of(&mesh.vertices)),
        SurfaceShape::Plane(_) => None,
    });
    let extent = around(meshes.chain([extent]));
    surfaces.iter().map(|s| sheet(s, surfaces, extent)).collect()
}

fn sheet<'a>(surface: &'a WallSurface, all: &[WallSurface], extent: [Range; 3]) -> Sheet<'a> {
    match &surface.shape {
        SurfaceShape::Mesh(mesh) => mesh::sheet(surface, mesh),
        SurfaceShape::Plane(plane) => plane::sheet(surface, plane, extent, &beside(all, surface)),
    }
}

/// The other planes that move as this one: none is shown beyond another.
fn beside(surfaces: &[WallSurface], of: &WallSurface) -> Vec<Plane> {
    let other = |s: &WallSurface| match &s.shape {
        SurfaceShape::Plane(p) if !std::ptr::eq(s, of) && s.motion == of.motion => Some(*p),
        _ => None,
    };
    surfaces.iter().filter_map(other).collect()
}

/// The box around places [m].
pub(crate) fn box_of(places: &[Vec3]) -> [Range; 3] {
    let one = |p: &Vec3| std::array::from_fn(|k| Range { lo: p[k], hi: p[k] });
    around(places.iter().map(one))
}
