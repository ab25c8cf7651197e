//! `[[wall]]` to the engine's walls.

pub(in crate::plan) mod adhesive;
pub(in crate::plan) mod below;
pub(in crate::plan) mod servos;
pub(in crate::plan) mod solids;

use crate::check::Check;
use crate::error::{Result, SceneError};
use crate::input::{Input, WallFile, read_mesh_warned, read_path};
use crate::keys::{Face, Motion, Rotate, Wall};
use crate::plan::builder::{PlanBuilder, WallMaterial};
use dem::setup::{self, SurfaceMotion, WallShape};
use geom::motion::Path;
use geom::{Plane, Shown, Vec3};
use std::f64::consts::TAU;

impl PlanBuilder<'_> {
    /// Adds the walls of the scene, and those of the command line.
    ///
    /// # Errors
    /// Files that cannot be read, unknown materials, walls of the command line that no entry waits for.
    pub(in crate::plan) fn walls(&mut self, given: Vec<WallFile>) -> Result<()> {
        let mut given = given.into_iter();
        for (i, entry) in self.keys().wall.iter().enumerate() {
            let key = format!("wall.{i}");
            let name = entry.name_at(i);
            let file = match &entry.source {
                Some(source) => {
                    let mut file = self.wall_file(&format!("{key}.source"), source)?;
                    file.scale(entry.length_factor());
                    file
                }
                None if entry.is_surface() => {
                    let material = self.wall_material(&key, entry)?;
                    for (name, shape) in self.surfaces(&key, &name, entry)? {
                        let wall = self.wall(&key, entry, name, material, shape)?;
                        self.walls.push(wall);
                    }
                    continue;
                }
                None => given.next().ok_or_else(|| {
                    let why = "waits for walls of the command line, and none were given";
                    let cure = "give dem-run the walls that wallgen wrote (dem-run SCENE.toml WALLS.mcap), or this entry source, plane, \
                                mesh, solid or box";
                    self.check.wrong(&key, "(without source)", why, cure)
                })?,
            };
            self.wall_spheres(&key, &name, entry, file)?;
        }
        for (n, file) in given.enumerate() {
            let name = if n == 0 { "given".to_owned() } else { format!("given.{n}") };
            self.wall_spheres("wall", &name, &Wall::default(), file)?;
        }
        self.doubled()?;
        self.servo_areas()
    }

    /// Two walls that are one surface: each would push by itself, twice as hard as the material is.
    fn doubled(&self) -> Result<()> {
        for (k, wall) in self.walls.iter().enumerate() {
            let Some(other) = self.walls[..k].iter().find(|other| is_same(wall, other)) else { continue };
            let why =
                format!("is the same surface as wall '{}': a grain would touch both at once", other.name);
            let place = self.scene.wall(&wall.name, "").map(|key| self.scene.text.place(&key));
            let place = place.map_or(String::new(), |place| format!("{place}: "));
            return Err(SceneError::file(
                &format!("{place}wall '{}'", wall.name),
                why,
                "take one of them out",
            ));
        }
        Ok(())
    }

    fn wall_file(&self, key: &str, source: &str) -> Result<WallFile> {
        let Input::Walls(walls) = self.file(key, source, Input::open_file)? else {
            let name = self.scene.folder.join(source).display().to_string();
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

    /// One wall for each material and surface velocity of the file, all with one motion.
    fn wall_spheres(&mut self, key: &str, name: &str, entry: &Wall, file: WallFile) -> Result<()> {
        self.inputs.push(("walls".to_owned(), file.hash.clone()));
        let belts = file.velocities.iter().any(|v| *v != Vec3::zeros());
        if belts && (entry.surface_velocity.is_some() || entry.surface_rotation.is_some()) {
            let why = "the file has the velocity of its surface already";
            let (at, cure) =
                (format!("{key}.surface_velocity"), "take it out, or make the file without velocity");
            return Err(self.check.wrong(&at, &file.name, why, cure));
        }
        let answers = entry.servo.is_some() || entry.spring.is_some();
        if answers && (file.materials.len() > 1 || file.velocities.len() > 1) {
            let why = "its spheres are of several materials or velocities, each of which would follow forces by itself";
            let (servo, cure) =
                (format!("{name}: servo or spring"), "use a file of one material and one velocity");
            return Err(self.check.wrong(&servo, &file.name, why, cure));
        }
        for (k, record) in file.materials.iter().enumerate() {
            for (n, velocity) in file.velocities.iter().enumerate() {
                let own =
                    file.spheres.iter().filter(|s| s.material as usize == k && s.velocity as usize == n);
                let spheres: Vec<(Vec3, f64)> = own.map(|s| (s.centre, s.radius)).collect();
                if spheres.is_empty() {
                    continue;
                }
                let index = match &entry.material {
                    Some(chosen) => {
                        self.check.material(&format!("{key}.material"), chosen, &self.materials)?
                    }
                    None => self.material_of(&file.name, record)?,
                };
                self.wall_materials.push(WallMaterial { index, record: record.clone() });
                let mut name = name.to_owned();
                if file.materials.len() > 1 {
                    name += &format!(" ({})", record.name);
                }
                if *velocity != Vec3::zeros() && file.velocities.len() > 1 {
                    name += &format!(" belt {n}");
                }
                let mut wall = self.wall(key, entry, name, index, entry.put(WallShape::Spheres(spheres)))?;
                wall.surface.velocity += entry.placement().map_or(*velocity, |place| place.vector(velocity));
                let numbers = entry.of_file().map(|rows| rows.map(|n| n.to_string()).join(" "));
                self.places.extend(numbers.map(|numbers| (self.walls.len().to_string(), numbers)));
                self.walls.push(wall);
            }
        }
        Ok(())
    }

    /// A wall that moves as its entry says.
    fn wall(
        &mut self,
        key: &str,
        entry: &Wall,
        name: String,
        material: u16,
        shape: WallShape,
    ) -> Result<setup::Wall> {
        let motion = self.motion(&format!("{key}.motion"), entry)?;
        let mut surface = SurfaceMotion::still();
        surface.velocity = Vec3::from(entry.surface_velocity.unwrap_or_default());
        if let Some(r) = &entry.surface_rotation {
            (surface.turn, surface.through) = (turn(r), Vec3::from(r.through));
        }
        if let Some(place) = entry.placement() {
            surface.velocity = place.vector(&surface.velocity);
            (surface.turn, surface.through) = (place.vector(&surface.turn), place.point(&surface.through));
        }
        self.pushes(key, entry, &shape)?;
        let servo = entry.servo.as_ref().map(|s| self.servo(&format!("{key}.servo"), s)).transpose()?;
        let mount = entry.spring.as_ref().map(|s| setup::Mount {
            direction: Vec3::from(s.direction).normalize(),
            stiffness: s.stiffness,
            damping: s.damping,
            mass: s.mass,
            speed_limit: s.speed_limit,
        });
        Ok(setup::Wall { motion, surface, servo, mount, ..setup::Wall::new(name, material, shape) })
    }

    /// Refuses a plane whose servo does not push to the side of the grains.
    fn pushes(&self, key: &str, entry: &Wall, shape: &WallShape) -> Result<()> {
        let (Some(servo), WallShape::Plane(plane)) = (&entry.servo, shape) else { return Ok(()) };
        if Vec3::from(servo.direction).normalize().dot(&plane.normal) > ACROSS {
            return Ok(());
        }
        let list = |vector: [f64; 3]| format!("[{}]", vector.map(|x| Shown(x).to_string()).join(", "));
        let normal = list(plane.normal.into());
        let why = format!("does not push to the side of the grains, to which the normal {normal} points");
        let cure = format!("give {normal}, or turn the normal round");
        Err(self.check.wrong(&format!("{key}.servo.direction"), list(servo.direction), &why, &cure))
    }

    /// The motions of an entry, one after the other.
    fn motion(&mut self, key: &str, entry: &Wall) -> Result<setup::Motion> {
        let mut parts = Vec::new();
        for (key, part) in entry.motion.iter().flat_map(|list| list.entries(key)) {
            let mut motion = motion(part);
            if part.from < 0.0 {
                let why = "the motion began before the run: the wall starts where it has come to by t = 0";
                let cure = "give 0 or leave it out if the wall starts where it is drawn";
                let at = format!("{key}.from");
                self.warnings.push(self.check.wrong(&at, format!("{} s", part.from), why, cure).to_string());
            }
            if let Some(path) = &part.path {
                let path_key = format!("{key}.path.source");
                let (rows, hash) =
                    self.file(&path_key, &path.source, |file| read_path(file, path.about.is_some()))?;
                self.inputs.push(("motion".to_owned(), hash));
                let about = path.about.map_or(Vec3::zeros(), Vec3::from);
                let table = Path::new(about, rows).map_err(|e| {
                    let cure = "give t in ascending order, one row for each time; positions are relative to the first row";
                    self.check.wrong(&path_key, format!("\"{}\"", path.source), &e.to_string(), cure)
                })?;
                if !table.moves() {
                    // In a sweep one of the paths may be that of rest.
                    let (why, value) =
                        ("all its rows are alike: it moves nothing", format!("\"{}\"", path.source));
                    let warning =
                        self.check.wrong(&path_key, value, why, "take it out if nothing is to move");
                    self.warnings.push(warning.to_string());
                }
                if let Some(through) = path.through {
                    motion.through = Vec3::from(through);
                }
                motion.path = Some(table);
            }
            parts.push(motion);
        }
        Ok(setup::Motion::of(parts))
    }

    /// Names and shapes of a wall that is a plane, a mesh or a box.
    fn surfaces(&mut self, key: &str, name: &str, entry: &Wall) -> Result<Vec<(String, WallShape)>> {
        if let Some(text) = &entry.plane {
            let plane = plane(&self.check, &format!("{key}.plane"), text)?;
            return Ok(vec![(name.to_owned(), entry.put(WallShape::Plane(plane)))]);
        }
        if let Some(file) = &entry.mesh {
            let mut warnings = Vec::new();
            let mesh = self.file(&format!("{key}.mesh"), file, |file| {
                read_mesh_warned(file, entry.length_factor(), &mut warnings)
            })?;
            self.warnings.extend(warnings);
            return Ok(vec![(name.to_owned(), entry.put(WallShape::Mesh(mesh)))]);
        }
        if let Some(text) = &entry.solid {
            let key = format!("{key}.solid");
            let shape = solids::wall(&self.shape(&key, text)?)
                .map_err(|(why, cure)| self.check.wrong(&key, format!("\"{text}\""), why, cure))?;
            return Ok(vec![(name.to_owned(), entry.put(shape))]);
        }
        let face = |(face, plane): (Face, Plane)| (face.of(name), WallShape::Plane(plane));
        Ok(entry.sides().into_iter().map(face).collect())
    }
}

/// Whether two walls have one shape, up to rounding, and stay on each other.
fn is_same(a: &setup::Wall, b: &setup::Wall) -> bool {
    let answers = |w: &setup::Wall| w.servo.is_some() || w.mount.is_some();
    if a.motion != b.motion || answers(a) || answers(b) {
        return false;
    }
    match (&a.shape, &b.shape) {
        (WallShape::Plane(a), WallShape::Plane(b)) => {
            let size = a.point.amax().max(b.point.amax());
            (a.normal - b.normal).norm() <= ALIKE && a.signed_distance(&b.point).abs() <= ALIKE * size
        }
        (WallShape::Mesh(a), WallShape::Mesh(b)) => a.faces == b.faces && a.vertices == b.vertices,
        (WallShape::Spheres(a), WallShape::Spheres(b)) => a == b,
        _ => false,
    }
}

/// Share of the motion of a plane along its normal from which on it pushes, as the engine has it [–].
const ACROSS: f64 = 1e-9;

/// Planes that differ by less are one [–].
const ALIKE: f64 = 1e-12;

/// A plane of a key.
pub(in crate::plan) fn plane(check: &Check, key: &str, text: &str) -> Result<Plane> {
    text.parse().map_err(|e: geom::plane::PlaneError| {
        check.wrong(key, format!("\"{text}\""), &e.to_string(), "write it px,py,pz,nx,ny,nz in metres")
    })
}

/// Axis times rate [rad/s].
fn turn(r: &Rotate) -> Vec3 {
    Vec3::from(r.about).normalize() * (r.rpm / 60.0 * TAU)
}

/// One motion, without its table over time.
fn motion(entry: &Motion) -> setup::Motion {
    let mut motion = setup::Motion::still();
    if let Some(r) = &entry.rotate {
        (motion.turn, motion.through) = (turn(r), Vec3::from(r.through));
    }
    if let Some(s) = &entry.swing {
        motion.swing = Vec3::from(s.about).normalize() * s.amplitude;
        (motion.swing_frequency, motion.through) = (s.frequency, Vec3::from(s.through));
    }
    (motion.from, motion.until) = (entry.from, entry.ends().unwrap_or(f64::INFINITY));
    motion.ramp = entry.ramp;
    motion.period = entry.repeat.unwrap_or(f64::INFINITY);
    motion.velocity = Vec3::from(entry.translate.unwrap_or_default());
    if let Some(v) = &entry.vibrate {
        motion.amplitude = Vec3::from(v.amplitude);
        motion.frequency = v.frequency;
    }
    motion
}
