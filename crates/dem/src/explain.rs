//! What a run computes, and what each part takes.

use crate::effects::{Effect, Hertz, Hooke, RollingResistance, SlidingFriction};
use crate::lane::{Row, Row4};
use crate::setup::{Contact, Law};
use crate::simulation::Simulation;
use serde::Serialize;
use std::mem::size_of;

/// An effect that a scene switches on.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EffectCost {
    /// Name of the effect, as in the scene.
    pub effect: &'static str,
    /// The pair of materials that calls for it.
    pub between: (String, String),
    /// The key that calls for it, with its value.
    pub because: String,
    /// Contact memory [bytes].
    pub bytes_per_contact: usize,
}

impl Simulation {
    /// Effects in force, by pair of materials that can meet.
    pub fn explain(&self) -> Vec<EffectCost> {
        let mut pairs: Vec<(u16, u16)> = self.kinds.iter().map(|k| k.between).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let contacts = &self.setup.contacts;
        let meets = |c: &&Contact| pairs.contains(&c.between) || pairs.contains(&(c.between.1, c.between.0));
        contacts.iter().filter(meets).flat_map(|c| self.effects_of(c)).collect()
    }

    fn effects_of(&self, c: &Contact) -> Vec<EffectCost> {
        let name = |m: u16| self.setup.materials[m as usize].name.clone();
        let between = (name(c.between.0), name(c.between.1));
        let cost = |effect, because: String, numbers: usize| EffectCost {
            effect,
            between: between.clone(),
            because,
            bytes_per_contact: numbers * size_of::<f64>(),
        };
        let mut list = vec![match c.law {
            Law::Hooke { stiffness, .. } => {
                cost("hooke", format!("law = \"hooke\", {stiffness:e} N/m"), Hooke::MEMORY)
            }
            Law::Hertz => cost("hertz", "law = \"hertz\"".to_owned(), Hertz::MEMORY),
        }];
        list.extend(
            c.sliding_friction.map(|mu| {
                cost("sliding_friction", format!("sliding_friction = {mu}"), SlidingFriction::MEMORY)
            }),
        );
        list.extend(c.rolling_resistance.map(|mu| {
            cost("rolling_resistance", format!("rolling_resistance = {mu}"), RollingResistance::MEMORY)
        }));
        list
    }

    /// State of one particle [bytes], without its share of contacts.
    pub fn bytes_per_particle(&self) -> usize {
        let rotation = if self.particles.rotates() { 3 * size_of::<Row4>() } else { 0 };
        let state = 2 * size_of::<Row>() + 2 * size_of::<Row4>();
        let sleep = if self.sleepers.is_some() { size_of::<Row>() + size_of::<u32>() + 2 } else { 0 };
        state + rotation + sleep + size_of::<u32>() + size_of::<u16>() + size_of::<u32>()
    }

    /// Memory of a rigid clump, and of each of its members beyond that of a particle [bytes].
    pub fn bytes_of_clump() -> (usize, usize) {
        crate::bodies::Bodies::bytes()
    }

    /// Memory that rigid clumps take beyond that of their members' rows [bytes].
    pub fn bytes_of_clumps(&self) -> usize {
        self.bodies.all_bytes()
    }

    /// Everything that one listed contact takes in a kind of interaction, averaged over all listed now [bytes].
    pub fn bytes_per_listed_contact(&self) -> f64 {
        self.contacts.bytes() as f64 / self.listed_contacts().max(1) as f64
    }

    /// Whether particles turn in this scene.
    pub fn rotates(&self) -> bool {
        self.particles.rotates()
    }
}
