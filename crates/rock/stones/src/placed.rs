//! A stone at its place, and whether it overlaps another one: exactly.
//!
//! Two closed surfaces overlap if faces of them meet, or if one lies inside the other. A cheap answer comes first: boxes that are apart; spheres inside
//! the stones that overlap.

use crate::crossing::ball_around;
use crate::library::LibraryStone;
use crate::stone::around;
use crate::triangles::meet;
use geom::Vec3;
use geom::mesh::TriMesh;
use nalgebra::UnitQuaternion;

/// A stone of a library with size, orientation and place.
#[derive(Debug, Clone)]
pub struct PlacedStone {
    /// Index in the library.
    pub stone: usize,
    /// Index of its class.
    pub class: usize,
    /// Factor on the size of the mesh [–].
    pub scale: f64,
    /// Turns the mesh about its centre of mass.
    pub orientation: UnitQuaternion<f64>,
    /// Centre of mass [m].
    pub centre: Vec3,
    /// Indices of the grains inside.
    pub grains: Vec<u32>,
    /// Vertices of the placed mesh [m].
    pub vertices: Vec<Vec3>,
    /// Its box [m].
    pub bounds: [Vec3; 2],
}

impl PlacedStone {
    /// Places a stone.
    pub fn new(
        (index, of): (usize, &LibraryStone),
        class: usize,
        scale: f64,
        orientation: UnitQuaternion<f64>,
        centre: Vec3,
    ) -> PlacedStone {
        let vertices: Vec<Vec3> = of.arms().map(|arm| centre + orientation * (arm * scale)).collect();
        let (lo, hi) = geom::grid::bounds(&vertices);
        PlacedStone {
            stone: index,
            class,
            scale,
            orientation,
            centre,
            grains: Vec::new(),
            vertices,
            bounds: [lo, hi],
        }
    }

    /// Volume [m³].
    pub fn volume(&self, of: &LibraryStone) -> f64 {
        of.stone.moments.volume * self.scale.powi(3)
    }

    /// A position in the frame of the mesh.
    fn local(&self, of: &LibraryStone, p: &Vec3) -> Vec3 {
        of.stone.moments.centre + self.orientation.inverse_transform_vector(&(p - self.centre)) / self.scale
    }

    /// Whether a position [m] is inside.
    pub fn contains(&self, of: &LibraryStone, p: &Vec3) -> bool {
        of.stone.inside.contains(&self.local(of, p))
    }

    /// The placed mesh.
    pub fn mesh(&self, of: &LibraryStone) -> TriMesh {
        TriMesh { vertices: self.vertices.clone(), faces: of.stone.mesh.faces.clone() }
    }

    fn triangle(&self, of: &LibraryStone, face: u32) -> [Vec3; 3] {
        of.stone.mesh.faces[face as usize].map(|v| self.vertices[v as usize])
    }

    /// Whether two placed stones have a common point.
    pub fn overlaps(&self, of: &LibraryStone, other: &PlacedStone, other_of: &LibraryStone) -> bool {
        let [a, b] = [&self.bounds, &other.bounds];
        if (0..3).any(|k| a[0][k] > b[1][k] || b[0][k] > a[1][k]) {
            return false;
        }
        if (self.centre - other.centre).norm() < of.inner * self.scale + other_of.inner * other.scale {
            return true;
        }
        self.surface_meets(of, other, other_of)
            || other.contains(other_of, &self.vertices[0])
            || self.contains(of, &other.vertices[0])
    }

    fn surface_meets(&self, of: &LibraryStone, other: &PlacedStone, other_of: &LibraryStone) -> bool {
        let [lo, hi] = other.bounds;
        // Room for the rounding of positions in the other frame.
        let rounding =
            1e-9 * (other_of.reach + (other.centre.amax() + self.centre.amax()) * 1e-3 / other.scale);
        for face in 0..of.stone.mesh.faces.len() as u32 {
            let triangle = self.triangle(of, face);
            let [a, b] = around(triangle);
            if (0..3).any(|k| a[k] > hi[k] || b[k] < lo[k]) {
                continue;
            }
            let (centre, radius) = ball_around(&triangle);
            let mut met = false;
            other_of.stone.faces_near(
                other.local(other_of, &centre),
                radius / other.scale + rounding,
                |near| {
                    met = met || meet(&triangle, &other.triangle(other_of, near));
                },
            );
            if met {
                return true;
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::Library;
    use crate::random::random_orientation;
    use crate::stone::tests::ball;
    use geom::mesh::cuboid;

    fn library() -> Library {
        let cube = cuboid(Vec3::repeat(-0.05), Vec3::repeat(0.05));
        Library::new(vec![("cube".to_owned(), cube), ("round".to_owned(), ball(0.05, 2))], false).unwrap()
    }

    fn place(
        library: &Library,
        stone: usize,
        scale: f64,
        turn: UnitQuaternion<f64>,
        at: Vec3,
    ) -> PlacedStone {
        PlacedStone::new((stone, &library.stones[stone]), 0, scale, turn, at)
    }

    #[test]
    fn boxes_touch_overlap_enclose_and_miss() {
        let library = library();
        let cube = &library.stones[0];
        let at = |x: f64, scale: f64| {
            place(&library, 0, scale, UnitQuaternion::identity(), Vec3::new(x, 0.0, 0.0))
        };
        let overlaps = |a: &PlacedStone, b: &PlacedStone| {
            let found = a.overlaps(cube, b, cube);
            assert_eq!(found, b.overlaps(cube, a, cube));
            found
        };
        assert!(overlaps(&at(0.0, 1.0), &at(0.09, 1.0)));
        assert!(overlaps(&at(0.0, 1.0), &at(0.1, 1.0)), "a common face");
        assert!(!overlaps(&at(0.0, 1.0), &at(0.1 + 1e-15, 1.0)));
        // One in a corner of the other: no faces meet, and the spheres inside are apart.
        let corner = place(&library, 0, 0.1, UnitQuaternion::identity(), Vec3::repeat(0.044));
        assert!(overlaps(&at(0.0, 1.0), &corner), "one inside the other");
    }

    /// Against the exact condition for convex bodies: they overlap if no plane separates them, looked for along many directions.
    #[test]
    fn turned_stones_overlap_when_no_direction_separates_them() {
        let library = library();
        let mut random = geom::random::generator(7, 0, 0);
        let (mut met, mut apart, mut unsure) = (0, 0, 0);
        for k in 0..300 {
            let at = Vec3::new(0.06 + 0.0003 * f64::from(k), 0.02, -0.01);
            let [a, b] = [(Vec3::zeros(), 0), (at, k as usize % 2)]
                .map(|(p, s)| place(&library, s, 1.0 - 0.3 * s as f64, random_orientation(&mut random), p));
            let gap = |d: &Vec3| {
                let most = a.vertices.iter().map(|v| v.dot(d)).fold(f64::NEG_INFINITY, f64::max);
                b.vertices.iter().map(|v| v.dot(d)).fold(f64::INFINITY, f64::min) - most
            };
            // Normals of faces and products of edges: for cubes the whole test, for the ball nearly.
            let edges = |s: &PlacedStone| {
                let faces = &library.stones[s.stone].stone.mesh.faces;
                let all = faces.iter().flat_map(|f| [(f[0], f[1]), (f[1], f[2]), (f[2], f[0])]);
                all.map(|(u, v)| s.vertices[v as usize] - s.vertices[u as usize]).collect::<Vec<_>>()
            };
            let (ea, eb) = (edges(&a), edges(&b));
            let within = |e: &[Vec3]| e.windows(2).map(|w| w[0].cross(&w[1])).collect::<Vec<_>>();
            let between = ea.iter().flat_map(|x| eb.iter().map(move |y| x.cross(y)));
            let axes = within(&ea).into_iter().chain(within(&eb)).chain(between);
            let widest = axes
                .filter_map(|d| d.try_normalize(1e-12))
                .map(|d| gap(&d).max(gap(&-d)))
                .fold(f64::NEG_INFINITY, f64::max);
            let found = a.overlaps(&library.stones[a.stone], &b, &library.stones[b.stone]);
            match widest {
                w if w.abs() < 1e-12 => unsure += 1,
                w if w > 0.0 => {
                    apart += 1;
                    assert!(!found, "{k}: {w}");
                }
                w => {
                    met += 1;
                    assert!(found, "{k}: {w}");
                }
            }
        }
        assert!(met > 50 && apart > 50 && unsure < 5, "{met} {apart} {unsure}");
    }

    #[test]
    fn positions_are_inside_the_turned_stone() {
        let library = library();
        let turn = UnitQuaternion::from_euler_angles(0.0, 0.0, std::f64::consts::FRAC_PI_4);
        let cube = place(&library, 0, 2.0, turn, Vec3::new(1.0, 2.0, 3.0));
        let inside = |x: f64, y: f64| cube.contains(&library.stones[0], &Vec3::new(1.0 + x, 2.0 + y, 3.0));
        assert!(inside(0.14, 0.0) && !inside(0.142, 0.0) && !inside(0.08, 0.08) && inside(0.07, 0.07));
    }
}
