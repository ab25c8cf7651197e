//! Where particles come from: fills, insertions, files, and the zones that are there already.

use super::Stage;
use super::cutting::{Cutting, Range, StageText};
use geom::{Plane, Vec3};
use record::column::{POSITION, SCALE};
use scene::input::{ParticleFile, ParticleTable};
use scene::keys::{OneOrRange, Particles};
use scene::{Result, Scene};
use toml_edit::value;

/// The first id of particles that a stage downstream makes itself; ids of those that come in are below it.
const OWN_IDS: u32 = 2_000_000_000;

/// Positions of the particles, or clumps, of a file [m].
pub fn places(scene: &Scene, entry: &Particles) -> Result<Vec<Vec3>> {
    let path = scene.folder.join(&entry.source);
    if entry.clump.is_none() {
        return Ok(ParticleFile::read(&path, entry.length_factor())?
            .particles
            .iter()
            .map(|p| p.position)
            .collect());
    }
    Ok(ParticleTable::read(&path, entry.length_factor())?.columns().vectors(POSITION)?)
}

/// Largest scale of the clumps of a file [–].
pub fn largest_scale(scene: &Scene, entry: &Particles) -> Result<f64> {
    if entry.clump.is_none() {
        return Ok(1.0);
    }
    let file = ParticleTable::read(&scene.folder.join(&entry.source), entry.length_factor())?;
    match file.table.get(SCALE) {
        None => Ok(1.0),
        Some(_) => Ok(file.columns().numbers(SCALE)?.into_iter().fold(0.0, f64::max)),
    }
}

/// Largest diameter of the scene's own particles [m], of clumps that of the sphere which holds them; 0 when all come from an inlet.
pub(super) fn largest(scene: &Scene) -> Result<f64> {
    let m = &scene.keys;
    let mut largest = scene.largest_diameters()?.into_iter().fold(0.0, f64::max);
    for entry in m.particles.iter().filter(|p| p.clump.is_none()) {
        let file = ParticleFile::read(&scene.folder.join(&entry.source), entry.length_factor())?;
        largest = file.particles.iter().map(|p| 2.0 * p.radius).fold(largest, f64::max);
    }
    let reaches = if m.clump.is_empty() { Vec::new() } else { scene.clump_reaches()? };
    for (clump, reach) in m.clump.iter().zip(reaches) {
        let high = |scale: Option<OneOrRange>| scale.map_or(1.0, |s| s.high);
        let fills = m.fill.iter().map(|f| (f.clump.as_deref(), high(f.scale)));
        let insertions = m.insert.iter().map(|f| (f.clump.as_deref(), high(f.scale)));
        let bodies = m.body.iter().map(|b| (Some(b.clump.as_str()), b.scale));
        let mut files = Vec::new();
        for entry in &m.particles {
            files.push((entry.clump.as_deref(), largest_scale(scene, entry)?));
        }
        let own =
            fills.chain(insertions).chain(bodies).chain(files).filter(|(name, _)| *name == Some(&clump.name));
        largest = own.map(|(_, scale)| 2.0 * reach * scale).fold(largest, f64::max);
    }
    Ok(largest)
}

/// One more than the ids that a file names; 0 where it names none.
fn after_ids(scene: &Scene, entry: &Particles) -> Result<u32> {
    if entry.clump.is_some() {
        return Ok(0);
    }
    let file = ParticleFile::read(&scene.folder.join(&entry.source), entry.length_factor())?;
    let last = file.particles.iter().map(|p| p.id.saturating_add(1)).max().unwrap_or(0);
    Ok(if file.has_ids { last } else { 0 })
}

/// The first id for a plant with this first id. A plant that begins at [`OWN_IDS`] already is such a stage: then halfway to the last id.
fn own_ids(first: u32) -> i64 {
    if first < OWN_IDS { i64::from(OWN_IDS) } else { i64::from(first + (u32::MAX - first) / 2) }
}

impl Cutting<'_> {
    /// Fills, inserts, particle files and single clumps of the other stage.
    pub fn sources(&self, text: &mut StageText) -> Result<()> {
        let m = &self.scene.keys;
        let (mut own, mut taken) = (false, 0);
        let fills = m.fill.iter().map(|f| ("fill", &f.shape)).enumerate().rev();
        let insertions = m.insert.iter().map(|f| ("insert", &f.shape)).enumerate().rev();
        for (i, (key, shape)) in fills.chain(insertions) {
            let range = self.of_shape(&format!("{key}.{i}"), shape)?;
            own |= self.source(text, key, i, range)?;
        }
        for (i, entry) in m.particles.iter().enumerate().rev() {
            let range = self.of_points(places(self.scene, entry)?.into_iter().map(|p| (p, 0.0)));
            let keeps = self.source(text, "particles", i, range)?;
            own |= keeps;
            if !keeps && self.cut.keep == Stage::Upstream {
                taken = taken.max(after_ids(self.scene, entry)?);
            }
        }
        for (i, body) in m.body.iter().enumerate().rev() {
            let range = self.of_points(std::iter::once((body.position.into(), 0.0)));
            own |= self.source(text, "body", i, range)?;
        }
        match self.cut.keep {
            Stage::Downstream if own => drop(text.document.insert("first_id", value(own_ids(m.first_id)))),
            // In the plant, ids of fills and insertions follow those of its files, which may stay downstream.
            _ if taken > m.first_id => drop(text.document.insert("first_id", value(i64::from(taken)))),
            _ => {}
        }
        Ok(())
    }

    /// Leaves a source out that lies in the other stage; whether it stays.
    fn source(&self, text: &mut StageText, key: &str, index: usize, range: Range) -> Result<bool> {
        let name = format!("{key}.{index}");
        text.upstream |= range.1 <= 0.0;
        let keeps = self.keeps(&name, range)?;
        if !keeps {
            text.remove(key, index, name);
        }
        Ok(keeps)
    }

    /// Zones that are there already stay with the stage they lie in.
    pub fn zones(&self, text: &mut StageText) -> Result<()> {
        let m = &self.scene.keys;
        let outlets = m.outlet.iter().map(|o| ("outlet", &o.plane)).enumerate().rev();
        let inlets = m.inlet.iter().map(|o| ("inlet", &o.plane)).enumerate().rev();
        for (i, (key, plane)) in outlets.chain(inlets) {
            let name = format!("{key}.{i}");
            let wrong = |e: geom::plane::PlaneError| self.wrong(format!("{name}: {e}"), "correct it");
            let plane: Plane = plane.parse().map_err(wrong)?;
            let distance = self.cut.plane.signed_distance(&plane.point);
            if key == "outlet"
                && self.cut.keep == Stage::Upstream
                && distance <= 0.0
                && plane.normal.dot(&self.cut.plane.normal) > 0.99
            {
                let why = format!("{name} is a cut upstream of this one: no grain reaches this plane");
                let cure = "cut the stage downstream of it, which has an [[inlet]] there";
                return Err(self.wrong(why, cure));
            }
            text.upstream |= key == "inlet" && distance <= 0.0;
            if !self.keeps(&name, (distance, distance))? {
                text.remove(key, i, name);
            }
        }
        Ok(())
    }
}
