//! `[[wall]]` to the engine's walls.

use super::builder::{PlanBuilder, WallMaterial};
use crate::check::Check;
use crate::error::{Result, SceneError};
use crate::input::{Input, WallFile, read_mesh};
use crate::keys::{Face, Motion, Servo, Wall};
use dem::setup::{self, WallShape};
use geom::{Plane, Vec3, units};
use std::f64::consts::TAU;

impl PlanBuilder<'_> {
    /// Adds the walls of the scene, and those of the command line.
    ///
    /// # Errors
    /// Files that cannot be read, unknown materials, walls of the command line that no entry waits for.
    pub(super) fn walls(&mut self, given: Vec<WallFile>) -> Result<()> {
        let mut given = given.into_iter();
        for (i, entry) in self.keys().wall.iter().enumerate() {
            let key = format!("wall.{i}");
            let name = entry.name.clone().unwrap_or_else(|| key.clone());
            let file = match &entry.source {
                Some(source) => self.wall_file(source)?,
                None if entry.plane.is_some() || entry.mesh.is_some() || entry.cuboid.is_some() => {
                    let material = self.wall_material(&key, entry)?;
                    for (name, shape) in self.surfaces(&key, &name, entry)? {
                        self.walls.push(wall(entry, name, material, shape));
                    }
                    continue;
                }
                None => given.next().ok_or_else(|| {
                    let why = "waits for walls of the command line, and none were given";
                    let cure = "give dem-run the walls that wallgen wrote (dem-run SCENE.toml WALLS.mcap), or this entry source, plane, \
                                mesh or box";
                    self.check.wrong(&key, "(without source)", why, cure)
                })?,
            };
            self.wall_spheres(&key, &name, entry, file)?;
        }
        for (n, file) in given.enumerate() {
            let name = if n == 0 { "given".to_owned() } else { format!("given.{n}") };
            self.wall_spheres("wall", &name, &Wall::default(), file)?;
        }
        Ok(())
    }

    fn wall_file(&self, source: &str) -> Result<WallFile> {
        let path = self.path(source);
        let Input::Walls(walls) = Input::open_file(&path)? else {
            let name = path.display().to_string();
            return Err(SceneError::file(&name, "is an inlet, no walls", "name it in [[inlet]]"));
        };
        Ok(walls)
    }

    fn wall_material(&self, key: &str, entry: &Wall) -> Result<u16> {
        let missing = || {
            let cure = "add material = \"…\"";
            self.check.wrong(key, "(without material)", "material is missing", cure)
        };
        let name = entry.material.as_ref().ok_or_else(missing)?;
        self.check.material(&format!("{key}.material"), name, &self.materials)
    }

    /// One wall for each material of the file, all with one motion.
    fn wall_spheres(&mut self, key: &str, name: &str, entry: &Wall, file: WallFile) -> Result<()> {
        self.inputs.push(("walls".to_owned(), file.hash.clone()));
        if entry.servo.is_some() && file.materials.len() > 1 {
            let why = "its spheres are of several materials, each of which would follow the force by itself";
            let (servo, cure) = (format!("{name}: servo"), "use a file of one material");
            return Err(self.check.wrong(&servo, &file.name, why, cure));
        }
        for (k, record) in file.materials.iter().enumerate() {
            let own = file.spheres.iter().filter(|s| s.material as usize == k);
            let spheres: Vec<(Vec3, f64)> = own.map(|s| (s.centre, s.radius)).collect();
            if spheres.is_empty() {
                continue;
            }
            let index = match &entry.material {
                Some(chosen) => self.check.material(&format!("{key}.material"), chosen, &self.materials)?,
                None => self.material_of(&file.name, record)?,
            };
            self.wall_materials.push(WallMaterial { index, record: record.clone() });
            let single = file.materials.len() == 1;
            let name = if single { name.to_owned() } else { format!("{name} ({})", record.name) };
            let mut wall = wall(entry, name, index, WallShape::Spheres(spheres));
            wall.motion.velocity += file.velocity;
            self.walls.push(wall);
        }
        Ok(())
    }

    /// Names and shapes of a wall that is a plane, a mesh or a box.
    fn surfaces(&self, key: &str, name: &str, entry: &Wall) -> Result<Vec<(String, WallShape)>> {
        if let Some(text) = &entry.plane {
            let plane = plane(&self.check, &format!("{key}.plane"), text)?;
            return Ok(vec![(name.to_owned(), WallShape::Plane(plane))]);
        }
        if let Some(file) = &entry.mesh {
            let mut mesh = read_mesh(&self.path(file))?;
            // Checked before: a name that is no unit of length is refused.
            let of_unit = entry.units.as_ref().and_then(|name| units::factor(name, "m").ok());
            if let Some(factor) = entry.scale.or(of_unit) {
                mesh.scale(factor);
            }
            return Ok(vec![(name.to_owned(), WallShape::Mesh(mesh))]);
        }
        let face =
            |(face, plane): (Face, Plane)| (format!("{name} {}", face.name()), WallShape::Plane(plane));
        Ok(entry.sides().into_iter().map(face).collect())
    }
}

/// A wall that moves as its entry says.
fn wall(entry: &Wall, name: String, material: u16, shape: WallShape) -> setup::Wall {
    let (motion, servo) = (motion(entry.motion.as_ref()), entry.servo.as_ref().map(servo));
    setup::Wall { motion, servo, ..setup::Wall::new(name, material, shape) }
}

/// A plane of a key.
pub(super) fn plane(check: &Check, key: &str, text: &str) -> Result<Plane> {
    text.parse().map_err(|e: geom::plane::PlaneError| {
        check.wrong(key, format!("\"{text}\""), &e.to_string(), "write it px,py,pz,nx,ny,nz in metres")
    })
}

fn motion(entry: Option<&Motion>) -> setup::Motion {
    let mut motion = setup::Motion::still();
    let Some(entry) = entry else { return motion };
    if let Some(r) = &entry.rotate {
        motion.turn = Vec3::from(r.about).normalize() * (r.rpm / 60.0 * TAU);
        motion.through = Vec3::from(r.through);
    }
    (motion.from, motion.until) = (entry.from, entry.until.unwrap_or(f64::INFINITY));
    motion.velocity = Vec3::from(entry.translate.unwrap_or_default());
    if let Some(v) = &entry.vibrate {
        motion.amplitude = Vec3::from(v.amplitude);
        motion.frequency = v.frequency;
    }
    motion
}

fn servo(entry: &Servo) -> setup::Servo {
    let stress = entry.stress.unwrap_or(0.0) * entry.area.unwrap_or(0.0);
    setup::Servo {
        direction: Vec3::from(entry.direction).normalize(),
        force: entry.force.unwrap_or(stress),
        speed_limit: entry.speed_limit,
    }
}
