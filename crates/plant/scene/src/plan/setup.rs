//! The engine's setup of a plan whose particles, walls and zones are known.

use super::laws::{accuracy, bonds, contacts};
use super::warnings::impact;
use super::{NO_DENSITY, Plan};
use crate::error::Result;
use crate::keys::{Arithmetic, DragLaw, Patches, Sampling};
use crate::plan::builder::PlanBuilder;
use dem::setup::{self, Guards, Setup, Step, WallDetail};
use geom::Vec3;

impl PlanBuilder<'_> {
    pub(super) fn finish(mut self) -> Result<Plan> {
        let keys = self.keys();
        let sizes = self.sizes();
        let below = if self.outlets.is_empty() { self.below().ok() } else { None };
        let largest = sizes.map_or(0.0, |s| s.largest);
        let contacts = contacts::resolve(&self.check, &keys.contact, &self.materials, largest)?;
        let contacts = self.contacts_that_can_meet(contacts);
        self.warn(&contacts);
        let bonds = bonds::resolve(&self.check, &keys.bond, &self.materials)?;
        let (safety, step) = accuracy::choose(&self.check, &keys.time, &contacts)?;
        let left = 1.0 - keys.time.shorten.unwrap_or(0.0);
        // The engine wants a density of every material, also of walls, whose mass plays no part.
        self.materials.iter_mut().filter(|m| m.density == 0.0).for_each(|m| m.density = NO_DENSITY);
        self.entry_materials.sort_unstable();
        self.entry_materials.dedup();
        let kept = self.kept();
        self.note_domain()?;
        let (periodic, strain) = (self.periodic()?, self.strain()?);
        self.clusters.sort_unstable();
        let setup = Setup {
            kept,
            gravity: Vec3::from(keys.gravity),
            drag: self.drag(),
            local_damping: keys.local_damping.map(|d| d.factor),
            periodic,
            strain,
            step: keys.time.dt.0.map_or(Step::Auto(left * safety), |dt| Step::Fixed(left * dt)),
            precision: match keys.precision {
                Arithmetic::F64 => setup::Precision::Double,
                Arithmetic::Mixed => setup::Precision::Mixed,
                Arithmetic::F32 => setup::Precision::Single,
            },
            sampling: match keys.time.contacts {
                Sampling::Averaged => setup::Sampling::Averaged,
                Sampling::Sampled => setup::Sampling::Sampled,
            },
            patches: keys.time.patch == Patches::Shared,
            skin: keys.neighbours.skin,
            sleep: keys.sleep.map(|s| setup::Sleep { speed: s.speed, time: s.time, wake: s.wake }),
            ledger: keys.keeps_ledger(),
            record_wrenches: true,
            record_sliding: keys.output.contacts,
            wall_sums: match keys.output.wall_forces {
                _ if keys.output.wear => WallDetail::Parts,
                Some(true) => WallDetail::Whole,
                _ if self.walls.iter().any(|w| w.servo.is_some()) => WallDetail::Whole,
                _ => WallDetail::Off,
            },
            guards: self.guards(),
            largest_entry: self.sphere_sizes.map_or(0.0, |s| s.largest),
            smallest_entry: self.sphere_sizes.map_or(0.0, |s| s.smallest),
            materials: self.materials,
            contacts,
            particles: self.particles,
            clumps: self.clumps,
            bonds,
            clusters: self.clusters,
            entry_bonds: self.entry_bonds,
            walls: self.walls,
            outlets: self.outlets,
            removals: self.removals,
            inlets: self.inlets,
            entry_materials: self.entry_materials,
        };
        let PlanBuilder { insertions, streams: inlets, mut warnings, inputs, places, .. } = self;
        warnings.extend(impact::warning(&setup, &insertions));
        Ok(Plan { setup, step, insertions, inlets, warnings, inputs, sizes, places, below })
    }

    /// Largest overlap before a guard stops the run, as a share of the smaller radius [–].
    pub(super) fn overlap_limit(&self) -> f64 {
        self.keys().guards.overlap.unwrap_or(Guards::default().overlap)
    }

    fn guards(&self) -> Guards {
        let (guards, default) = (&self.keys().guards, Guards::default());
        Guards {
            overlap: self.overlap_limit(),
            motion: guards.motion.unwrap_or(default.motion),
            // [[inlet]]s come before insertions, whose grains may get anywhere.
            cuts: self.keys().inlet.len() as u32,
            zones: guards.zones.unwrap_or_default(),
            energy: self.keys().energy_limit().unwrap_or(default.energy),
        }
    }

    fn drag(&self) -> Option<setup::Drag> {
        let entry = self.keys().drag.as_ref()?;
        Some(setup::Drag {
            law: match entry.law {
                DragLaw::Stokes => setup::DragLaw::Stokes,
                DragLaw::SchillerNaumann => setup::DragLaw::SchillerNaumann,
            },
            viscosity: entry.viscosity,
            density: entry.density.unwrap_or(0.0),
            velocity: Vec3::from(entry.velocity),
            buoyancy: entry.buoyancy,
        })
    }
}
