//! What particles come in by.

use std::fmt::{Display, Formatter, Result};

/// What a particle comes in by: to the engine all are inlets; those of a scene are cuts of a plant first, and insertions after them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Entrance {
    /// A cut of a plant, by its index.
    Inlet(u32),
    /// An insertion, by its index among insertions.
    Insert(u32),
}

impl Entrance {
    /// Of an inlet by its index, where the first `cuts` are cuts ([`crate::setup::Guards::cuts`]).
    pub fn of(inlet: u32, cuts: u32) -> Entrance {
        inlet.checked_sub(cuts).map_or(Entrance::Inlet(inlet), Entrance::Insert)
    }
}

impl Display for Entrance {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            Entrance::Inlet(k) => write!(f, "inlet {k}"),
            Entrance::Insert(k) => write!(f, "insert {k}"),
        }
    }
}
