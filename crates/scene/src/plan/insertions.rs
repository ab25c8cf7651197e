//! `[[insert]]`: zones with a prescribed velocity, and what they insert.

use super::builder::{GrainMaterial, PlanBuilder};
use super::insertion::{Inserted, InsertedClump, Insertion};
use crate::error::Result;
use crate::keys::{Diameter, Insert};
use dem::setup::{ClumpScales, WallShape};
use geom::{Shown, sphere::volume};
use record::Sizes;

/// Ids that are kept for each insertion; it would have to insert this many to meet those of the next.
const IDS: u32 = 200_000_000;

impl PlanBuilder<'_> {
    pub(super) fn insertions(&mut self) -> Result<()> {
        let mut first_id = self.next_id();
        for (i, entry) in self.keys().insert.iter().enumerate() {
            let shape = self.shape(&format!("insert.{i}.shape"), &entry.shape)?;
            let inserted = self.inserted(i, entry)?;
            let insertion = self.insertion(i, entry, shape, inserted, first_id)?;
            self.in_front_of_walls(&insertion, &format!("insert.{i}.shape"), &entry.shape)?;
            first_id = first_id.saturating_add(IDS);
            self.inlets.push(insertion.section.zone());
            self.insertions.push(insertion);
        }
        Ok(())
    }

    /// What an entry inserts; its sizes and materials are noted for the setup.
    fn inserted(&mut self, i: usize, entry: &Insert) -> Result<Inserted> {
        let Some(name) = &entry.clump else {
            let material = self.grain(&format!("insert.{i}.material"), &entry.material)?;
            let Diameter { low, high } = entry.diameter;
            self.will_enter(Sizes { smallest: low / 2.0, largest: high / 2.0 }, true);
            self.entry_materials.push(material.index);
            let GrainMaterial { index: material, density } = material;
            return Ok(Inserted { diameter: entry.diameter, material, density, clump: None, ids: 1 });
        };
        let index = self.clump(&format!("insert.{i}.clump"), name)?;
        let shape = &self.clumps.shapes[index as usize];
        let scale = entry.scale.unwrap_or(Diameter { low: 1.0, high: 1.0 });
        let (least, most) = shape.radii();
        let (reach, density) = (shape.reach(), self.materials[shape.material as usize].density);
        let size = 2.0 * reach;
        let inserted = Inserted {
            diameter: Diameter { low: scale.low * size, high: scale.high * size },
            material: shape.material,
            density: shape.mass(1.0, density) / volume(reach),
            clump: Some(InsertedClump { shape: index, size }),
            ids: shape.spheres.len() as u32,
        };
        self.will_enter(Sizes { smallest: least * scale.low, largest: most * scale.high }, false);
        self.clumps.entries.push(ClumpScales { shape: index, least: scale.low, most: scale.high });
        Ok(inserted)
    }

    /// Refuses an insertion whose particles would become free behind a plane at rest.
    fn in_front_of_walls(&self, insertion: &Insertion, key: &str, shape: &str) -> Result<()> {
        for wall in self.walls.iter().filter(|w| !w.moves()) {
            let WallShape::Plane(plane) = &wall.shape else { continue };
            let lowest = insertion.lowest_over(plane);
            if lowest <= 0.0 {
                let (behind, name) = (Shown(-lowest), &wall.name);
                let why =
                    format!("particles would become free {behind} m behind wall '{name}' (plane {plane})");
                let cure = "move the insertion to the side that the plane's normal points to, or turn the normal round";
                return Err(self.check.wrong(key, format!("\"{shape}\""), &why, cure));
            }
        }
        Ok(())
    }
}
