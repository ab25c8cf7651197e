//! What a run computes, and what each part takes.

use crate::effects::{Description, active};
use crate::kernel::LEDGER;
use crate::model::Model;
use crate::setup::ContactLaw;
use crate::simd::{Row, Row4};
use crate::state::State;
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

/// What a listed contact takes without what its effects remember [bytes].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct ContactBytes {
    /// Its place in the lists.
    pub listed: usize,
    /// The contact point on a wall, or across a periodic face; none between two particles.
    pub point: usize,
    /// Its wrench, where that is kept: between two tiles, or for observers.
    pub load: usize,
    /// Its energies; 0 without the ledger.
    pub ledger: usize,
}

/// Effects in force, by pair of materials that can meet.
pub fn effects(model: &Model) -> Vec<EffectCost> {
    let mut pairs: Vec<(u16, u16)> = model.kinds.iter().map(|k| k.between).collect();
    pairs.sort_unstable();
    pairs.dedup();
    let contacts = &model.setup.contacts;
    let meets = |c: &&ContactLaw| pairs.contains(&c.between) || pairs.contains(&(c.between.1, c.between.0));
    contacts.iter().filter(meets).flat_map(|c| effects_of(model, c)).collect()
}

fn effects_of(model: &Model, law: &ContactLaw) -> Vec<EffectCost> {
    let name = |m: u16| model.setup.materials[m as usize].name.clone();
    let between = (name(law.between.0), name(law.between.1));
    let number = if model.form().single { size_of::<f32>() } else { size_of::<f64>() };
    let cost = |effect: &Description| EffectCost {
        effect: effect.name,
        between: between.clone(),
        because: effect.because(law),
        bytes_per_contact: number * effect.columns(),
    };
    active(law).map(cost).collect()
}

/// State of one particle [bytes], without its share of contacts.
pub fn bytes_per_particle(model: &Model, state: &State) -> usize {
    let rotates = state.particles.rotates();
    let rotation = if rotates { 2 * size_of::<Row4>() } else { 0 };
    let form = model.form();
    let torques = if state.torques(model) { form.torque() } else { 0 };
    let sums = (form.load() + torques) * size_of::<f64>();
    let own = size_of::<Row>() + 2 * size_of::<Row4>() + sums;
    let sleep = if state.sleepers.is_some() { size_of::<Row>() + size_of::<u32>() + 2 + sums } else { 0 };
    own + rotation + sleep + size_of::<u32>() + size_of::<u16>() + size_of::<u32>()
}

/// What a listed contact takes without what its effects remember.
pub fn bytes_of_contact(model: &Model, state: &State) -> ContactBytes {
    let form = model.form();
    let words = form.load() + if state.torques(model) { form.torque() } else { 0 };
    ContactBytes {
        listed: 2 * size_of::<u32>(),
        point: size_of::<Row>() + if state.particles.rotates() { size_of::<Row4>() } else { 0 },
        load: words * size_of::<f64>(),
        ledger: if model.setup.ledger { (LEDGER + 1) * size_of::<f64>() } else { 0 },
    }
}
