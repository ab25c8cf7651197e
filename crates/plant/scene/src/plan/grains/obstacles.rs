//! Walls as a `[[fill]]` sees them: what its spheres must not touch.
//!
//! A scene whose fills lie free of its walls, up to the overlap that the guard allows, keeps its places. Otherwise all fills are placed again with the walls
//! in the way, so that particles start on the side of a wall on which they have room, also beside a scan whose shape no SHAPE describes. Images across
//! periodic faces, of walls and of grains, count as the engine counts them.

use crate::plan::grains::images::Images;
use dem::setup::{Wall, WallShape};
use geom::mesh::{TriMesh, closest_point};
use geom::{Boxes, Plane, Vec3};
use std::sync::Arc;

/// Spheres that are placed, and the walls if they are to be kept free of.
#[derive(Debug, Clone, Default)]
pub(in crate::plan) struct Taken {
    /// Centre and radius [m].
    pub spheres: Vec<(Vec3, f64)>,
    pub walls: Option<Arc<Obstacles>>,
}

impl From<Vec<(Vec3, f64)>> for Taken {
    fn from(spheres: Vec<(Vec3, f64)>) -> Taken {
        Taken { spheres, walls: None }
    }
}

/// The surfaces of all walls at t = 0.
#[derive(Debug, Default)]
pub(in crate::plan) struct Obstacles {
    planes: Vec<Plane>,
    meshes: Vec<(TriMesh, Boxes, [Vec3; 2])>,
    spheres: Vec<(Vec3, f64)>,
    boxes: Boxes,
    /// Lowest and highest corner of all spheres [m].
    around: [Vec3; 2],
    pub(in crate::plan) images: Images,
}

/// The box around boxes [m].
fn around_all(boxes: &[[Vec3; 2]]) -> [Vec3; 2] {
    let none = [Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)];
    boxes.iter().fold(none, |[low, high], [l, h]| [low.inf(l), high.sup(h)])
}

/// The box around a sphere [m].
fn around((centre, radius): &(Vec3, f64)) -> [Vec3; 2] {
    [centre.add_scalar(-radius), centre.add_scalar(*radius)]
}

impl Obstacles {
    /// Of walls where they are at t = 0, and their images.
    pub(in crate::plan) fn of(walls: &[Wall], images: Images) -> Obstacles {
        let mut all = Obstacles { images, ..Obstacles::default() };
        for wall in walls {
            match &wall.shape {
                WallShape::Plane(plane) => all.planes.push(*plane),
                WallShape::Mesh(mesh) => {
                    let around = |[a, b, c]: [Vec3; 3]| [a.inf(&b).inf(&c), a.sup(&b).sup(&c)];
                    let boxes: Vec<[Vec3; 2]> = mesh.triangles().map(around).collect();
                    all.meshes.push((mesh.clone(), Boxes::new(&boxes), around_all(&boxes)));
                }
                WallShape::Spheres(spheres) => all.spheres.extend(spheres),
            }
        }
        let boxes: Vec<[Vec3; 2]> = all.spheres.iter().map(around).collect();
        (all.boxes, all.around) = (Boxes::new(&boxes), around_all(&boxes));
        all
    }

    /// Whether a sphere touches no wall, and lies behind no plane.
    pub(in crate::plan) fn is_free(&self, centre: &Vec3, radius: f64) -> bool {
        self.deepest(centre, radius) <= 0.0
    }

    /// Deepest overlap of a sphere with a wall, as a share of the smaller radius [–]; 0 or less: none.
    pub(in crate::plan) fn deepest(&self, centre: &Vec3, radius: f64) -> f64 {
        let mut deepest = 0.0f64;
        for plane in &self.planes {
            deepest = deepest.max(self.in_plane(plane, centre, radius));
        }
        let near = |[low, high]: &[Vec3; 2]| {
            self.images.between(*centre, &low.add_scalar(-radius), &high.add_scalar(radius))
        };
        for (mesh, boxes, around) in &self.meshes {
            for centre in near(around) {
                boxes.near(centre, radius, |face| {
                    let nearest = closest_point(mesh.triangle(face as usize), centre);
                    deepest = deepest.max(1.0 - (nearest - centre).norm() / radius);
                });
            }
        }
        for centre in near(&self.around) {
            self.boxes.near(centre, radius, |k| {
                let (other, wide) = self.spheres[k as usize];
                deepest = deepest.max((radius + wide - (other - centre).norm()) / radius.min(wide));
            });
        }
        deepest
    }

    /// Overlap with a plane, as a share of the radius [–]; what is behind it lies in it, and what is behind an image of it is in the next period.
    fn in_plane(&self, plane: &Plane, centre: &Vec3, radius: f64) -> f64 {
        let overlap = |at: &Vec3| 1.0 - (at - plane.point).dot(&plane.normal) / radius;
        let crosses = |a: usize| self.images.length(a).filter(|_| plane.normal[a] != 0.0);
        let lengths = [0, 1, 2].map(crosses);
        if lengths == [None; 3] {
            return overlap(centre);
        }
        let home = self.images.home(centre);
        let mut deepest = overlap(&home);
        let periods = |a: usize| if lengths[a].is_some() { -1..=1 } else { 0..=0 };
        for (x, y, z) in
            periods(2).flat_map(|z| periods(1).flat_map(move |y| periods(0).map(move |x| (x, y, z))))
        {
            let shift = [x, y, z].map(f64::from);
            let image = overlap(&Vec3::from_fn(|a, _| home[a] + shift[a] * lengths[a].unwrap_or(0.0)));
            if shift != [0.0; 3] && image < 2.0 {
                deepest = deepest.max(image);
            }
        }
        deepest
    }
}

/// Deepest overlap of spheres with images of each other, as a share of the smaller radius [–].
pub(in crate::plan) fn deepest_across(spheres: &[(Vec3, f64)], images: &Images) -> f64 {
    if images.is_empty() {
        return 0.0;
    }
    let each: Vec<[Vec3; 2]> = spheres.iter().map(around).collect();
    let (boxes, [low, high]) = (Boxes::new(&each), around_all(&each));
    let mut deepest = 0.0f64;
    for (centre, radius) in spheres {
        let near = images.between(*centre, &low.add_scalar(-radius), &high.add_scalar(*radius));
        for image in near.filter(|image| (image - centre).amax() > 0.0) {
            boxes.near(image, *radius, |k| {
                let (other, wide) = spheres[k as usize];
                deepest = deepest.max((radius + wide - (other - image).norm()) / radius.min(wide));
            });
        }
    }
    deepest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;
    use geom::mesh::cuboid;

    const HEAD: &str = "[time]\nuntil = 1\n[[material]]\nname = \"m\"\ndensity = 1000\nyoung = 1e6\npoisson = 0.3\n\
        [[contact]]\nbetween = [\"*\", \"*\"]\nrestitution = 0.5\n[[wall]]\nplane = \"0,0,0.05,0,0.6,0.8\"\nmaterial = \"m\"\n";

    fn planned(fill: &str) -> Result<Vec<dem::setup::Particle>> {
        let fill = format!("{HEAD}[[fill]]\nmaterial = \"m\"\nshape = \"box:0,0,0,0.1,0.1,0.1\"\n{fill}");
        let scene = crate::Scene::new("s", fill, &[], std::path::Path::new(""))?;
        Ok(scene.plan(Vec::new())?.setup.particles)
    }

    /// Height above the inclined plane of the scene [m].
    fn height(p: &dem::setup::Particle) -> f64 {
        0.6 * p.position.y + 0.8 * (p.position.z - 0.05)
    }

    #[test]
    fn a_fill_keeps_free_of_walls() {
        for fill in ["diameter = [0.004, 0.008]\ncount = 500", "diameter = 0.008\nlattice = \"hexagonal\""] {
            let found = planned(fill).unwrap();
            assert!(found.len() > 300, "{fill}: {}", found.len());
            assert!(found.iter().all(|p| height(p) >= p.radius * (1.0 - 1e-9)), "{fill}");
            for (i, p) in found.iter().enumerate() {
                let apart = |q: &dem::setup::Particle| {
                    (p.position - q.position).norm() >= (p.radius + q.radius) * (1.0 - 1e-9)
                };
                assert!(found[..i].iter().all(apart), "{fill}: {i}");
            }
            assert_eq!(found, planned(fill).unwrap());
        }
        let why = planned("diameter = 0.008\ncount = 1100").unwrap_err().to_string();
        assert!(
            why.contains("of 1100 particles") && why.contains("fit without touching each other or a wall"),
            "{why}"
        );
    }

    /// A domain of 0.1 m, periodic along x, with a wall, and fills of grains of 0.01 m in boxes with these ends along x.
    fn periodic(wall: &str, fills: &[(f64, f64)], most: usize) -> Result<Vec<dem::setup::Particle>> {
        let mut all = HEAD.split("[[wall]]").next().unwrap_or_default().to_owned();
        all += "[domain]\nperiodic = [\"x\"]\nlow = [0, 0, 0]\nhigh = [0.1, 0.1, 0.1]\n";
        all += wall;
        for (low, high) in fills {
            all += &format!(
                "[[fill]]\nmaterial = \"m\"\nshape = \"box:{low},0,0,{high},0.1,0.1\"\ndiameter = 0.01\ncount = {most}\n"
            );
        }
        let scene = crate::Scene::new("s", all, &[], std::path::Path::new(""))?;
        Ok(scene.plan(Vec::new())?.setup.particles)
    }

    /// Distance [m] by the nearest image.
    fn apart(a: &Vec3, b: &Vec3) -> f64 {
        let way = a - b;
        Vec3::new(way.x - 0.1 * (way.x / 0.1).round(), way.y, way.z).norm()
    }

    /// A ball that reaches through the face at 0.1 m is in the way of the grains behind the face at 0; wherever the scene stands in the cell.
    #[test]
    fn a_fill_keeps_free_of_images_of_walls() {
        for (x, low) in [(0.095, 0.0), (0.045, 0.05), (0.195, 0.0), (0.095, 0.1), (-0.005, -0.1)] {
            let wall = format!("[[wall]]\nsolid = \"sphere:{x},0.05,0.05,0.03\"\nmaterial = \"m\"\n");
            let found = periodic(&wall, &[(low, low + 0.04)], 150).unwrap();
            assert_eq!(found.len(), 150);
            let least =
                found.iter().map(|p| apart(&p.position, &Vec3::new(x, 0.05, 0.05))).fold(1.0, f64::min);
            // The ball is one of flat faces: a little smaller than its radius.
            assert!(least > 0.0345, "{x}: {least}");
        }
        for (x, normal) in [(0.0, 1), (0.1, -1)] {
            let wall = format!("[[wall]]\nplane = \"{x},0,0,{normal},0,0\"\nmaterial = \"m\"\n");
            let found = periodic(&wall, &[(0.05, 0.15)], 150).unwrap();
            assert!(found.iter().all(|p| (p.position.x - 0.1).abs() >= 0.005), "{x}");
        }
    }

    #[test]
    fn fills_keep_free_of_each_other_across_a_face() {
        let found = periodic("", &[(-0.02, 0.02), (0.07, 0.1)], 80).unwrap();
        assert_eq!(found.len(), 160);
        for (i, p) in found.iter().enumerate() {
            assert!(found[..i].iter().all(|q| apart(&p.position, &q.position) >= 0.01 * (1.0 - 1e-9)), "{i}");
        }
        let over = [(0.0, 0.05), (0.05, 0.1)];
        let (alone, beside) = (periodic("", &over[..1], 80).unwrap(), periodic("", &over, 80).unwrap());
        assert_eq!(alone[..], beside[..80], "what touches nothing keeps its places");
    }

    /// Overlaps that the guard allows do not move a particle: such scenes ran, and they keep their places.
    #[test]
    fn a_fill_that_the_guard_accepts_keeps_its_places() {
        let fill = "diameter = 0.01\ncount = 20\nseed = 1";
        let all = format!("{HEAD}[[fill]]\nmaterial = \"m\"\nshape = \"box:0,0,0,0.1,0.1,0.1\"\n{fill}");
        let mut scene = crate::Scene::new("s", all, &[], std::path::Path::new("")).unwrap();
        // Deeper than any guard that a scene may give.
        scene.keys.guards.overlap = Some(1e9);
        let kept = scene.plan(Vec::new()).unwrap().setup.particles;
        assert!(kept.iter().any(|p| height(p) < 0.5 * p.radius), "some lie in the wall");
        let moved = planned(fill).unwrap();
        assert!(moved.iter().all(|p| height(p) >= p.radius) && moved != kept);
    }

    #[test]
    fn spheres_are_free_of_planes_meshes_and_wall_spheres() {
        let plane = WallShape::Plane(Plane { point: Vec3::zeros(), normal: Vec3::z() });
        let mesh = WallShape::Mesh(cuboid(Vec3::new(2.0, 0.0, 0.0), Vec3::new(4.0, 2.0, 2.0)));
        let spheres = WallShape::Spheres(vec![(Vec3::new(-3.0, 0.0, 1.0), 0.5)]);
        let walls = [plane, mesh, spheres].map(|shape| Wall::new("w", 0, shape));
        let obstacles = Obstacles::of(&walls, Images::default());
        let share = |x: f64, z: f64| obstacles.deepest(&Vec3::new(x, 1.0, z), 0.5);
        assert!((share(0.0, 0.3) - 0.4).abs() < 1e-15, "0.2 m of 0.5 m below the plane");
        assert!(share(0.0, -4.0) >= 9.0, "behind it");
        assert!((share(1.75, 1.0) - 0.5).abs() < 1e-15, "a face");
        assert!((share(4.25, 1.0) - 0.5).abs() < 1e-15, "a face from the other side");
        assert!(obstacles.is_free(&Vec3::new(3.0, 1.0, 1.0), 0.5), "inside of a mesh that is hollow");
        let beside = obstacles.deepest(&Vec3::new(-3.0, 0.9, 1.0), 0.6);
        assert!((beside - 0.4).abs() < 1e-12, "{beside}: 0.2 m over the smaller radius of 0.5 m");
        assert!(obstacles.is_free(&Vec3::new(-3.0, 1.0, 1.0), 0.5));
    }
}
