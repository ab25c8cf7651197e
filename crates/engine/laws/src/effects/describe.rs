//! What an effect says of itself: everything that checks, reports, time step, stages, scene keys and docs need to know of it.
//!
//! A description is a constant in the effect's own file; `registry.rs` lists them. What else names single effects: the precisions that are
//! compiled (`dem/src/model/compose.rs`), the deck of LAMMPS (`plant/lammps`), and what was measured of laws (`plant/scene/src/plan/laws`).

use super::law::ContactLaw;
use super::material::{Elastic, OverlapLimit};
use alloc::string::String;

/// What an effect does in a contact. A contact has at most one effect of each slot, and slots act in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Slot {
    /// Force along the normal.
    Normal,
    /// A pull added to it.
    Cohesion,
    /// Force across the normal; it turns particles.
    Sliding,
    /// Torque against rolling.
    Rolling,
    /// Torque about the normal.
    Twisting,
}

impl Slot {
    /// The key that asks for an effect of it.
    pub const fn key(self) -> &'static str {
        match self {
            Slot::Normal => "law",
            Slot::Cohesion => "cohesion",
            Slot::Sliding => "sliding_friction",
            Slot::Rolling => "rolling_resistance",
            Slot::Twisting => "twisting_resistance",
        }
    }
}

/// Entries of the energy ledger for what effects dissipate.
pub const DISSIPATORS: usize = 4;

impl Slot {
    /// Entry of the energy ledger that its effects dissipate into.
    #[inline(always)]
    pub const fn ledger(self) -> usize {
        match self {
            Slot::Normal | Slot::Cohesion => 0,
            Slot::Sliding => 1,
            Slot::Rolling => 2,
            Slot::Twisting => 3,
        }
    }
}

/// The largest number that any key takes: beyond, results overflow.
pub(super) const MOST: f64 = 1e18;

/// Numbers that a key takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Range {
    /// Above 0, up to the largest number of any key.
    Positive,
    /// From 0 up to a limit.
    UpTo(f64),
    /// Above 0, up to a limit.
    AboveZeroUpTo(f64),
}

impl Range {
    /// Whether a number is in it; NaN is not.
    pub fn holds(self, x: f64) -> bool {
        match self {
            Range::Positive => x > 0.0 && x <= MOST,
            Range::UpTo(most) => (0.0..=most).contains(&x),
            Range::AboveZeroUpTo(most) => x > 0.0 && x <= most,
        }
    }
}

/// A number that a contact law takes, under its key in scenes. A key with a dot stands in a table: `sliding_friction.speed`
/// is `speed` in `sliding_friction = { … }`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Key {
    /// Name in scenes.
    pub name: &'static str,
    /// Unit; "" for none.
    pub unit: &'static str,
    /// What it takes.
    pub range: Range,
    /// Whether the effect cannot do without it.
    pub required: bool,
    /// A value to show.
    pub example: &'static str,
    /// What it means.
    pub doc: &'static str,
}

/// A key of contact laws that names a model, and the value that asks for this effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Model {
    /// Name in scenes.
    pub key: &'static str,
    /// Its value.
    pub value: &'static str,
    /// Whether it is meant where the key is absent.
    pub default: bool,
}

/// Shape of a number that a contact keeps, and how it changes when both particles are exchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A number that both see alike.
    Scalar,
    /// A vector that the other sees reversed; it turns with the frame.
    Vector,
}

impl Kind {
    /// How many numbers it is.
    pub const fn columns(self) -> usize {
        match self {
            Kind::Scalar => 1,
            Kind::Vector => 3,
        }
    }
}

/// Something that a contact keeps from step to step. Effects of one slot that keep the same thing may share a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// Name in stage records; a vector's columns are this with x, y and z.
    pub name: &'static str,
    /// Shape.
    pub kind: Kind,
    /// Unit.
    pub unit: &'static str,
    /// What it is.
    pub doc: &'static str,
}

/// What the time step, servos and lists need to know of a normal law.
#[derive(Debug, Clone, Copy)]
pub struct NormalLaw {
    /// Largest stiffness S [N/m] up to an overlap.
    pub stiffest: fn(&ContactLaw, Elastic, OverlapLimit) -> f64,
    /// Largest gap [m] at which a contact that was made still acts, for a particle of this R* [m].
    pub reach: fn(&ContactLaw, Elastic, f64) -> f64,
    /// k_n over S [–]: the tangential stiffness is given by k_n, and effects take a share of S.
    pub nominal: fn(&ContactLaw) -> f64,
    /// Overlap of two particles that bear no load under a pull of this energy density [J/m³] × the area of contact, over the smaller
    /// radius [–], for radii from the first to the second [m]; infinite where the pull wins.
    pub unloaded_overlap: fn(&ContactLaw, Elastic, f64, [f64; 2]) -> f64,
    /// Whether S grows as √δ, as between elastic spheres; else it is constant.
    pub stiffens: bool,
    /// Whether its force depends on how deep a contact has been: its energy is no function of place, so that no contacts share one. Such a law has no dashpot.
    pub yields: bool,
}

/// Σ n nᵀ of the twelve contacts of a close packing [–].
pub const ALONG: f64 = 4.0;

/// What a spring and dashpot against relative turning add to A_r and B_r of docs/theory/time-step.md.
#[derive(Debug, Clone, Copy)]
pub struct Turning {
    /// A_r of k_t/m* and s [1/s²].
    pub stiffness: f64,
    /// B_r [1/s].
    pub damping: f64,
}

/// Numbers of a pair that A_r and B_r are made of: see `limit.rs`.
#[derive(Debug, Clone, Copy)]
pub struct TurningPair {
    /// Σ n nᵀ of the contacts that act at once [–], over the four of a close packing.
    pub dense: f64,
    /// s = (R*/r)² (½ + ½ r/r_larger) [–].
    pub share: f64,
    /// a_t = k_t/m* [1/s²].
    pub tangential: f64,
    /// √(S m*)/m* [1/s].
    pub impedance: f64,
    /// √(k_t m*)/m* [1/s].
    pub tangential_impedance: f64,
}

/// Two keys that contradict each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Contradiction {
    /// The key that is refused.
    pub key: &'static str,
    /// Why.
    pub why: String,
    /// What to do.
    pub cure: &'static str,
}

/// An effect of contact, as the rest of the program knows it.
#[derive(Debug, Clone, Copy)]
pub struct Description {
    /// Name in reports and messages.
    pub name: &'static str,
    /// What it does, in a line.
    pub doc: &'static str,
    /// What it does in a contact, and its entry of the ledger.
    pub slot: Slot,
    /// The model that asks for it; else its required keys do.
    pub model: Option<Model>,
    /// Whether it is meant, where several effects share a model: by which keys are given.
    pub picked: fn(&ContactLaw) -> bool,
    /// Numbers that it takes.
    pub keys: &'static [Key],
    /// What a contact keeps for it.
    pub history: &'static [Field],
    /// A slot that must have an effect, too.
    pub needs: Option<Slot>,
    /// A slot that must have none, and why.
    pub excludes: Option<(Slot, &'static str)>,
    /// Whether it is offered in every precision, or in double precision only.
    pub every_precision: bool,
    /// Whether it does nothing with these numbers: it is dropped then.
    pub idle: fn(&ContactLaw) -> bool,
    /// The model that does the same where it is idle; `None`: no effect.
    pub instead: Option<&'static str>,
    /// Numbers that contradict each other.
    pub contradiction: fn(&ContactLaw) -> Option<Contradiction>,
    /// Of normal laws.
    pub normal: Option<NormalLaw>,
    /// Of effects that resist turning.
    pub turning: Option<fn(&ContactLaw, &TurningPair) -> Turning>,
}

impl Description {
    /// What most effects do not have.
    pub const PLAIN: Description = Description {
        name: "",
        doc: "",
        slot: Slot::Normal,
        model: None,
        picked: |_| true,
        keys: &[],
        history: &[],
        needs: None,
        excludes: None,
        every_precision: false,
        idle: |_| false,
        instead: None,
        contradiction: |_| None,
        normal: None,
        turning: None,
    };

    /// Numbers that a contact keeps for it.
    pub fn columns(&self) -> usize {
        self.history.iter().map(|field| field.kind.columns()).sum()
    }

    /// Whether a law asks for it.
    pub fn asked_for(&self, law: &ContactLaw) -> bool {
        let model = self.model.is_none_or(|m| law.model(m.key).map_or(m.default, |value| value == m.value));
        let required = |key: &&Key| key.required;
        let given = |key: &Key| law.number(key.name).is_some() || self.is_law();
        model && (self.picked)(law) && self.keys.iter().filter(required).all(given)
    }

    /// Whether it is chosen by `law` alone; keys that it lacks are then missing.
    pub fn is_law(&self) -> bool {
        self.slot == Slot::Normal
    }
}
