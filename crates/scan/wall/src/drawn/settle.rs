//! The position of a sphere inside the structure that touches the surface at or near a given point.
//!
//! ```text
//! c ← p − r n;   while some face is nearer than r:   c ← q + r m
//! ```
//!
//! q is the point nearest to c of the face that the sphere stands out of most, m the unit vector from q into the structure. Such
//! projections onto one half-space after the other lead into their intersection (Bregman 1965, doi:10.1016/0041-5553(67)90040-7, theirs
//! being the general case): the sphere comes to touch both faces of an edge, or the three of a corner.

use super::candidate::{Candidate, Drawing};
use super::sides::DrawnSurface;
use geom::mesh::closest_point;
use geom::{Boxes, Vec3};

/// A sphere that stands out by less than this share of its radius does not.
const TOUCH: f64 = 1e-6;
/// Most projections; and after how many the way to go must have become shorter by half, or there is no room.
const STEPS: (usize, usize) = (200, 8);
/// A sphere goes at most this many radii away from its position: in the edge of a wedge that is sharper it has no room.
const FARTHEST: f64 = 4.0;

pub(crate) struct Settle<'a> {
    surface: &'a DrawnSurface,
    boxes: Boxes,
    radius: f64,
    centred: bool,
}

impl<'a> Settle<'a> {
    pub fn new(surface: &'a DrawnSurface, drawing: &Drawing) -> Settle<'a> {
        let boxed = |tri: [Vec3; 3]| [tri[0].inf(&tri[1]).inf(&tri[2]), tri[0].sup(&tri[1]).sup(&tri[2])];
        let boxes: Vec<[Vec3; 2]> = surface.mesh.triangles().map(boxed).collect();
        Settle { surface, boxes: Boxes::new(&boxes), radius: drawing.radius, centred: drawing.centred }
    }

    pub fn candidate(&self, at: Vec3, normal: Vec3) -> Candidate {
        if self.centred {
            return Candidate { at, normal, centre: at, thin: false };
        }
        let first = at - normal * self.radius;
        match self.settled(first).filter(|c| (c - at).norm() <= FARTHEST * self.radius) {
            Some(centre) => Candidate { at, normal, centre, thin: false },
            None => Candidate { at, normal, centre: first, thin: true },
        }
    }

    fn settled(&self, mut centre: Vec3) -> Option<Vec3> {
        let mut before = f64::INFINITY;
        for step in 0..STEPS.0 {
            let Some(next) = self.pushed(centre) else { return Some(centre) };
            if step % STEPS.1 == 0 {
                let now = (next - centre).norm();
                if now > 0.5 * before {
                    return None;
                }
                before = now;
            }
            centre = next;
        }
        None
    }

    /// Where the worst face pushes the sphere; none when no face does.
    fn pushed(&self, centre: Vec3) -> Option<Vec3> {
        let near = self.near(centre);
        let (mut most, mut to) = (TOUCH * self.radius, None);
        for face in &near {
            let Face { q, off, distance, above, normal } = *face;
            // On the face and right above it the centre is outside of the structure, as it is beyond an edge that stands out;
            // beside the face, it must keep away from the edge.
            let is_above = distance <= TOUCH * self.radius || above >= distance * (1.0 - 1e-9);
            let (out, inwards) = if is_above {
                (self.radius + distance, -normal)
            } else if self.is_beyond(&near, q) {
                (self.radius + distance, -off / distance)
            } else {
                (self.radius - distance, off / distance)
            };
            if out > most {
                (most, to) = (out, Some(q + inwards * self.radius));
            }
        }
        to
    }

    /// The faces nearer than the radius, in their order.
    fn near(&self, centre: Vec3) -> Vec<Face> {
        let mut near = Vec::new();
        self.boxes.near(centre, self.radius, |face| {
            let q = closest_point(self.surface.mesh.triangle(face as usize), centre);
            let (off, normal) = (centre - q, self.surface.normals[face as usize]);
            let (distance, above) = (off.norm(), off.dot(&normal));
            if distance < self.radius {
                near.push(Face { q, off, distance, above, normal });
            }
        });
        near
    }

    /// Whether a position is above all faces that meet at the point of an edge or a corner which is nearest to it. The rim of an open sheet
    /// has one face.
    fn is_beyond(&self, near: &[Face], q: Vec3) -> bool {
        let meet = near.iter().filter(|f| (f.q - q).norm() <= TOUCH * self.radius);
        meet.clone().count() > 1 && meet.into_iter().all(|f| f.above > 0.0)
    }
}

/// A face near a centre.
#[derive(Clone, Copy)]
struct Face {
    /// Its point that is nearest to the centre [m].
    q: Vec3,
    /// From there to the centre [m].
    off: Vec3,
    distance: f64,
    /// How far the centre is above its plane [m].
    above: f64,
    normal: Vec3,
}
