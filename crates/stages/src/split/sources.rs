//! Where particles come from: fills, insertions, files, and the zones that are there already.

use super::Stage;
use super::cutting::Cutting;
use super::found::{Found, remove};
use geom::{Plane, Vec3};
use record::column::{POSITION, SCALE};
use scene::input::{ParticleFile, ParticleTable};
use scene::keys::Particles;
use scene::{Scene, SceneError};
use toml_edit::{DocumentMut, value};

/// The first id of particles that a stage downstream makes itself; ids of those that come in are below it.
const OWN_IDS: u32 = 2_000_000_000;

/// Positions of the particles, or clumps, of a file [m].
pub fn places(scene: &Scene, entry: &Particles) -> Result<Vec<Vec3>, SceneError> {
    let path = scene.folder.join(&entry.source);
    if entry.clump.is_none() {
        return Ok(ParticleFile::read(&path)?.particles.iter().map(|p| p.position).collect());
    }
    Ok(ParticleTable::read(&path)?.columns().vectors(POSITION)?)
}

/// Largest scale of the clumps of a file [–].
pub fn largest_scale(scene: &Scene, entry: &Particles) -> Result<f64, SceneError> {
    if entry.clump.is_none() {
        return Ok(1.0);
    }
    let file = ParticleTable::read(&scene.folder.join(&entry.source))?;
    match file.table.get(SCALE) {
        None => Ok(1.0),
        Some(_) => Ok(file.columns().numbers(SCALE)?.into_iter().fold(0.0, f64::max)),
    }
}

/// One more than the ids that a file names; 0 where it names none.
fn after_ids(scene: &Scene, entry: &Particles) -> Result<u32, SceneError> {
    if entry.clump.is_some() {
        return Ok(0);
    }
    let file = ParticleFile::read(&scene.folder.join(&entry.source))?;
    let last = file.particles.iter().map(|p| p.id.saturating_add(1)).max().unwrap_or(0);
    Ok(if file.has_ids { last } else { 0 })
}

/// The first id for a plant with this first id. A plant that begins at [`OWN_IDS`] already is such a stage: then halfway to the last id.
fn own_ids(first: u32) -> i64 {
    if first < OWN_IDS { i64::from(OWN_IDS) } else { i64::from(first + (u32::MAX - first) / 2) }
}

impl Cutting<'_> {
    /// Fills, inserts, particle files and single clumps of the other stage.
    pub fn sources(&self, document: &mut DocumentMut, found: &mut Found) -> Result<(), SceneError> {
        let m = &self.scene.keys;
        let (mut kept, mut taken) = (0, 0);
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
            let range = self.of_points(places(self.scene, entry)?.into_iter().map(|p| (p, 0.0)));
            found.upstream |= range.1 <= 0.0;
            if self.keeps(&name, range)? {
                kept += 1;
            } else {
                if self.cut.keep == Stage::Upstream {
                    taken = taken.max(after_ids(self.scene, entry)?);
                }
                remove(document, "particles", i, name, found);
            }
        }
        for (i, body) in m.body.iter().enumerate().rev() {
            let name = format!("body.{i}");
            let range = self.of_points([(body.position.into(), 0.0)].into_iter());
            found.upstream |= range.1 <= 0.0;
            if self.keeps(&name, range)? {
                kept += 1;
            } else {
                remove(document, "body", i, name, found);
            }
        }
        match self.cut.keep {
            Stage::Downstream if kept > 0 => drop(document.insert("first_id", value(own_ids(m.first_id)))),
            // In the plant, ids of fills and insertions follow those of its files, which may stay downstream.
            _ if taken > m.first_id => drop(document.insert("first_id", value(i64::from(taken)))),
            _ => {}
        }
        Ok(())
    }

    /// Zones that are there already stay with the stage they lie in.
    pub fn zones(&self, document: &mut DocumentMut, found: &mut Found) -> Result<(), SceneError> {
        let m = &self.scene.keys;
        let outlets = m.outlet.iter().map(|o| ("outlet", &o.plane)).enumerate().rev();
        let inlets = m.inlet.iter().map(|o| ("inlet", &o.plane)).enumerate().rev();
        for (i, (key, plane)) in outlets.chain(inlets) {
            let name = format!("{key}.{i}");
            let wrong = |e: geom::plane::PlaneError| {
                SceneError::file(&self.scene.text.name, format!("{name}: {e}"), "correct it")
            };
            let plane: Plane = plane.parse().map_err(wrong)?;
            let distance = self.cut.plane.signed_distance(&plane.point);
            if key == "outlet"
                && self.cut.keep == Stage::Upstream
                && distance <= 0.0
                && plane.normal.dot(&self.cut.plane.normal) > 0.99
            {
                let why = format!("{name} is a cut upstream of this one: no grain gets here");
                let cure = "cut the stage downstream of it, which has an [[inlet]] there";
                return Err(SceneError::file(&self.scene.text.name, why, cure));
            }
            found.upstream |= key == "inlet" && distance <= 0.0;
            if !self.keeps(&name, (distance, distance))? {
                remove(document, key, i, name, found);
            }
        }
        Ok(())
    }
}
