//! Walls as a `[[fill]]` sees them: what its spheres must not touch.
//!
//! A scene whose fills lie free of its walls, up to the overlap that the guard allows, keeps its places. Otherwise all fills are placed again with the walls
//! in the way, so that particles start on the side of a wall on which they have room, also beside a scan whose shape no SHAPE describes.

use super::builder::PlanBuilder;
use crate::error::Result;
use dem::setup::{Wall, WallShape};
use geom::mesh::{TriMesh, closest_point};
use geom::{Boxes, Plane, Vec3};
use std::sync::Arc;

/// Spheres that are placed, and the walls if they are to be kept free of.
#[derive(Debug, Clone, Default)]
pub(super) struct Taken {
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
pub(super) struct Obstacles {
    planes: Vec<Plane>,
    meshes: Vec<(TriMesh, Boxes)>,
    spheres: Vec<(Vec3, f64)>,
    boxes: Boxes,
}

impl Obstacles {
    /// Of walls where they are at t = 0.
    pub(super) fn of(walls: &[Wall]) -> Obstacles {
        let mut all = Obstacles::default();
        for wall in walls {
            match &wall.shape {
                WallShape::Plane(plane) => all.planes.push(*plane),
                WallShape::Mesh(mesh) => {
                    let around = |[a, b, c]: [Vec3; 3]| [a.inf(&b).inf(&c), a.sup(&b).sup(&c)];
                    let boxes: Vec<[Vec3; 2]> = mesh.triangles().map(around).collect();
                    all.meshes.push((mesh.clone(), Boxes::new(&boxes)));
                }
                WallShape::Spheres(spheres) => all.spheres.extend(spheres),
            }
        }
        let around =
            |(centre, radius): &(Vec3, f64)| [centre.add_scalar(-radius), centre.add_scalar(*radius)];
        all.boxes = Boxes::new(&all.spheres.iter().map(around).collect::<Vec<_>>());
        all
    }

    /// Whether a sphere touches no wall, and lies behind no plane.
    pub(super) fn is_free(&self, centre: &Vec3, radius: f64) -> bool {
        self.deepest(centre, radius) <= 0.0
    }

    /// Deepest overlap of a sphere with a wall, as a share of the smaller radius [–]; 0 or less: none.
    fn deepest(&self, centre: &Vec3, radius: f64) -> f64 {
        let mut deepest = 0.0f64;
        for plane in &self.planes {
            deepest = deepest.max(1.0 - (centre - plane.point).dot(&plane.normal) / radius);
        }
        for (mesh, boxes) in &self.meshes {
            boxes.near(*centre, radius, |face| {
                let nearest = closest_point(mesh.triangle(face as usize), *centre);
                deepest = deepest.max(1.0 - (nearest - centre).norm() / radius);
            });
        }
        self.boxes.near(*centre, radius, |k| {
            let (other, wide) = self.spheres[k as usize];
            deepest = deepest.max((radius + wide - (other - centre).norm()) / radius.min(wide));
        });
        deepest
    }
}

impl PlanBuilder<'_> {
    /// What a fill finds: all spheres that are placed, and the walls if it is to keep free of them.
    pub(super) fn taken(&self) -> Taken {
        Taken { spheres: self.spheres(), walls: self.obstacles.clone() }
    }

    /// What else than each other the spheres of a fill must not touch, for a message.
    pub(super) fn in_the_way(&self) -> &'static str {
        if self.obstacles.is_some() { " each other or a wall" } else { "" }
    }

    /// Places all fills again, free of the walls, if one of their spheres lies so deep in a wall that the run would be refused.
    ///
    /// # Errors
    /// As [`PlanBuilder::particles`]: what no longer fits, with its number.
    pub(super) fn free_of_walls(&mut self) -> Result<()> {
        if self.keys().fill.is_empty() || self.walls.is_empty() {
            return Ok(());
        }
        let (walls, limit) = (Obstacles::of(&self.walls), self.overlap_limit());
        if !self.spheres().iter().any(|(centre, radius)| walls.deepest(centre, *radius) > limit) {
            return Ok(());
        }
        let mut again =
            PlanBuilder { hear: self.hear, obstacles: Some(Arc::new(walls)), ..PlanBuilder::new(self.scene) };
        again.clump_shapes()?;
        again.particles()?;
        (self.particles, self.clusters, self.clumps) = (again.particles, again.clusters, again.clumps);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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

    /// Overlaps that the guard allows do not move a particle: such scenes ran, and they keep their places.
    #[test]
    fn a_fill_that_the_guard_accepts_keeps_its_places() {
        let fill = "diameter = 0.01\ncount = 20\nseed = 1";
        let all = format!(
            "guards.overlap = 1e9\n{HEAD}[[fill]]\nmaterial = \"m\"\nshape = \"box:0,0,0,0.1,0.1,0.1\"\n{fill}"
        );
        let scene = crate::Scene::new("s", all, &[], std::path::Path::new("")).unwrap();
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
        let obstacles = Obstacles::of(&walls);
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
