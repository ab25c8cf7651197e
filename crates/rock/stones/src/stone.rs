//! A closed mesh that was checked, with what is asked of it again and again.

use crate::crossing;
use geom::mesh::{Inside, TriMesh, closest_point};
use geom::moments::BodyError;
use geom::{Boxes, Moments, Shown, Vec3};
use remesh::pieces::pieces;
use thiserror::Error;

/// Longer than this [m] a stone is taken for one in millimetres.
pub const LONGEST: f64 = 20.0;
/// Most faces of a stone.
pub const MOST_FACES: usize = 2_000_000;

/// Why a mesh is not a stone.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StoneError {
    #[error("{0}; close or orient it with stone-clean or a mesh editor")]
    Body(#[from] BodyError),
    #[error("mesh is {} m long, more than {LONGEST} m: if its lengths are in millimetres, give --units mm; else give --units m", Shown(*.0))]
    Long(f64),
    #[error(
        "mesh crosses itself: faces {first} and {second} meet near ({}, {}, {}) m, and {pairs} pairs of faces do; remesh it with stone-clean \
         or a mesh editor", Shown(at[0]), Shown(at[1]), Shown(at[2])
    )]
    Crossing { first: usize, second: usize, pairs: usize, at: [f64; 3] },
    #[error("mesh is {0} bodies apart from each other, and a stone is one: give each in a file of its own")]
    Bodies(usize),
    #[error("mesh has {0} faces, more than {MOST_FACES}: thin it with stone-clean --faces 5000")]
    Faces(usize),
}

/// A closed mesh without crossings whose faces look outwards.
#[derive(Debug, Clone)]
pub struct Stone {
    /// The mesh [m].
    pub mesh: TriMesh,
    /// Volume, centre of mass and inertia of density 1, exactly.
    pub moments: Moments,
    /// Whether places are inside.
    pub inside: Inside,
    faces: Boxes,
}

impl Stone {
    /// Checks a mesh: closed, all faces to one side, without crossings. `units_given`: whether the user has given the unit of the lengths, so
    /// that a long stone is believed.
    ///
    /// # Errors
    /// A mesh that is none of these, or as long as if it were in millimetres.
    pub fn new(mesh: &TriMesh, units_given: bool) -> Result<Stone, StoneError> {
        let mut mesh = mesh.welded();
        if mesh.faces.len() > MOST_FACES {
            return Err(StoneError::Faces(mesh.faces.len()));
        }
        let moments = Moments::of_mesh(&mesh)?;
        if mesh.volume() < 0.0 {
            mesh.faces.iter_mut().for_each(|face| face.swap(1, 2));
        }
        let (lo, hi) = geom::grid::bounds(&mesh.vertices);
        let length = (hi - lo).max();
        if length > LONGEST && !units_given {
            return Err(StoneError::Long(length));
        }
        let faces = Boxes::new(&mesh.triangles().map(around).collect::<Vec<_>>());
        let crossings = crossing::of_itself(&mesh, &faces);
        if let Some(&(first, second)) = crossings.first() {
            let [a, b, c] = mesh.triangle(first);
            return Err(StoneError::Crossing {
                first,
                second,
                pairs: crossings.len(),
                at: ((a + b + c) / 3.0).into(),
            });
        }
        // A cavity is a piece with a volume below zero.
        let bodies = pieces(&mesh).iter().filter(|piece| piece.volume() > 0.0).count();
        if bodies > 1 {
            return Err(StoneError::Bodies(bodies));
        }
        let inside = Inside::new(&mesh).map_err(BodyError::from)?;
        Ok(Stone { mesh, moments, inside, faces })
    }

    /// The diameter of a sphere of its volume [m].
    pub fn diameter(&self) -> f64 {
        (6.0 * self.moments.volume / std::f64::consts::PI).cbrt()
    }

    /// The nearest point of the surface [m], and its face.
    pub fn closest(&self, p: &Vec3) -> (Vec3, usize) {
        let distance = self.inside.distance(p);
        let mut best = (f64::INFINITY, *p, 0);
        // The face at this distance, and the room that rounding takes.
        self.faces.near(*p, distance * (1.0 + 1e-9) + f64::MIN_POSITIVE, |face| {
            let point = closest_point(self.mesh.triangle(face as usize), *p);
            let found = (point - p).norm_squared();
            if (found, face as usize) < (best.0, best.2) {
                best = (found, point, face as usize);
            }
        });
        (best.1, best.2)
    }

    /// Calls `found` with the number of each face whose box is within `reach` [m] of `p`.
    pub fn faces_near(&self, p: Vec3, reach: f64, found: impl FnMut(u32)) {
        self.faces.near(p, reach, found);
    }

    /// Radius of the sphere about the centre of mass that encloses the stone [m].
    pub fn reach(&self) -> f64 {
        self.mesh.vertices.iter().map(|v| (v - self.moments.centre).norm()).fold(0.0, f64::max)
    }
}

/// The box of a triangle.
pub(crate) fn around([a, b, c]: [Vec3; 3]) -> [Vec3; 2] {
    [a.inf(&b).inf(&c), a.sup(&b).sup(&c)]
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use geom::mesh::cuboid;

    /// A sphere of triangles: an octahedron, each face halved `levels` times.
    pub(crate) fn ball(radius: f64, levels: u32) -> TriMesh {
        let mut mesh = crate::sphere::sphere(&nalgebra::UnitQuaternion::identity(), levels);
        mesh.scale(radius);
        mesh
    }

    /// A box with sides [m], one corner at the origin.
    pub(crate) fn block(x: f64, y: f64, z: f64) -> Stone {
        Stone::new(&cuboid(Vec3::zeros(), Vec3::new(x, y, z)), false).unwrap()
    }

    #[test]
    fn a_mesh_that_is_not_a_stone_is_refused_with_a_cure() {
        let good = cuboid(Vec3::zeros(), Vec3::repeat(0.1));
        assert!(Stone::new(&good, false).is_ok());
        let refused = |mesh: &TriMesh| Stone::new(mesh, false).unwrap_err().to_string();
        let open = TriMesh { faces: good.faces[1..].to_vec(), ..good.clone() };
        assert!(refused(&open).contains("not closed") && refused(&open).contains("stone-clean"));
        let mut millimetres = good.clone();
        millimetres.scale(1000.0);
        assert!(refused(&millimetres).contains("100 m long") && refused(&millimetres).contains("--units mm"));
        assert!(Stone::new(&millimetres, true).is_ok());
        // Two boxes beside each other are two stones; one in the other is a cavity.
        let with = |other: TriMesh| {
            let mut both = good.clone();
            both.faces.extend(other.faces.iter().map(|f| f.map(|v| v + 8)));
            both.vertices.extend(other.vertices);
            both
        };
        let apart = with(cuboid(Vec3::repeat(0.2), Vec3::repeat(0.3)));
        assert!(refused(&apart).contains("2 bodies apart from each other"), "{}", refused(&apart));
        let mut cavity = cuboid(Vec3::repeat(0.03), Vec3::repeat(0.07));
        cavity.faces.iter_mut().for_each(|face| face.swap(1, 2));
        assert!(Stone::new(&with(cavity), false).is_ok());
        // Two boxes that go through each other, as one mesh.
        let mut crossed = good.clone();
        let other = cuboid(Vec3::repeat(0.05), Vec3::repeat(0.2));
        crossed.faces.extend(other.faces.iter().map(|f| f.map(|v| v + 8)));
        crossed.vertices.extend(other.vertices);
        let words = refused(&crossed);
        assert!(words.contains("crosses itself") && words.contains("remesh"), "{words}");
        // A corner pushed through the opposite side.
        let mut pushed = ball(0.1, 2);
        pushed.vertices[0] *= -1.5;
        assert!(refused(&pushed).contains("crosses itself"), "{}", refused(&pushed));
    }

    #[test]
    fn inwards_faces_are_turned_outwards() {
        let mut mesh = cuboid(Vec3::zeros(), Vec3::repeat(0.1));
        mesh.faces.iter_mut().for_each(|f| f.swap(0, 1));
        assert!(Stone::new(&mesh, false).unwrap().mesh.volume() > 0.0);
    }

    #[test]
    fn the_closest_point_is_that_of_a_look_at_every_face() {
        let stone = Stone::new(&ball(0.1, 2), false).unwrap();
        for k in 0..50 {
            let p =
                Vec3::new(f64::from(k % 5), f64::from(k % 7), f64::from(k % 3)) * 0.04 - Vec3::repeat(0.05);
            let (found, face) = stone.closest(&p);
            let (wanted, _) = stone.mesh.closest(p).unwrap();
            assert!(((found - p).norm() - (wanted - p).norm()).abs() < 1e-15);
            assert!((closest_point(stone.mesh.triangle(face), p) - found).norm() < 1e-15);
        }
    }
}
