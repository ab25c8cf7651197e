//! Contacts of grains with walls: what a wall file says of friction and restitution, where the scene has no entry.

use crate::plan::builder::PlanBuilder;
use dem::setup::ContactLaw;
use std::collections::BTreeSet;

/// μ at rest.
fn friction_of(law: &ContactLaw) -> Option<f64> {
    law.number("sliding_friction").or(law.number("sliding_friction.static"))
}

impl PlanBuilder<'_> {
    /// The contacts of pairs that can meet; friction and restitution of wall files are used where the scene has no entry.
    pub(in crate::plan) fn contacts_that_can_meet(
        &mut self,
        mut contacts: Vec<ContactLaw>,
    ) -> Vec<ContactLaw> {
        let grains = self.grain_materials();
        let of = |contacts: &[ContactLaw], a: u16, b: u16| {
            contacts.iter().position(|c| c.between == (a, b) || c.between == (b, a))
        };
        for wall in &self.wall_materials {
            for &grain in &grains {
                let (found, friction) = (of(&contacts, grain, wall.index), wall.record.friction);
                if let (None, Some(restitution)) = (found, wall.record.restitution) {
                    let between = (grain.min(wall.index), grain.max(wall.index));
                    let mut law = ContactLaw::new(between, "hertz").with("restitution", restitution);
                    if let Some(mu) = friction.filter(|mu| *mu > 0.0) {
                        law.set("sliding_friction", mu);
                    }
                    contacts.push(law);
                }
                let Some(law) = found.map(|at| &contacts[at]) else { continue };
                let (a, b) = (&self.materials[grain as usize].name, &wall.record.name);
                let numbers = [
                    ("sliding_friction", friction_of(law), friction),
                    ("restitution", law.number("restitution"), wall.record.restitution),
                ];
                for (key, scene, file) in numbers {
                    let (Some(file), scene) = (file, scene.unwrap_or(0.0)) else { continue };
                    if file != scene {
                        self.warnings.push(format!(
                            "{a}–{b}: {key} {scene} of the scene, not {file} of the wall file"
                        ));
                    }
                }
            }
        }
        let walls: Vec<u16> = self.walls.iter().map(|w| w.material).collect();
        let grain = |m: u16| grains.contains(&m);
        contacts.retain(|c| {
            let (a, b) = c.between;
            (grain(a) && (grain(b) || walls.contains(&b))) || (grain(b) && walls.contains(&a))
        });
        contacts
    }

    /// Materials of all particles.
    fn grain_materials(&self) -> BTreeSet<u16> {
        let mut grains: BTreeSet<u16> = self.particles.iter().map(|p| p.material).collect();
        grains.extend(&self.entry_materials);
        let shapes =
            self.clumps.placed.iter().map(|b| b.shape).chain(self.clumps.entries.iter().map(|e| e.shape));
        grains.extend(shapes.map(|s| self.clumps.shapes[s as usize].material));
        grains
    }
}
