//! `[[inlet]]`, `[[insert]]` and `[[outlet]]` to the engine's zones, and what feeds them.

use crate::crossings::Sizes;
use crate::error::SceneError;
use crate::faucet::{Faucet, Poured};
use crate::gate::Gate;
use crate::inlet::InletStream;
use crate::input::Input;
use crate::material_info::MaterialInfo;
use crate::model::{Diameter, Insert, OrAuto};
use crate::plan::Draft;
use crate::walls;
use dem::setup::{EntryBonds, WallShape, Zone};
use geom::Shown;

impl Draft<'_> {
    pub(crate) fn inlets(&mut self, streams: Vec<InletStream>) -> Result<(), SceneError> {
        self.all_wanted(&streams)?;
        let mut given = streams.into_iter();
        for (i, entry) in self.model().inlet.iter().enumerate() {
            let key = format!("inlet.{i}");
            let stream = match &entry.source {
                Some(source) => self.open_inlet(source)?,
                None => given.next().ok_or_else(|| {
                    let why = "waits for an inlet of the command line, and none was given";
                    self.check.wrong(
                        &key,
                        "(without source)",
                        why,
                        "give dem-run the inlet that stage-replay wrote (dem-run SCENE.toml INLET.mcap), or this entry source",
                    )
                })?,
            };
            let plane = walls::plane(&self.check, &format!("{key}.plane"), &entry.plane)?;
            let recorded = stream.gate.as_ref().map(|g| g.zone);
            let length = match (entry.length, recorded) {
                (OrAuto::Given(length), _) => length,
                (OrAuto::Auto, Some(zone)) => zone.length,
                (OrAuto::Auto, None) => 2.4 * stream.sizes.largest,
            };
            let zone = Zone {
                plane,
                length,
                motion: entry.motion.or(recorded.map(|z| z.motion)).unwrap_or_default(),
                test: entry.test.or(recorded.map(|z| z.test)).unwrap_or_default(),
            };
            if let Some(gate) = &stream.gate {
                let (gravity, plant) = (Some(self.model().gravity.into()), entry.plant.clone());
                let given = Gate { zone, gravity, plant, samples: None };
                given.fits(&self.check, &key, gate, &stream.name)?;
            }
            self.feed(stream, zone)?;
        }
        Ok(())
    }

    /// Refuses inlets that no entry of the scene waits for.
    fn all_wanted(&self, streams: &[InletStream]) -> Result<(), SceneError> {
        let wanted = self.model().inlet.iter().filter(|entry| entry.source.is_none()).count();
        let Some(left) = streams.get(wanted) else { return Ok(()) };
        let why = if self.model().inlet.is_empty() {
            "the scene has no [[inlet]]".to_owned()
        } else {
            format!("{} inlets are given, and {wanted} [[inlet]] without source wait for one", streams.len())
        };
        Err(SceneError::file(&left.name, why, "add [[inlet]] plane = \"…\" to the scene, or leave it out"))
    }

    fn open_inlet(&self, source: &str) -> Result<InletStream, SceneError> {
        let path = self.path(source);
        let name = path.display().to_string();
        let file =
            std::fs::File::open(&path).map_err(|source| SceneError::Read { name: name.clone(), source })?;
        match Input::open(&name, Box::new(file))? {
            Input::Inlet(stream) => Ok(*stream),
            Input::Walls(_) => {
                Err(SceneError::file(&name, "holds walls, no crossings", "name it in [[wall]]"))
            }
        }
    }

    fn feed(&mut self, mut stream: InletStream, zone: Zone) -> Result<(), SceneError> {
        let name = stream.name.clone();
        stream.inlet = self.inlets.len() as u32;
        stream.to_scene.clear();
        // All that a stream names must fit, because which it brings is known only when it has brought them.
        for info in stream.materials.clone() {
            let material = self.material_of(&name, &info)?;
            self.as_heavy(&name, &info, material)?;
            if self.materials[material as usize].density > 0.0 && !stream.only_clumps {
                self.entry_materials.push(material);
            }
            stream.to_scene.push(material);
        }
        let clumps = stream.clumps.clone();
        stream.to_shapes = self.clumps_of(&name, &clumps)?;
        if stream.bonds.is_some() && self.model().bond.is_empty() {
            let why = "brings bonds, and the scene has no [[bond]]";
            return Err(SceneError::file(&name, why, "add the [[bond]]s of the stage upstream to this one"));
        }
        self.entry_bonds = EntryBonds::union(self.entry_bonds, stream.bonds);
        self.entry_sizes = Sizes::union(self.entry_sizes, Some(stream.sizes));
        if !stream.only_clumps {
            self.sphere_sizes = Sizes::union(self.sphere_sizes, Some(stream.sizes));
        }
        self.inlets.push(zone);
        self.feeds.streams.push(stream);
        Ok(())
    }

    /// Refuses a stream whose grains would change their mass on the way in.
    fn as_heavy(&self, stream: &str, info: &MaterialInfo, material: u16) -> Result<(), SceneError> {
        let here = self.materials[material as usize].density;
        match info.density {
            Some(there) if here > 0.0 && there > 0.0 && (here - there).abs() > 1e-9 * there => {
                let at = self.model().material.iter().position(|m| m.name == info.name);
                let key = at.map_or("material".to_owned(), |k| format!("material.{k}.density"));
                let why = format!("the grains of '{}' in {stream} have {} kg/m³", info.name, Shown(there));
                let cure =
                    "use the density of the stage upstream, or another name for what is denser or lighter";
                Err(self.check.wrong(&key, format!("{} kg/m³", Shown(here)), &why, cure))
            }
            _ => Ok(()),
        }
    }

    pub(crate) fn faucets(&mut self) -> Result<(), SceneError> {
        let mut first = self.next_id();
        for (i, entry) in self.model().insert.iter().enumerate() {
            let shape = self.shape(&format!("insert.{i}.shape"), &entry.shape)?;
            let ids = (first, self.inlets.len() as u32);
            let grains = self.poured(i, entry)?;
            let (faucet, zone) = Faucet::new(&self.check, i, entry, shape, grains, ids)?;
            self.pours_in_front(&faucet, &format!("insert.{i}.shape"), &entry.shape)?;
            // Room for the ids of each faucet: they would have to give this many to meet.
            first = first.saturating_add(200_000_000);
            self.inlets.push(zone);
            self.feeds.faucets.push(faucet);
        }
        Ok(())
    }

    /// What a faucet pours; the engine is told of it.
    fn poured(&mut self, i: usize, entry: &Insert) -> Result<Poured, SceneError> {
        let Some(name) = &entry.clump else {
            let (material, density) = self.grain(&format!("insert.{i}.material"), &entry.material)?;
            let sizes = Sizes { smallest: entry.diameter.low / 2.0, largest: entry.diameter.high / 2.0 };
            self.entry_sizes = Sizes::union(self.entry_sizes, Some(sizes));
            self.sphere_sizes = Sizes::union(self.sphere_sizes, Some(sizes));
            self.entry_materials.push(material);
            return Ok(Poured::spheres(entry.diameter, (material, density)));
        };
        let shape = self.clump(&format!("insert.{i}.clump"), name)?;
        let clump = &self.clumps.shapes[shape as usize];
        let scale = entry.scale.unwrap_or(Diameter { low: 1.0, high: 1.0 });
        let (least, most) = clump.radii();
        let sizes = Sizes { smallest: least * scale.low, largest: most * scale.high };
        let grains = Poured::clumps(shape, clump, scale, self.materials[clump.material as usize].density);
        self.entry_sizes = Sizes::union(self.entry_sizes, Some(sizes));
        self.clumps.entries.push((shape, scale.low, scale.high));
        Ok(grains)
    }

    /// Refuses a faucet whose particles would become free behind a plane at rest.
    fn pours_in_front(&self, faucet: &Faucet, key: &str, shape: &str) -> Result<(), SceneError> {
        for wall in self.walls.iter().filter(|w| !w.motion.moves()) {
            let WallShape::Plane(plane) = &wall.shape else { continue };
            let lowest = faucet.lowest_over(plane);
            if lowest <= 0.0 {
                let why = format!(
                    "particles would become free {} m behind wall '{}' (plane {})",
                    Shown(-lowest),
                    wall.name,
                    crate::inlet::plane_text(plane)
                );
                let cure =
                    "move the faucet to the side that the plane's normal points to, or turn the normal round";
                return Err(self.check.wrong(key, format!("\"{shape}\""), &why, cure));
            }
        }
        Ok(())
    }

    pub(crate) fn outlets(&mut self) -> Result<(), SceneError> {
        let largest = 2.0 * self.sizes().map_or(0.0, |s| s.largest).max(self.widest_clump());
        for (i, entry) in self.model().outlet.iter().enumerate() {
            let plane = walls::plane(&self.check, &format!("outlet.{i}.plane"), &entry.plane)?;
            let length = match entry.length {
                OrAuto::Auto => 1.2 * largest,
                OrAuto::Given(length) => length,
            };
            if length <= largest {
                let why = format!("is not above the largest diameter, {} m", Shown(largest));
                let cure = format!("use \"auto\", or at least {} m", Shown(1.2 * largest));
                return Err(self.check.wrong(
                    &format!("outlet.{i}.length"),
                    format!("{length} m"),
                    &why,
                    &cure,
                ));
            }
            self.outlets.push(Zone { plane, length, motion: entry.motion, test: entry.test });
        }
        Ok(())
    }
}
