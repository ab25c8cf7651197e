//! `[[wall]]` to the engine's walls.

use crate::check::Check;
use crate::error::SceneError;
use crate::model::{Face, Motion, Servo, Wall};
use crate::plan::Draft;
use crate::wall_file::WallFile;
use dem::setup::{self, WallShape};
use geom::{Plane, Vec3};
use std::f64::consts::TAU;
use std::fs::File;

const ALL: [Face; 6] = [Face::LowX, Face::HighX, Face::LowY, Face::HighY, Face::LowZ, Face::HighZ];

/// Adds the walls of the scene, and those of the command line.
///
/// # Errors
/// Files that cannot be read, unknown materials, walls of the command line that no entry waits for.
pub(crate) fn add(draft: &mut Draft, entries: &[Wall], given: Vec<WallFile>) -> Result<(), SceneError> {
    let mut given = given.into_iter();
    for (i, entry) in entries.iter().enumerate() {
        let key = format!("wall.{i}");
        let name = entry.name.clone().unwrap_or_else(|| key.clone());
        let motion =
            setup::Motion { servo: entry.servo.as_ref().map(servo), ..motion(entry.motion.as_ref()) };
        if entry.source.is_none() && entry.plane.is_none() && entry.mesh.is_none() && entry.cuboid.is_none() {
            let Some(file) = given.next() else {
                let why = "waits for walls of the command line, and none were given";
                let cure = "give dem-run the walls that wallgen wrote (dem-run SCENE.toml WALLS.mcap), or this entry source, plane, \
                            mesh or box";
                return Err(draft.check.wrong(&key, "(without source)", why, cure));
            };
            spheres(draft, &name, entry, motion, file)?;
        } else if let Some(source) = &entry.source {
            let file = read(draft, source)?;
            spheres(draft, &name, entry, motion, file)?;
        } else {
            let material = material(draft, &key, entry)?;
            for (name, shape) in surfaces(draft, &key, &name, entry)? {
                draft.walls.push(setup::Wall { name, material, shape, motion });
            }
        }
    }
    for (n, file) in given.enumerate() {
        let entry = Wall::default();
        let name = if n == 0 { "given".to_owned() } else { format!("given.{n}") };
        spheres(draft, &name, &entry, setup::Motion::still(), file)?;
    }
    Ok(())
}

fn read(draft: &Draft, source: &str) -> Result<WallFile, SceneError> {
    let path = draft.path(source);
    let name = path.display().to_string();
    let file = File::open(&path).map_err(|source| SceneError::Read { name: name.clone(), source })?;
    match crate::input::Input::open(&name, Box::new(file))? {
        crate::input::Input::Walls(walls) => Ok(walls),
        crate::input::Input::Inlet(_) => {
            Err(SceneError::file(&name, "is an inlet, no walls", "name it in [[inlet]]"))
        }
    }
}

fn material(draft: &Draft, key: &str, entry: &Wall) -> Result<u16, SceneError> {
    let Some(name) = &entry.material else {
        return Err(draft.check.wrong(
            key,
            "(without material)",
            "material is missing",
            "add material = \"…\"",
        ));
    };
    draft.check.material(&format!("{key}.material"), name, &draft.materials)
}

/// One wall for each material of the file, all with one motion.
fn spheres(
    draft: &mut Draft,
    name: &str,
    entry: &Wall,
    mut motion: setup::Motion,
    file: WallFile,
) -> Result<(), SceneError> {
    draft.inputs.push(("walls".to_owned(), file.hash.clone()));
    if motion.servo.is_some() && file.materials.len() > 1 {
        let why = "its spheres are of several materials, each of which would follow the force by itself";
        return Err(draft.check.wrong(
            &format!("{name}: servo"),
            &file.name,
            why,
            "use a file of one material",
        ));
    }
    motion.velocity += file.velocity;
    for (k, info) in file.materials.iter().enumerate() {
        let spheres: Vec<(Vec3, f64)> =
            file.spheres.iter().filter(|s| s.2 as usize == k).map(|s| (s.0, s.1)).collect();
        if spheres.is_empty() {
            continue;
        }
        let material = match &entry.material {
            Some(chosen) => draft.check.material("wall.material", chosen, &draft.materials)?,
            None => draft.material_of(&file.name, info)?,
        };
        draft.wall_infos.push((material, info.clone()));
        let name =
            if file.materials.len() == 1 { name.to_owned() } else { format!("{name} ({})", info.name) };
        draft.walls.push(setup::Wall { name, material, shape: WallShape::Spheres(spheres), motion });
    }
    Ok(())
}

fn surfaces(
    draft: &Draft,
    key: &str,
    name: &str,
    entry: &Wall,
) -> Result<Vec<(String, WallShape)>, SceneError> {
    if let Some(text) = &entry.plane {
        let plane = plane(&draft.check, &format!("{key}.plane"), text)?;
        return Ok(vec![(name.to_owned(), WallShape::Plane(plane))]);
    }
    if let Some(file) = &entry.mesh {
        let mesh = crate::mesh_file::read(&draft.path(file))?;
        return Ok(vec![(name.to_owned(), WallShape::Mesh(mesh))]);
    }
    let corners = entry.cuboid.unwrap_or_default();
    let faces = entry.faces.as_deref().unwrap_or(&ALL);
    Ok(faces
        .iter()
        .map(|face| (format!("{name} {}", face_name(*face)), WallShape::Plane(side(&corners, *face))))
        .collect())
}

/// A plane of a key.
pub(crate) fn plane(check: &Check, key: &str, text: &str) -> Result<Plane, SceneError> {
    text.parse().map_err(|e: geom::plane::PlaneError| {
        check.wrong(key, format!("\"{text}\""), &e.to_string(), "write it px,py,pz,nx,ny,nz in metres")
    })
}

fn face_name(face: Face) -> &'static str {
    ["x-", "x+", "y-", "y+", "z-", "z+"][face as usize]
}

/// The plane of a face; its normal points into the box.
fn side(corners: &[f64; 6], face: Face) -> Plane {
    let (axis, high) = (face as usize / 2, face as usize % 2);
    let point = Vec3::from_column_slice(&corners[3 * high..3 * high + 3]);
    let normal = Vec3::ith(axis, if high == 1 { -1.0 } else { 1.0 });
    Plane { point, normal }
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
