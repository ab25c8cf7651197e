//! What a run computes, and what each part takes.

use super::Simulation;
use crate::model::Model;
use crate::model::matched::coefficients;
use crate::setup::{ContactLaw, Sampling};
use crate::state::RigidClumps;
use laws::contact::LEDGER;
use laws::effects::{Description, active, damping_ratio};
use laws::simd::{Row, Row4};
use serde::Serialize;

/// An effect that a scene switches on.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EffectCost {
    /// Name of the effect, as in the scene.
    pub effect: &'static str,
    /// The pair of materials that calls for it.
    pub between: (String, String),
    /// The key that calls for it, with its value.
    pub because: String,
    /// Contact history [bytes].
    pub bytes_per_contact: usize,
}

/// Damping of a contact law that is matched to the step: γ + γ₁ (ω Δt)² + γ₂ (ω Δt)⁴, with ω² = S/m* of each contact.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MatchedDamping {
    /// The pair of materials.
    pub between: (String, String),
    /// Restitution that it is matched to [–].
    pub restitution: f64,
    /// γ, γ₁ and γ₂ [–].
    pub ratios: [f64; 3],
}

/// What a listed contact takes without the history of its effects [bytes].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct ContactBytes {
    /// Its slot in the lists.
    pub listed: usize,
    /// The contact point on a wall, or across a periodic face; none between two particles.
    pub point: usize,
    /// Its wrench, where that is kept: between two tiles, or for observers.
    #[serde(rename = "load")]
    pub wrench: usize,
    /// Its energies; 0 without the ledger.
    pub ledger: usize,
}

impl Simulation {
    /// Effects in force, by pair of materials that can meet.
    pub fn explain(&self) -> Vec<EffectCost> {
        self.contacts_that_meet().into_iter().flat_map(|c| effects_of(&self.model, c)).collect()
    }

    /// Contact laws of the pairs of materials that can meet.
    fn contacts_that_meet(&self) -> Vec<&ContactLaw> {
        let mut pairs: Vec<(u16, u16)> = self.model.kinds.iter().map(|k| k.between).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let contacts = &self.model.setup.contacts;
        let meets =
            |c: &&ContactLaw| pairs.contains(&c.between) || pairs.contains(&(c.between.1, c.between.0));
        contacts.iter().filter(meets).collect()
    }

    /// Damping that is matched to the step, by pair of materials that can meet; none where contacts are sampled.
    pub fn matched_damping(&self) -> Vec<MatchedDamping> {
        if self.model.setup.sampling == Sampling::Sampled {
            return Vec::new();
        }
        self.contacts_that_meet().into_iter().filter_map(|c| matched_damping(&self.model, c)).collect()
    }

    /// State of one particle [bytes], without its share of contacts.
    pub fn bytes_per_particle(&self) -> usize {
        let rotation = if self.state.particles.rotates() { 2 * size_of::<Row4>() } else { 0 };
        let sums = self.bytes_of_wrench();
        let own = size_of::<Row>() + 2 * size_of::<Row4>() + sums;
        let sleeps = self.state.sleepers.is_some();
        let sleep = if sleeps { size_of::<Row>() + size_of::<u32>() + 2 + sums } else { 0 };
        own + rotation + sleep + size_of::<u32>() + size_of::<u16>() + size_of::<u32>()
    }

    /// What a listed contact takes without the history of its effects.
    pub fn bytes_of_contact(&self) -> ContactBytes {
        let rotates = self.state.particles.rotates();
        ContactBytes {
            listed: 2 * size_of::<u32>(),
            point: size_of::<Row>() + if rotates { size_of::<Row4>() } else { 0 },
            wrench: self.bytes_of_wrench(),
            ledger: if self.model.setup.ledger { (LEDGER + 1) * size_of::<f64>() } else { 0 },
        }
    }

    fn bytes_of_wrench(&self) -> usize {
        let layout = self.model.layout();
        let torques = if self.state.torques(&self.model) { layout.torque() } else { 0 };
        (layout.force() + torques) * size_of::<f64>()
    }

    /// Memory of a rigid clump, and of each of its members beyond that of a particle [bytes].
    pub fn bytes_of_clump() -> (usize, usize) {
        RigidClumps::bytes()
    }

    /// Memory that rigid clumps take beyond that of their members' rows [bytes].
    pub fn bytes_of_clumps(&self) -> usize {
        self.state.clumps.all_bytes()
    }

    /// Memory that bonds take, with what they keep of their particles [bytes].
    pub fn bytes_of_bonds(&self) -> usize {
        self.state.bonds.bytes()
    }

    /// Whether particles turn in this scene.
    pub fn rotates(&self) -> bool {
        self.model.rotates
    }
}

fn matched_damping(model: &Model, law: &ContactLaw) -> Option<MatchedDamping> {
    let ([first, second], restitution) = (coefficients(law), law.number("restitution")?);
    let name = |m: u16| model.setup.materials[m as usize].name.clone();
    let between = (name(law.between.0), name(law.between.1));
    let ratios = [damping_ratio(restitution), first, second];
    (first != 0.0 || second != 0.0).then_some(MatchedDamping { between, restitution, ratios })
}

fn effects_of(model: &Model, law: &ContactLaw) -> Vec<EffectCost> {
    let name = |m: u16| model.setup.materials[m as usize].name.clone();
    let between = (name(law.between.0), name(law.between.1));
    let number = if model.layout().single { size_of::<f32>() } else { size_of::<f64>() };
    let cost = |effect: &Description| EffectCost {
        effect: effect.name,
        between: between.clone(),
        because: effect.because(law),
        bytes_per_contact: number * effect.columns(),
    };
    active(law).map(cost).collect()
}
