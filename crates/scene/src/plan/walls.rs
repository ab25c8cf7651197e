//! `[[wall]]` to the engine's walls.

use super::builder::{PlanBuilder, WallMaterial};
use crate::check::Check;
use crate::error::SceneError;
use crate::input::{Input, WallFile, read_mesh};
use crate::keys::{Face, Motion, Servo, Wall};
use dem::setup::{self, WallShape};
use geom::{Plane, Vec3};
use std::f64::consts::TAU;

impl PlanBuilder<'_> {
    /// Adds the walls of the scene, and those of the command line.
    ///
    /// # Errors
    /// Files that cannot be read, unknown materials, walls of the command line that no entry waits for.
    pub(super) fn walls(&mut self, given: Vec<WallFile>) -> Result<(), SceneError> {
        let mut given = given.into_iter();
        for (i, entry) in self.keys().wall.iter().enumerate() {
            let key = format!("wall.{i}");
            let name = entry.name.clone().unwrap_or_else(|| key.clone());
            let motion =
                setup::Motion { servo: entry.servo.as_ref().map(servo), ..motion(entry.motion.as_ref()) };
            if let Some(source) = &entry.source {
                let file = self.wall_file(source)?;
                self.wall_spheres(&name, entry, motion, file)?;
            } else if entry.plane.is_some() || entry.mesh.is_some() || entry.cuboid.is_some() {
                let material = self.wall_material(&key, entry)?;
                for (name, shape) in self.surfaces(&key, &name, entry)? {
                    self.walls.push(setup::Wall { name, material, shape, motion });
                }
            } else {
                let file = given.next().ok_or_else(|| {
                    let why = "waits for walls of the command line, and none were given";
                    let cure = "give dem-run the walls that wallgen wrote (dem-run SCENE.toml WALLS.mcap), or this entry source, plane, \
                                mesh or box";
                    self.check.wrong(&key, "(without source)", why, cure)
                })?;
                self.wall_spheres(&name, entry, motion, file)?;
            }
        }
        for (n, file) in given.enumerate() {
            let name = if n == 0 { "given".to_owned() } else { format!("given.{n}") };
            self.wall_spheres(&name, &Wall::default(), setup::Motion::still(), file)?;
        }
        Ok(())
    }

    fn wall_file(&self, source: &str) -> Result<WallFile, SceneError> {
        let path = self.path(source);
        match Input::open_file(&path)? {
            Input::Walls(walls) => Ok(walls),
            Input::Inlet(_) => {
                let name = path.display().to_string();
                Err(SceneError::file(&name, "is an inlet, no walls", "name it in [[inlet]]"))
            }
        }
    }

    fn wall_material(&self, key: &str, entry: &Wall) -> Result<u16, SceneError> {
        let missing = || {
            let cure = "add material = \"…\"";
            self.check.wrong(key, "(without material)", "material is missing", cure)
        };
        let name = entry.material.as_ref().ok_or_else(missing)?;
        self.check.material(&format!("{key}.material"), name, &self.materials)
    }

    /// One wall for each material of the file, all with one motion.
    fn wall_spheres(
        &mut self,
        name: &str,
        entry: &Wall,
        mut motion: setup::Motion,
        file: WallFile,
    ) -> Result<(), SceneError> {
        self.inputs.push(("walls".to_owned(), file.hash.clone()));
        if motion.servo.is_some() && file.materials.len() > 1 {
            let why = "its spheres are of several materials, each of which would follow the force by itself";
            let (key, cure) = (format!("{name}: servo"), "use a file of one material");
            return Err(self.check.wrong(&key, &file.name, why, cure));
        }
        motion.velocity += file.velocity;
        for (k, record) in file.materials.iter().enumerate() {
            let own = file.spheres.iter().filter(|s| s.material as usize == k);
            let spheres: Vec<(Vec3, f64)> = own.map(|s| (s.centre, s.radius)).collect();
            if spheres.is_empty() {
                continue;
            }
            let index = match &entry.material {
                Some(chosen) => self.check.material("wall.material", chosen, &self.materials)?,
                None => self.material_of(&file.name, record)?,
            };
            self.wall_materials.push(WallMaterial { index, record: record.clone() });
            let single = file.materials.len() == 1;
            let name = if single { name.to_owned() } else { format!("{name} ({})", record.name) };
            let shape = WallShape::Spheres(spheres);
            self.walls.push(setup::Wall { name, material: index, shape, motion });
        }
        Ok(())
    }

    /// Names and shapes of a wall that is a plane, a mesh or a box.
    fn surfaces(&self, key: &str, name: &str, entry: &Wall) -> Result<Vec<(String, WallShape)>, SceneError> {
        if let Some(text) = &entry.plane {
            let plane = plane(&self.check, &format!("{key}.plane"), text)?;
            return Ok(vec![(name.to_owned(), WallShape::Plane(plane))]);
        }
        if let Some(file) = &entry.mesh {
            return Ok(vec![(name.to_owned(), WallShape::Mesh(read_mesh(&self.path(file))?))]);
        }
        let face =
            |(face, plane): (Face, Plane)| (format!("{name} {}", face.name()), WallShape::Plane(plane));
        Ok(entry.sides().into_iter().map(face).collect())
    }
}

/// A plane of a key.
pub(super) fn plane(check: &Check, key: &str, text: &str) -> Result<Plane, SceneError> {
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
