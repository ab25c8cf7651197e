//! `[[inlet]]`: zones that recorded particles enter by, and the streams that bring them; `[[outlet]]`: zones that record; `[[remove]]`: shapes that take grains out.

pub(in crate::plan) mod same_zone;

use crate::error::{Result, SceneError};
use crate::input::{InletSource, Input, ZoneRecord};
use crate::keys::Inlet;
use crate::plan::builder::{PlanBuilder, PlannedInlet};
use crate::plan::grains::packing::bounds;
use crate::plan::walls;
use dem::setup::{ClumpScales, EntryBonds, Removal, Zone};
use geom::{Shown, Vec3};
use record::{ClumpRecord, MaterialRecord};

/// Scales are written as text: the last digit may differ [–].
pub const SCALE_SLACK: f64 = 1e-12;

impl PlanBuilder<'_> {
    pub(in crate::plan) fn inlets(&mut self, streams: Vec<InletSource>) -> Result<()> {
        self.all_wanted(&streams)?;
        let mut given = streams.into_iter();
        for (i, entry) in self.keys().inlet.iter().enumerate() {
            let key = format!("inlet.{i}");
            let stream = match &entry.source {
                Some(source) => self.open_inlet(&format!("{key}.source"), source)?,
                None => given.next().ok_or_else(|| {
                    let why = "waits for an inlet of the command line, and none was given";
                    let cure = "give dem-run the inlet that stage-replay wrote (dem-run SCENE.toml INLET.mcap), or this entry source";
                    self.check.wrong(&key, "(without source)", why, cure)
                })?,
            };
            let zone = self.inlet_zone(&key, entry, &stream)?;
            let (gravity, plant) = (Some(self.keys().gravity.into()), entry.plant.clone());
            self.same_zone(&key, &ZoneRecord { zone, gravity, plant, samples: None }, &stream)?;
            self.add_inlet(stream, zone)?;
        }
        Ok(())
    }

    /// The zone of an entry; keys that it lacks are those of the stream.
    fn inlet_zone(&self, key: &str, entry: &Inlet, stream: &InletSource) -> Result<Zone> {
        let plane = walls::plane(&self.check, &format!("{key}.plane"), &entry.plane)?;
        let usual = Zone::new(plane, 2.4 * stream.sizes.largest);
        let Zone { length, motion, test, .. } = stream.zone.as_ref().map_or(usual, |recorded| recorded.zone);
        let (length, motion) = (entry.length.0.unwrap_or(length), entry.motion.unwrap_or(motion));
        Ok(Zone { plane, length, motion, test: entry.test.unwrap_or(test), when_blocked: None })
    }

    /// Refuses inlets that no entry of the scene waits for.
    fn all_wanted(&self, streams: &[InletSource]) -> Result<()> {
        let wanted = self.keys().inlet.iter().filter(|entry| entry.source.is_none()).count();
        let Some(left) = streams.get(wanted) else { return Ok(()) };
        let why = if self.keys().inlet.is_empty() {
            "the scene has no [[inlet]]".to_owned()
        } else {
            format!("{} inlets are given, and {wanted} [[inlet]] without source wait for one", streams.len())
        };
        Err(SceneError::file(&left.name, why, "add [[inlet]] plane = \"…\" to the scene, or leave it out"))
    }

    fn open_inlet(&self, key: &str, source: &str) -> Result<InletSource> {
        let Input::Inlet(stream) = self.file(key, source, Input::open_file)? else {
            let name = self.scene.folder.join(source).display().to_string();
            return Err(SceneError::file(&name, "holds walls, no crossings", "name it in [[wall]]"));
        };
        Ok(*stream)
    }

    fn add_inlet(&mut self, source: InletSource, zone: Zone) -> Result<()> {
        let name = &source.name;
        let mut materials = Vec::with_capacity(source.materials.len());
        // Every material of the stream must fit: which of them it brings is known only when it has brought them.
        for info in &source.materials {
            let material = self.material_of(name, info)?;
            self.same_density(name, info, material)?;
            if self.materials[material as usize].density > 0.0 && !source.only_clumps {
                self.entry_materials.push(material);
            }
            materials.push(material);
        }
        let shapes = self.shapes_of(name, &source.clumps)?;
        if source.bonds.is_some() && self.keys().bond.is_empty() {
            let why = "brings bonds, and the scene has no [[bond]]";
            return Err(SceneError::file(name, why, "add the [[bond]]s of the stage upstream to this one"));
        }
        let bonds = source.bonds.map(|b| EntryBonds { step: b.step, longest: b.longest });
        self.entry_bonds = EntryBonds::union(self.entry_bonds, bonds);
        self.will_enter(source.sizes, !source.only_clumps);
        let inlet = self.inlets.len() as u32;
        self.inlets.push(zone);
        self.streams.push(PlannedInlet { source, inlet, materials, shapes });
        Ok(())
    }

    /// Index of the scene's shape for each shape of a stream; those that may come are entries of the setup.
    fn shapes_of(&mut self, stream: &str, records: &[ClumpRecord]) -> Result<Vec<u32>> {
        let mut found = Vec::with_capacity(records.len());
        for record in records {
            let Some((low, high)) = record.scales else {
                found.push(u32::MAX);
                continue;
            };
            let shape = self.same_clump(stream, record, "cut both stages from one plant with stage-split")?;
            let (least, most) = (low * (1.0 - SCALE_SLACK), high * (1.0 + SCALE_SLACK));
            self.clumps.entries.push(ClumpScales { shape, least, most });
            found.push(shape);
        }
        Ok(found)
    }

    /// Refuses a stream whose particles would have another mass here.
    fn same_density(&self, stream: &str, info: &MaterialRecord, material: u16) -> Result<()> {
        let here = self.materials[material as usize].density;
        match info.density {
            Some(there) if here > 0.0 && there > 0.0 && (here - there).abs() > 1e-9 * there => {
                let at = self.keys().material.iter().position(|m| m.name == info.name);
                let key = at.map_or("material".to_owned(), |k| format!("material.{k}.density"));
                let why = format!("the grains of '{}' in {stream} have {} kg/m³", info.name, Shown(there));
                let cure =
                    "use the density of the stage upstream, or another name for what is denser or lighter";
                Err(self.check.wrong(&key, format!("{} kg/m³", Shown(here)), &why, cure))
            }
            _ => Ok(()),
        }
    }

    /// `[[remove]]`: shapes with an end.
    pub(in crate::plan) fn removals(&mut self) -> Result<()> {
        for (i, entry) in self.keys().remove.iter().enumerate() {
            let key = format!("remove.{i}.shape");
            let shape = self.shape(&key, &entry.shape)?;
            let Some(bounds) = bounds(&shape) else {
                let why = "has no end: only box, sphere, cylinder, cone and a closed mesh (without '!') take grains out";
                let cure = "use one of these, or an [[outlet]] for all that passes a plane";
                return Err(self.check.wrong(&key, &entry.shape, why, cure));
            };
            let (low, high) = bounds;
            if (0..3).any(|axis| !(high[axis] > low[axis])) {
                let cure = "give each of its sides a length";
                return Err(self.check.wrong(
                    &key,
                    &entry.shape,
                    "has no volume: it takes nothing out",
                    cure,
                ));
            }
            self.within_domain(&key, &entry.shape, bounds)?;
            self.removals.push(Removal { shape, bounds });
        }
        Ok(())
    }

    /// Refuses a shape outside the periodic domain, in which all positions are; one that reaches out of it acts within it.
    fn within_domain(&mut self, key: &str, text: &str, (low, high): (Vec3, Vec3)) -> Result<()> {
        let domain = &self.keys().domain;
        let (ends, periodic) = ([domain.low, domain.high], domain.periodic.clone());
        let [Some(from), Some(to)] = ends else { return Ok(()) };
        for axis in periodic.iter().map(|axis| *axis as usize) {
            let name = ["x", "y", "z"][axis];
            let range = format!("{} to {} m", Shown(from[axis]), Shown(to[axis]));
            if low[axis] >= to[axis] || high[axis] <= from[axis] {
                let why =
                    format!("lies outside the periodic domain, {range} along {name}: it takes nothing out");
                return Err(self.check.wrong(key, text, &why, "move it into the domain"));
            }
            if low[axis] < from[axis] || high[axis] > to[axis] {
                self.warnings.push(format!(
                    "{key}: reaches beyond the periodic domain, {range} along {name}: it acts within it only; for the part behind the face add another [[remove]]"
                ));
            }
        }
        Ok(())
    }

    /// `[[outlet]]`: storage planes with their zones.
    pub(in crate::plan) fn outlets(&mut self) -> Result<()> {
        let largest = 2.0 * self.sizes().map_or(0.0, |s| s.largest).max(self.widest_clump());
        for (i, entry) in self.keys().outlet.iter().enumerate() {
            let plane = walls::plane(&self.check, &format!("outlet.{i}.plane"), &entry.plane)?;
            let length = entry.length.0.unwrap_or(1.2 * largest);
            if length <= largest {
                let why = format!("is not above the largest diameter, {} m", Shown(largest));
                let cure = format!("use \"auto\", or at least {} m", Shown(1.2 * largest));
                let key = format!("outlet.{i}.length");
                return Err(self.check.wrong(&key, format!("{length} m"), &why, &cure));
            }
            self.outlets.push(Zone {
                plane,
                length,
                motion: entry.motion,
                test: entry.test,
                when_blocked: None,
            });
        }
        Ok(())
    }
}
