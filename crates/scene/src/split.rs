//! A scene cut in two at a plane: the stage upstream records, the stage downstream lets in (SYSTEMS B1–B7).

use crate::error::SceneError;
use crate::inlet::plane_text;
use crate::input::Input;
use crate::model::{Diameter, Wall};
use crate::room::bounds;
use crate::{Scene, mesh_file, particle_file};
use geom::{Plane, Shape, Shown, Vec3};
use std::fs::File;
use std::path::{Path, PathBuf};
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, value};

/// Which stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Before the plane.
    Upstream,
    /// Behind it.
    Downstream,
}

/// Where a scene is cut.
#[derive(Debug, Clone)]
pub struct Cut {
    /// Its normal is the direction of flow.
    pub plane: Plane,
    /// Which stage is kept.
    pub keep: Stage,
    /// Length of the zone [m]; absent: "auto".
    pub length: Option<f64>,
    /// Folder that files of the new scene are relative to.
    pub folder: PathBuf,
}

/// The first id of particles that a downstream stage makes itself, out of reach of those that come in.
const OWN_IDS: i64 = 2_000_000_000;

/// Cuts a scene; the text of the stage, with the comments of what it keeps, and what was left out.
///
/// # Errors
/// Particles on both sides of the plane, a length that is too short, files that cannot be read.
pub fn split(scene: &Scene, cut: &Cut) -> Result<(String, Vec<String>), SceneError> {
    if let Some(clump) = scene.model.clump.first() {
        let why = format!("has clumps ('{}'), and a storage plane cannot record them", clump.name);
        return Err(SceneError::file(&scene.text.name, why, "use spheres, or run the plant undivided"));
    }
    let cutting = Cutting { scene, cut, largest: largest(scene)? };
    cutting.check_length()?;
    let mut document = scene.text.document()?;
    let mut found = Found::default();
    cutting.sources(&mut document, &mut found)?;
    cutting.zones(&mut document, &mut found)?;
    if !found.upstream {
        let why = "no grains start upstream of the plane: does its normal point with the flow?";
        return Err(SceneError::file(&scene.text.name, why, "turn the plane or move it"));
    }
    cutting.walls(&mut document, &mut found);
    cutting.rebase(&mut document);
    let (kind, word) = match cut.keep {
        Stage::Upstream => ("outlet", "upstream"),
        Stage::Downstream => ("inlet", "downstream"),
    };
    let mut zone = Table::new();
    zone.insert("plane", value(plane_text(&cut.plane)));
    if let Some(length) = cut.length {
        zone.insert("length", value(length));
    }
    zone.decor_mut().set_prefix(format!("\n# The cut: {word} stage.\n"));
    let tables = document.entry(kind).or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
    match tables.as_array_of_tables_mut() {
        Some(tables) => tables.push(zone),
        None => {
            let why = format!("'{kind}' is written as a list in one line");
            return Err(SceneError::file(&scene.text.name, why, format!("write it as [[{kind}]]")));
        }
    }
    Ok((document.to_string(), found.names()))
}

/// Largest diameter that the scene itself tells [m]; 0 when its particles come from an inlet alone.
fn largest(scene: &Scene) -> Result<f64, SceneError> {
    let m = &scene.model;
    let ranges = m.fill.iter().map(|f| f.diameter).chain(m.insert.iter().map(|f| f.diameter));
    let mut largest = ranges.map(|d: Diameter| d.high).fold(0.0, f64::max);
    for entry in &m.particles {
        let file = particle_file::read(&scene.folder.join(&entry.source))?;
        largest = file.particles.iter().map(|p| 2.0 * p.radius).fold(largest, f64::max);
    }
    Ok(largest)
}

/// What the cut finds in a scene.
#[derive(Default)]
struct Found {
    /// What is left out, each with its place in the text.
    gone: Vec<(Option<isize>, String)>,
    /// Whether grains start, or come in, upstream of the plane.
    upstream: bool,
}

impl Found {
    /// What is left out, in the order of the scene.
    fn names(mut self) -> Vec<String> {
        self.gone.sort_by_key(|(place, _)| *place);
        self.gone.into_iter().map(|(_, name)| name).collect()
    }
}

/// A wall as its author calls it.
fn wall_name(index: usize, wall: &Wall) -> String {
    wall.name.as_ref().map_or_else(|| format!("wall.{index}"), |name| format!("wall '{name}'"))
}

struct Cutting<'a> {
    scene: &'a Scene,
    cut: &'a Cut,
    largest: f64,
}

/// Distances [m] from the plane that something covers, lowest and highest.
type Range = (f64, f64);

impl Cutting<'_> {
    fn check_length(&self) -> Result<(), SceneError> {
        match self.cut.length {
            Some(length) if length.is_nan() || length <= self.largest => {
                let why = format!(
                    "--length {length} m is not above the largest diameter, {} m",
                    Shown(self.largest)
                );
                Err(SceneError::file(
                    &self.scene.text.name,
                    why,
                    format!("use at least {} m", Shown(1.2 * self.largest)),
                ))
            }
            _ => Ok(()),
        }
    }

    /// Whether something that covers this range belongs to the stage that is kept.
    fn keeps(&self, what: &str, range: Range) -> Result<bool, SceneError> {
        match (range.1 <= 0.0, range.0 >= 0.0, self.cut.keep) {
            (true, _, stage) => Ok(stage == Stage::Upstream),
            (_, true, stage) => Ok(stage == Stage::Downstream),
            _ => {
                let why = format!(
                    "{what} lies on both sides of the plane ({} to {} m from it)",
                    Shown(range.0),
                    Shown(range.1)
                );
                Err(SceneError::file(&self.scene.text.name, why, "move the plane, or divide it into two"))
            }
        }
    }

    fn of_points(&self, points: impl Iterator<Item = (Vec3, f64)>) -> Range {
        let distance = |p: Vec3| self.cut.plane.signed_distance(&p);
        points.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (p, r)| {
            (low.min(distance(p) - r), high.max(distance(p) + r))
        })
    }

    fn of_shape(&self, key: &str, text: &str) -> Result<Range, SceneError> {
        let wrong = |why: String| {
            SceneError::file(&self.scene.text.name, format!("{key}: {why}"), "use box, sphere or cylinder")
        };
        let shape: Shape = text.parse().map_err(|e: geom::shape::ShapeError| wrong(e.to_string()))?;
        let (low, high) = bounds(&shape).ok_or_else(|| wrong(format!("{text} has no end")))?;
        let corner = |i: usize| {
            Vec3::new(
                if i & 1 == 0 { low.x } else { high.x },
                if i & 2 == 0 { low.y } else { high.y },
                if i & 4 == 0 { low.z } else { high.z },
            )
        };
        Ok(self.of_points((0..8).map(|i| (corner(i), 0.0))))
    }

    /// Fills, inserts and particle files of the other stage.
    fn sources(&self, document: &mut DocumentMut, found: &mut Found) -> Result<(), SceneError> {
        let m = &self.scene.model;
        let mut kept = 0;
        let shapes = [
            ("fill", m.fill.iter().map(|f| f.shape.as_str()).collect::<Vec<_>>()),
            ("insert", m.insert.iter().map(|f| f.shape.as_str()).collect()),
        ];
        for (key, shapes) in shapes {
            for (i, shape) in shapes.iter().enumerate().rev() {
                let name = format!("{key}.{i}");
                let range = self.of_shape(&name, shape)?;
                found.upstream |= range.1 <= 0.0;
                if self.keeps(&name, range)? {
                    kept += 1;
                } else {
                    remove(document, key, i, name, found);
                }
            }
        }
        for (i, entry) in m.particles.iter().enumerate().rev() {
            let name = format!("particles.{i}");
            let file = particle_file::read(&self.scene.folder.join(&entry.source))?;
            let range = self.of_points(file.particles.iter().map(|p| (p.position, 0.0)));
            found.upstream |= range.1 <= 0.0;
            if self.keeps(&name, range)? {
                kept += 1;
            } else {
                remove(document, "particles", i, name, found);
            }
        }
        if kept > 0 && self.cut.keep == Stage::Downstream && m.first_id == 0 {
            document.insert("first_id", value(OWN_IDS));
        }
        Ok(())
    }

    /// Zones that are there already stay with the stage they lie in.
    fn zones(&self, document: &mut DocumentMut, found: &mut Found) -> Result<(), SceneError> {
        let m = &self.scene.model;
        let outlets = m.outlet.iter().map(|o| ("outlet", &o.plane)).enumerate().rev();
        let inlets = m.inlet.iter().map(|o| ("inlet", &o.plane)).enumerate().rev();
        for (i, (key, plane)) in outlets.chain(inlets) {
            let name = format!("{key}.{i}");
            let wrong = |e: geom::plane::PlaneError| {
                SceneError::file(&self.scene.text.name, format!("{name}: {e}"), "correct it")
            };
            let plane: Plane = plane.parse().map_err(wrong)?;
            let distance = self.cut.plane.signed_distance(&plane.point);
            found.upstream |= key == "inlet" && distance <= 0.0;
            if !self.keeps(&name, (distance, distance))? {
                remove(document, key, i, name, found);
            }
        }
        Ok(())
    }

    /// Walls at rest that no particle of the stage can reach.
    fn walls(&self, document: &mut DocumentMut, found: &mut Found) {
        for (i, wall) in self.scene.model.wall.iter().enumerate().rev() {
            let Some(range) = self.of_wall(wall).filter(|_| wall.motion.is_none()) else { continue };
            let reach = self.largest / 2.0;
            let unreachable = match self.cut.keep {
                Stage::Upstream => range.0 > reach,
                Stage::Downstream => range.1 < -reach,
            };
            if self.largest > 0.0 && unreachable {
                remove(document, "wall", i, wall_name(i, wall), found);
            }
        }
    }

    /// Where a wall is, when it has an end and its file can be read now.
    fn of_wall(&self, wall: &Wall) -> Option<Range> {
        if let Some(file) = &wall.mesh {
            let mesh = mesh_file::read(&self.scene.folder.join(file)).ok()?;
            return Some(self.of_points(mesh.vertices.iter().map(|v| (*v, 0.0))));
        }
        let path = self.scene.folder.join(wall.source.as_ref()?);
        let file = File::open(&path).ok()?;
        match Input::open(&path.display().to_string(), Box::new(file)).ok()? {
            Input::Walls(walls) if walls.velocity == Vec3::zeros() => {
                Some(self.of_points(walls.spheres.iter().map(|s| (s.0, s.1))))
            }
            _ => None,
        }
    }

    /// Files of the scene, as seen from the folder of the new one.
    fn rebase(&self, document: &mut DocumentMut) {
        for (table, keys) in
            [("wall", &["source", "mesh"][..]), ("particles", &["source"]), ("inlet", &["source"])]
        {
            let Some(tables) = document.get_mut(table).and_then(Item::as_array_of_tables_mut) else {
                continue;
            };
            for entry in tables.iter_mut() {
                for key in keys {
                    let Some(item) = entry.get_mut(key) else { continue };
                    if let Some(file) =
                        item.as_str().map(|f| relative(&self.scene.folder.join(f), &self.cut.folder))
                    {
                        *item = value(file);
                    }
                }
            }
        }
    }
}

fn remove(document: &mut DocumentMut, key: &str, index: usize, name: String, found: &mut Found) {
    if let Some(tables) = document.get_mut(key).and_then(Item::as_array_of_tables_mut) {
        let place = tables.get(index).and_then(Table::position);
        tables.remove(index);
        found.gone.push((place, name));
        if tables.is_empty() {
            document.remove(key);
        }
    }
}

/// A file as seen from a folder; as it is when the way is not known.
fn relative(file: &Path, folder: &Path) -> String {
    // An empty path is the folder that the tool was started in.
    let here = |p: &Path| match p.as_os_str().is_empty() {
        true => std::env::current_dir(),
        false => std::path::absolute(p),
    };
    let (Ok(to), Ok(from)) = (here(file), here(folder)) else { return file.display().to_string() };
    let (to, from) = (clean(&to), clean(&from));
    let common = to.iter().zip(&from).take_while(|(a, b)| a == b).count();
    let mut way = PathBuf::new();
    from[common..].iter().for_each(|_| way.push(".."));
    to[common..].iter().for_each(|part| way.push(part));
    way.display().to_string()
}

/// The parts of an absolute path, without `.` and `..`.
fn clean(path: &Path) -> Vec<std::ffi::OsString> {
    let mut parts = Vec::new();
    for part in path.components() {
        match part {
            std::path::Component::ParentDir => drop(parts.pop()),
            std::path::Component::Normal(name) => parts.push(name.to_owned()),
            _ => {}
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLANT: &str = r#"# plant
gravity = [0, 0, -9.81]
[time]
until = 1
[[material]]
name = "m" # grain
density = 1000
young = 1e6
poisson = 0.2
[[contact]]
between = ["*", "*"]
restitution = 0.5
[[fill]] # above
material = "m"
shape = "box:0,0,1,1,1,2"
diameter = 0.1
count = 5
[[fill]]
material = "m"
shape = "box:0,0,-2,1,1,-1"
diameter = 0.1
count = 5
[[wall]]
plane = "0,0,-3,0,0,1"
material = "m"
"#;

    fn cut(keep: Stage, at: &str, length: Option<f64>) -> Result<(String, Vec<String>), SceneError> {
        let scene = Scene::new("p.toml", PLANT.into(), &[], Path::new("")).unwrap();
        split(&scene, &Cut { plane: at.parse().unwrap(), keep, length, folder: PathBuf::new() })
    }

    #[test]
    fn both_stages_are_scenes_and_have_their_own_particles() {
        let (up, gone) = cut(Stage::Upstream, "0,0,0,0,0,-1", None).unwrap();
        assert_eq!(gone, ["fill.1"]);
        let scene = Scene::new("up", up.clone(), &[], Path::new("")).unwrap();
        assert_eq!((scene.model.fill.len(), scene.model.outlet.len(), scene.model.inlet.len()), (1, 1, 0));
        assert!(up.contains("# grain") && up.contains("# above") && up.starts_with("# plant"), "{up}");
        let (down, gone) = cut(Stage::Downstream, "0,0,0,0,0,-1", Some(0.2)).unwrap();
        assert_eq!(gone, ["fill.0"]);
        let scene = Scene::new("down", down, &[], Path::new("")).unwrap();
        assert_eq!((scene.model.fill[0].shape.as_str(), scene.model.inlet.len()), ("box:0,0,-2,1,1,-1", 1));
        assert_eq!(scene.model.first_id, 2_000_000_000);
    }

    #[test]
    fn a_cut_through_particles_or_a_short_zone_is_refused() {
        let message = cut(Stage::Upstream, "0,0,1.5,0,0,-1", None).unwrap_err().to_string();
        assert!(message.contains("fill.0 lies on both sides"), "{message}");
        let message = cut(Stage::Upstream, "0,0,0,0,0,-1", Some(0.1)).unwrap_err().to_string();
        assert!(message.contains("--length 0.1 m is not above the largest diameter, 0.1 m"), "{message}");
    }

    #[test]
    fn what_is_left_out_is_named_in_the_order_of_the_scene() {
        let folder = std::env::temp_dir().join(format!("split-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
            property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
            0 0 -2\n1 0 -2\n0 1 -2\n3 0 1 2\n";
        std::fs::write(folder.join("a.ply"), ply).unwrap();
        let wall = |name: &str| format!("[[wall]]\n{name}mesh = \"a.ply\"\nmaterial = \"m\"\n");
        let walls = [wall("name = \"chute\"\n"), wall(""), wall("name = \"lip\"\n")].concat();
        let scene = Scene::new("p.toml", format!("{PLANT}{walls}"), &[], &folder).unwrap();
        let plane = "0,0,0,0,0,-1".parse().unwrap();
        let at = Cut { plane, keep: Stage::Upstream, length: None, folder: folder.clone() };
        let (_, gone) = split(&scene, &at).unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(gone, ["fill.1", "wall 'chute'", "wall.2", "wall 'lip'"]);
    }

    #[test]
    fn a_plane_that_looks_the_wrong_way_is_refused() {
        for keep in [Stage::Upstream, Stage::Downstream] {
            let message = cut(keep, "0,0,5,0,0,-1", None).unwrap_err().to_string();
            assert!(message.contains("no grains start upstream of the plane: does its normal"), "{message}");
        }
    }

    #[test]
    fn files_are_seen_from_the_new_folder() {
        assert_eq!(relative(Path::new("/a/b/../c/w.mcap"), Path::new("/a/out")), "../c/w.mcap");
        assert_eq!(relative(Path::new("w.mcap"), Path::new("")), "w.mcap");
        assert_eq!(relative(Path::new("w.mcap"), Path::new("out")), "../w.mcap");
    }
}
