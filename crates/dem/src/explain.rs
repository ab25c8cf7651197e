//! What a run computes, and what each part takes.

use crate::effects::{
    Cohesion, ConstantRolling, Effect, Hertz, Hooke, Jkr, RollingResistance, SlidingFriction,
    TwistingResistance, Weakening,
};
use crate::kernel::LEDGER;
use crate::lane::{Row, Row4};
use crate::setup::{Contact, Law, RollingModel};
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

/// An effect of one contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Name, as in the scene.
    pub effect: &'static str,
    /// The key that calls for it, with its value.
    pub because: String,
    /// Contact memory [bytes].
    pub bytes: usize,
    /// The contact without it; `None` for the normal law.
    pub without: Option<Contact>,
}

/// What a listed contact takes without what its effects remember [bytes].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct ContactBytes {
    /// Its place in the lists.
    pub listed: usize,
    /// The contact point on a wall, or across a periodic face; none between two particles.
    pub point: usize,
    /// Its load, where that is kept: between two tiles, or for who looks at each.
    pub load: usize,
    /// Its energies; 0 without the ledger.
    pub ledger: usize,
}

/// The effects of a contact, in the order in which they act.
pub fn parts(c: &Contact) -> Vec<Part> {
    let part = |effect, because: String, numbers: usize| Part {
        effect,
        because,
        bytes: numbers * size_of::<f64>(),
        without: None,
    };
    let normal = match c.law {
        Law::Hooke { stiffness, .. } => {
            part("hooke", format!("law = \"hooke\", {stiffness:e} N/m"), Hooke::MEMORY)
        }
        Law::Hertz => part("hertz", "law = \"hertz\"".to_owned(), Hertz::MEMORY),
        Law::Jkr { work_of_adhesion: w } => part("jkr", format!("law = \"jkr\", {w:e} J/m²"), Jkr::MEMORY),
    };
    let cohesion = c.cohesion.map(|density| {
        let without = Some(Contact { cohesion: None, ..c.clone() });
        Part {
            without,
            ..part("cohesion", format!("cohesion = \"sjkr\", {density:e} J/m³"), Cohesion::MEMORY)
        }
    });
    let twisting = c.twisting_resistance.map(|mu| {
        let without = Some(Contact { twisting_resistance: None, ..c.clone() });
        let because = format!("twisting_resistance = {mu}");
        Part { without, ..part("twisting_resistance", because, TwistingResistance::MEMORY) }
    });
    let rest = [cohesion, sliding(c), rolling(c), twisting];
    std::iter::once(normal).chain(rest.into_iter().flatten()).collect()
}

fn sliding(c: &Contact) -> Option<Part> {
    let mu = c.sliding_friction?;
    let (because, numbers) = match c.weakening {
        None => (format!("sliding_friction = {mu}"), SlidingFriction::<f64>::MEMORY),
        Some(w) => (
            format!("sliding_friction = {{ static = {mu}, dynamic = {}, speed = {} }}", w.dynamic, w.speed),
            SlidingFriction::<Weakening>::MEMORY,
        ),
    };
    // Nothing turns without it.
    let without = Contact {
        sliding_friction: None,
        weakening: None,
        rolling_resistance: None,
        twisting_resistance: None,
        ..c.clone()
    };
    let bytes = numbers * size_of::<f64>();
    Some(Part { effect: "sliding_friction", because, bytes, without: Some(without) })
}

fn rolling(c: &Contact) -> Option<Part> {
    let mu = c.rolling_resistance?;
    let (model, numbers) = match c.rolling_model {
        RollingModel::Spring => ("spring", RollingResistance::MEMORY),
        RollingModel::Constant => ("constant", ConstantRolling::MEMORY),
    };
    let because = format!("rolling_resistance = {mu}, rolling_model = \"{model}\"");
    let without = Some(Contact { rolling_resistance: None, ..c.clone() });
    Some(Part { effect: "rolling_resistance", because, bytes: numbers * size_of::<f64>(), without })
}

/// The contact without effects that cannot matter (a coefficient of 0), and their keys.
pub fn needed(c: &Contact) -> (Contact, Vec<&'static str>) {
    let mut less = c.clone();
    let mut dropped = Vec::new();
    let mut drop_zero = |value: &mut Option<f64>, key| {
        if *value == Some(0.0) {
            *value = None;
            dropped.push(key);
        }
    };
    drop_zero(&mut less.cohesion, "cohesion");
    drop_zero(&mut less.rolling_resistance, "rolling_resistance");
    drop_zero(&mut less.twisting_resistance, "twisting_resistance");
    if less.sliding_friction == Some(0.0) && less.weakening.is_some_and(|w| w.dynamic == 0.0) {
        less.weakening = None;
    }
    // Rolling and twisting resistance turn particles, which is computed with friction, though it be 0.
    let turns = less.rolling_resistance.is_some() || less.twisting_resistance.is_some();
    if less.weakening.is_none() && !turns {
        drop_zero(&mut less.sliding_friction, "sliding_friction");
    }
    (less, dropped)
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
        let cost = |part: Part| EffectCost {
            effect: part.effect,
            between: between.clone(),
            because: part.because,
            bytes_per_contact: if self.form().single { part.bytes / 2 } else { part.bytes },
        };
        parts(c).into_iter().map(cost).collect()
    }

    /// State of one particle [bytes], without its share of contacts.
    pub fn bytes_per_particle(&self) -> usize {
        let rotates = self.particles.rotates();
        let rotation = if rotates { 2 * size_of::<Row4>() } else { 0 };
        let form = self.form();
        let couples = if self.couples() { form.couple() } else { 0 };
        let sums = (form.load() + couples) * size_of::<f64>();
        let state = size_of::<Row>() + 2 * size_of::<Row4>() + sums;
        let sleep = if self.sleepers.is_some() { size_of::<Row>() + size_of::<u32>() + 2 + sums } else { 0 };
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

    /// Memory that bonds take, with what they keep of their particles [bytes].
    pub fn bytes_of_bonds(&self) -> usize {
        self.bonds.bytes()
    }

    /// What a listed contact takes without what its effects remember.
    pub fn bytes_of_contact(&self) -> ContactBytes {
        let form = self.form();
        let words = form.load() + if self.couples() { form.couple() } else { 0 };
        ContactBytes {
            listed: 2 * size_of::<u32>(),
            point: size_of::<Row>() + if self.particles.rotates() { size_of::<Row4>() } else { 0 },
            load: words * size_of::<f64>(),
            ledger: if self.setup.ledger { (LEDGER + 1) * size_of::<f64>() } else { 0 },
        }
    }

    /// Whether particles turn in this scene.
    pub fn rotates(&self) -> bool {
        self.particles.rotates()
    }
}
