//! The mark of a plant: a hash of what the flow through the cut depends on, so that a record of another plant is refused.
//!
//! Hashed are, of the stage upstream: gravity, domain and drag; particles and clumps; bounded walls that begin more than half a diameter
//! before the cut, files by their content; unbounded planes that come nearer than a diameter to the column in which particles start, down
//! to half a diameter before the cut ([`super::sides`]); the materials of all these, and the contacts of the particles. All else is left
//! out, also planes far from that column: plants that differ only behind the cut have the same mark.

use super::cutting::{Cutting, Range};
use super::walls::planes;
use dem::setup::WallShape;
use geom::{Plane, Vec3};
use scene::input::{Input, ParticleFile, ParticleTable, read_mesh};
use scene::keys::Wall;
use scene::plan::most_specific;
use scene::{Result, SceneError};
use std::collections::BTreeSet;
use toml::{Table, Value};

/// What a mark hashes.
#[derive(Default)]
struct Kept {
    table: Table,
    /// Materials of grains, and of walls.
    grains: BTreeSet<String>,
    walls: BTreeSet<String>,
}

/// A wall that has an end.
pub struct Bounded {
    pub range: Range,
    /// SHA-256 of its shape.
    hash: String,
    /// Materials that its file names.
    materials: Vec<String>,
}

impl Cutting<'_> {
    /// The beginning of a hash, of a scene that is a stage upstream.
    pub fn mark(&self) -> Result<String> {
        let all: Table = toml::from_str(&self.scene.text.toml).unwrap_or_default();
        let mut kept = Kept::default();
        for key in ["gravity", "domain", "drag", "fill", "insert", "remove", "body"] {
            kept.table.extend(all.get(key).map(|value| (key.to_owned(), value.clone())));
        }
        self.mark_grains(&all, &mut kept)?;
        self.mark_walls(&all, &mut kept);
        self.mark_materials(&all, &mut kept);
        let mut mark = stream::sha256(Value::Table(kept.table).to_string().as_bytes());
        mark.truncate(16);
        Ok(mark)
    }

    /// Where particles come from; of an inlet its plane, and the mark that it has itself.
    fn mark_grains(&self, all: &Table, kept: &mut Kept) -> Result<()> {
        let m = &self.scene.keys;
        kept.grains.extend(m.fill.iter().flat_map(|f| f.grains().names().0));
        kept.grains.extend(m.insert.iter().flat_map(|f| f.grains().names().0));
        self.mark_clumps(all, kept)?;
        let mut files = entries(all, "particles");
        for (entry, table) in m.particles.iter().zip(&mut files) {
            if entry.clump.is_some() {
                let file =
                    ParticleTable::read(&self.scene.folder.join(&entry.source), entry.length_factor())?;
                table.insert("source".to_owned(), record::hash(&file.table).into());
                continue;
            }
            let file = ParticleFile::read(&self.scene.folder.join(&entry.source), entry.length_factor())?;
            kept.grains.extend(entry.material.clone());
            kept.grains.extend(file.materials.into_iter().map(|m| m.name));
            table.insert("source".to_owned(), file.hash.into());
        }
        kept.put("particles", files);
        let mut inlets = entries(all, "inlet");
        inlets.iter_mut().for_each(|table| table.retain(|key, _| key == "plane" || key == "plant"));
        kept.put("inlet", inlets);
        Ok(())
    }

    /// Shapes of clumps, meshes by what is in them.
    fn mark_clumps(&self, all: &Table, kept: &mut Kept) -> Result<()> {
        let mut clumps = entries(all, "clump");
        for (clump, table) in self.scene.keys.clump.iter().zip(&mut clumps) {
            kept.grains.insert(clump.material.clone());
            if let Some(file) = &clump.mesh {
                let path = self.scene.folder.join(file);
                let bytes = stream::whole::file(&path).map_err(|e| SceneError::read(&path, e))?;
                table.insert("mesh".to_owned(), stream::sha256(&bytes).into());
            }
        }
        kept.put("clump", clumps);
        Ok(())
    }

    fn mark_walls(&self, all: &Table, kept: &mut Kept) {
        let mut walls = Vec::new();
        let column = self.column();
        for (wall, mut table) in self.scene.keys.wall.iter().zip(entries(all, "wall")) {
            let near: Vec<Value> = planes(wall)
                .iter()
                .filter(|plane| column.as_ref().is_some_and(|c| c.meets(plane, self.largest)))
                .map(|plane| place(plane).into())
                .collect();
            if !near.is_empty() {
                kept.walls.extend(wall.material.clone());
                ["name", "plane", "box", "faces", "place"].iter().for_each(|key| drop(table.remove(*key)));
                table.insert("planes".to_owned(), Value::Array(near));
                walls.push(table);
                continue;
            }
            // A wall that begins at the cut belongs to the stage downstream.
            let before = |b: &Bounded| b.range.0 < -self.largest / 2.0;
            let Some(bounded) = self.bounded(wall).filter(before) else { continue };
            kept.walls.extend(bounded.materials);
            kept.walls.extend(wall.material.clone());
            ["name", "mesh", "solid", "source"].iter().for_each(|key| drop(table.remove(*key)));
            table.insert("shape".to_owned(), bounded.hash.into());
            walls.push(table);
        }
        kept.put("wall", walls);
    }

    /// Materials of all that is kept, and the contacts between its particles, and between particles and walls.
    fn mark_materials(&self, all: &Table, kept: &mut Kept) {
        let named = |t: &Table| {
            let name = t.get("name").and_then(Value::as_str).unwrap_or_default();
            kept.grains.contains(name) || kept.walls.contains(name)
        };
        let materials = entries(all, "material").into_iter().filter(named).collect();
        let (tables, mut contacts) = (entries(all, "contact"), Vec::new());
        for a in &kept.grains {
            for b in kept.grains.union(&kept.walls) {
                let in_force = most_specific(&self.scene.keys.contact, a, b).and_then(|i| tables.get(i));
                if let Some(mut table) = in_force.cloned() {
                    table.insert("between".to_owned(), vec![a.clone(), b.clone()].into());
                    contacts.push(table);
                }
            }
        }
        kept.put("material", materials);
        kept.put("contact", contacts);
    }

    /// A wall that has an end and whose file can be read now.
    pub fn bounded(&self, wall: &Wall) -> Option<Bounded> {
        let place = wall.placement();
        let put = |at: &Vec3| place.map_or(*at, |place| place.point(at));
        if let Some(file) = &wall.mesh {
            let path = self.scene.folder.join(file);
            let mesh = read_mesh(&path, wall.length_factor()).ok()?;
            let range = self.of_points(mesh.vertices.iter().map(|v| (put(v), 0.0)));
            let hash = stream::sha256(&stream::whole::file(&path).ok()?);
            return Some(Bounded { range, hash, materials: Vec::new() });
        }
        if let Some(text) = &wall.solid {
            let points = match scene::plan::solid(&text.parse().ok()?).ok()? {
                WallShape::Spheres(spheres) => spheres,
                WallShape::Mesh(mesh) => mesh.vertices.iter().map(|v| (*v, 0.0)).collect(),
                WallShape::Plane(_) => return None,
            };
            let hash = stream::sha256(text.as_bytes());
            let range = self.of_points(points.iter().map(|(centre, radius)| (put(centre), *radius)));
            return Some(Bounded { range, hash, materials: Vec::new() });
        }
        let path = self.scene.folder.join(wall.source.as_ref()?);
        match Input::open_file(&path).ok()? {
            Input::Walls(mut walls) => {
                walls.scale(wall.length_factor());
                Some(Bounded {
                    range: self.of_points(walls.spheres.iter().map(|s| (put(&s.centre), s.radius))),
                    hash: walls.hash.clone(),
                    materials: walls.materials.iter().map(|m| m.name.clone()).collect(),
                })
            }
            _ => None,
        }
    }
}

impl Kept {
    fn put(&mut self, key: &str, tables: Vec<Table>) {
        if !tables.is_empty() {
            let tables = tables.into_iter().map(Value::Table).collect();
            self.table.insert(key.to_owned(), Value::Array(tables));
        }
    }
}

/// A plane by its normal and offset, so that the point that it was given by does not matter.
fn place(plane: &Plane) -> String {
    let n = plane.normal;
    format!("{},{},{} at {}", n.x, n.y, n.z, n.dot(&plane.point))
}

/// The entries of a list of a scene.
fn entries(all: &Table, key: &str) -> Vec<Table> {
    let list = all.get(key).and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    list.iter().filter_map(Value::as_table).cloned().collect()
}
