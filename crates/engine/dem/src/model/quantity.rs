//! Which number of a setup is refused, and what it may be.

use crate::setup::{Precision, Setup};
use std::borrow::Cow;
use std::fmt::{Display, Formatter, Result};

/// What a number belongs to.
#[derive(Debug, Clone, PartialEq)]
pub enum Subject {
    /// The setup itself.
    Setup,
    /// The time step.
    TimeStep,
    /// The guards.
    Guards,
    /// The neighbour lists.
    NeighbourLists,
    /// The fluid.
    Drag,
    /// The rules of sleep.
    Sleep,
    /// What a precision can represent.
    Precision(Precision),
    /// A material, by name.
    Material(String),
    /// The contact law of two materials; `None` where the materials themselves are wrong.
    Contact(Option<[String; 2]>),
    /// The bonds of two materials; `None` where the materials themselves are wrong.
    Bond(Option<[String; 2]>),
    /// A particle, by id.
    Particle(u32),
    /// The shape of clumps, by name.
    ClumpShape(String),
    /// A clump, by id.
    Clump(u32),
    /// A wall, by name.
    Wall(String),
    /// An end of the periodic box, "low" or "high"; the quantity is its axis.
    PeriodicEnd(&'static str),
    /// What inlets have announced.
    Inlet,
    /// A particle that enters, by id.
    Entry(u32),
    /// A component of a particle that enters, along the flow, by id.
    EntryAlongFlow(u32),
    /// A clump that enters, by id.
    EntryClump(u32),
    /// The recorded path of a particle, by id.
    Path(u32),
}

impl Subject {
    /// A number of it.
    pub fn quantity(self, name: &'static str) -> Quantity {
        Quantity { of: self, name }
    }
}

/// Names of two materials.
pub(crate) fn material_names(setup: &Setup, between: (u16, u16)) -> [String; 2] {
    [between.0, between.1].map(|m| setup.materials[m as usize].name.clone())
}

/// The name of a number and what it belongs to.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// What it belongs to.
    pub of: Subject,
    /// Its name: the field of the setup, or the key of an effect.
    pub name: &'static str,
}

impl Display for Quantity {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match &self.of {
            Subject::Setup => {}
            Subject::TimeStep => write!(f, "time step: ")?,
            Subject::Guards => write!(f, "guards: ")?,
            Subject::NeighbourLists => write!(f, "neighbour lists: ")?,
            Subject::Drag => write!(f, "drag: ")?,
            Subject::Sleep => write!(f, "sleep: ")?,
            Subject::Precision(precision) => write!(f, "precision {}: ", precision.name())?,
            Subject::Material(name) => write!(f, "material '{name}': ")?,
            Subject::Contact(Some([a, b])) => write!(f, "contact {a}–{b}: ")?,
            Subject::Contact(None) => write!(f, "contact: ")?,
            Subject::Bond(Some([a, b])) => write!(f, "bond {a}–{b}: ")?,
            Subject::Bond(None) => write!(f, "bond: ")?,
            Subject::Particle(id) => write!(f, "particle {id}: ")?,
            Subject::ClumpShape(name) => write!(f, "clump '{name}': ")?,
            Subject::Clump(id) => write!(f, "clump {id}: ")?,
            Subject::Wall(name) => write!(f, "wall '{name}': ")?,
            Subject::PeriodicEnd(end) => write!(f, "{end} end of the periodic box: ")?,
            Subject::Inlet => write!(f, "inlet: ")?,
            Subject::Entry(id) => write!(f, "entering particle {id}: ")?,
            Subject::EntryAlongFlow(id) => {
                return write!(f, "entering particle {id}: {} along the flow", self.name);
            }
            Subject::EntryClump(id) => write!(f, "entering clump {id}: ")?,
            Subject::Path(id) => write!(f, "path of particle {id}: ")?,
        }
        f.write_str(self.name)
    }
}

/// What a number may be.
#[derive(Debug, Clone, PartialEq)]
pub enum Allowed {
    /// An interval or a kind of numbers.
    Values(Cow<'static, str>),
    /// An index of this list of the setup: "materials", "clumps", "inlets".
    IndexOf(&'static str),
    /// An attraction that the stiffness bears: without load, particles overlap by less than the guard.
    BelowOverlapGuard,
    /// Above 0: a sleeping particle wakes by a share of its weight.
    SomeWeight,
}

impl From<&'static str> for Allowed {
    fn from(values: &'static str) -> Allowed {
        Allowed::Values(values.into())
    }
}

impl From<String> for Allowed {
    fn from(values: String) -> Allowed {
        Allowed::Values(values.into())
    }
}

impl Display for Allowed {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            Allowed::Values(values) => f.write_str(values),
            Allowed::IndexOf(list) => write!(f, "the setup's {list}"),
            Allowed::BelowOverlapGuard => {
                write!(
                    f,
                    "what the stiffness bears: without load, particles overlap by more than the guard allows"
                )
            }
            Allowed::SomeWeight => {
                write!(f, "gravity > 0: a sleeping particle wakes by a share of its weight")
            }
        }
    }
}

/// A number that is outside its range.
#[derive(Debug, Clone, PartialEq)]
pub struct OutOfRange {
    /// Which number.
    pub quantity: Quantity,
    /// Its value.
    pub value: f64,
    /// Its unit; "[–]" for a ratio or an index.
    pub unit: &'static str,
    /// What is allowed.
    pub allowed: Allowed,
}

impl Display for OutOfRange {
    fn fmt(&self, f: &mut Formatter) -> Result {
        write!(f, "{}: {} {} is outside {}", self.quantity, self.value, self.unit, self.allowed)
    }
}
