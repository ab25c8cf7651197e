//! Values that look like another unit: densities, moduli, radii, gravity, and walls far larger or smaller than the grains.

use crate::plan::builder::PlanBuilder;
use dem::setup::WallShape;
use geom::{Shown, Vec3, grid};

/// Densities of particles [kg/m³]: from foam to beyond osmium.
const DENSITIES: [f64; 2] = [10.0, 30_000.0];
/// Young's moduli [Pa]: from jelly to diamond.
pub const SOFT: f64 = 1e3;
const STIFF: f64 = 2e12;
/// Radii of grains [m].
const RADII: [f64; 2] = [1e-7, 1.0];
/// Gravity [m/s²]: from the Moon's to a centrifuge's.
const GRAVITY: [f64; 2] = [1.0, 2000.0];
/// Widths of a wall over the diameter of the largest grain: a plate smaller than a grain, a plant of 20 000 of them.
const WIDTHS: [f64; 2] = [1.0, 20_000.0];

/// Why a density of particles [kg/m³] looks like another unit, and the cure.
pub fn density(d: f64) -> Option<(&'static str, String)> {
    if d < DENSITIES[0] {
        Some(("is lighter than any grain", format!("if g/cm³ are meant, write {}", Shown(1e3 * d))))
    } else if d > DENSITIES[1] {
        Some(("is heavier than any metal", format!("if g/m³ are meant, write {}", Shown(1e-3 * d))))
    } else {
        None
    }
}

impl PlanBuilder<'_> {
    /// Adds a warning for each value that looks like another unit.
    pub(in crate::plan) fn implausible(&mut self) {
        self.materials();
        self.wall_files();
        self.grains();
        self.gravity();
        self.wall_sizes();
    }

    fn materials(&mut self) {
        let mut warn = |key: &str, value: String, why: &str, cure: &str| {
            self.warnings.push(self.check.wrong(key, value, why, cure).to_string());
        };
        for (i, m) in self.scene.keys.material.iter().enumerate() {
            let key = format!("material.{i}.density");
            if let Some((d, (why, cure))) = m.density.and_then(|d| Some((d, density(d)?))) {
                warn(&key, format!("{} kg/m³", Shown(d)), why, &cure);
            }
            let (key, value) = (format!("material.{i}.young"), format!("{} Pa", Shown(m.young)));
            if m.young < SOFT {
                warn(&key, value, "is softer than any grain", "give it in Pa: 1 MPa is 1e6, 1 GPa is 1e9");
            } else if m.young > STIFF {
                warn(&key, value, "is stiffer than diamond", "give it in Pa: 1 GPa is 1e9");
            }
        }
    }

    /// Materials of wall files: another unit, or another number than the scene has, which counts.
    fn wall_files(&mut self) {
        for wall in &self.wall_materials {
            let record = &wall.record;
            let of_scene = self.scene.keys.material.iter().find(|m| m.name == record.name);
            if let (None, Some(young)) = (of_scene, record.young.filter(|young| *young < SOFT)) {
                let (name, young) = (&record.name, Shown(young));
                self.warnings.push(format!(
                    "wall file: material '{name}': young = {young} Pa is softer than any grain: give wallgen --young in Pa, 1 GPa is 1e9"
                ));
            }
            let Some(scene) = of_scene else { continue };
            for (key, unit, scene, file) in
                [("young", " Pa", scene.young, record.young), ("poisson", "", scene.poisson, record.poisson)]
            {
                if let Some(file) = file.filter(|file| *file != scene) {
                    let (name, scene, file) = (&record.name, Shown(scene), Shown(file));
                    self.warnings
                        .push(format!("material '{name}': {key} = {scene}{unit} of the scene, not {file}{unit} of the wall file"));
                }
            }
        }
    }

    fn grains(&mut self) {
        let Some(sizes) = self.sizes() else { return };
        let (low, high) = (sizes.smallest < RADII[0], sizes.largest > RADII[1]);
        let ends = [
            (low, sizes.smallest, "smaller than 1e-7 m", "0.1 mm is a radius of 5e-5"),
            (high, sizes.largest, "larger than 1 m", "10 mm are 0.01"),
        ];
        for (_, radius, what, cure) in ends.into_iter().filter(|end| end.0) {
            let particle = self.particles.iter().find(|p| p.radius == radius);
            let particle = particle.map_or("grains".to_owned(), |p| format!("particle {}", p.id));
            let name = &self.scene.text.name;
            self.warnings.push(format!(
                "{name}: {particle}: radius = {} m: {what}; lengths are in metres: {cure}",
                Shown(radius)
            ));
        }
    }

    fn gravity(&mut self) {
        let g = Vec3::from(self.scene.keys.gravity).norm();
        let (value, earth) = (format!("{} m/s²", Shown(g)), "on Earth it is [0, 0, -9.81]");
        let why = match g {
            0.0 => return,
            g if g < GRAVITY[0] => "is weaker than the Moon's",
            g if g > GRAVITY[1] => "is stronger than in a centrifuge",
            _ => return,
        };
        let cure = if (9000.0..11_000.0).contains(&g) {
            "it looks like mm/s²: on Earth it is [0, 0, -9.81]"
        } else {
            earth
        };
        self.warnings.push(self.check.wrong("gravity", value, why, cure).to_string());
    }

    /// Drawn and scanned walls whose size does not fit the grains.
    fn wall_sizes(&mut self) {
        let Some(diameter) = self.sizes().map(|sizes| 2.0 * sizes.largest) else { return };
        let name = &self.scene.text.name;
        for wall in &self.walls {
            let (points, largest, cure): (Vec<Vec3>, f64, _) = match &wall.shape {
                WallShape::Mesh(mesh) => {
                    (mesh.vertices.clone(), 0.0, "give the unit of the drawing, such as units = \"mm\"")
                }
                WallShape::Spheres(spheres) => (
                    spheres.iter().map(|s| s.0).collect(),
                    spheres.iter().map(|s| s.1).fold(0.0, f64::max),
                    "give the tools that made it --scale 0.001 if the scan was in mm",
                ),
                WallShape::Plane(_) => continue,
            };
            let (low, high) = grid::bounds(&points);
            let (width, wall) = ((high - low).norm() + 2.0 * largest, &wall.name);
            let what = match width / diameter {
                share if share > WIDTHS[1] => "more than 20 000 times the largest grain",
                share if share < WIDTHS[0] => "less than the largest grain",
                _ => continue,
            };
            self.warnings.push(format!(
                "{name}: wall '{wall}' is {} m wide, {what} ({} m); lengths are in metres: {cure}",
                Shown(width),
                Shown(diameter)
            ));
        }
    }
}
