//! The records `sizes` and `bonds`: what the particles and bonds that a stream can bring ask of a setup.

use crate::error::positive;
use crate::{Map, RecordError, metadata};

/// A range of radii.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sizes {
    /// Smallest radius [m].
    pub smallest: f64,
    /// Largest radius [m].
    pub largest: f64,
}

impl Sizes {
    /// The record.
    pub fn to_map(self) -> Map {
        numbers([("smallest_radius", self.smallest), ("largest_radius", self.largest)])
    }

    /// From the record.
    ///
    /// # Errors
    /// A key that is missing, or not a positive number.
    pub fn from_map(stream: &str, map: &Map) -> Result<Sizes, RecordError> {
        let number = |key: &str| positive(stream, metadata::SIZES, map, key);
        Ok(Sizes { smallest: number("smallest_radius")?, largest: number("largest_radius")? })
    }

    /// The range that holds both.
    pub fn union(a: Option<Sizes>, b: Option<Sizes>) -> Option<Sizes> {
        match (a, b) {
            (Some(a), Some(b)) => {
                Some(Sizes { smallest: a.smallest.min(b.smallest), largest: a.largest.max(b.largest) })
            }
            _ => a.or(b),
        }
    }
}

/// Limits over all bonds of a stream.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondRange {
    /// Critical time step of these bonds alone [s].
    pub step: f64,
    /// Length of the longest at rest [m].
    pub longest: f64,
}

impl BondRange {
    /// The record.
    pub fn to_map(self) -> Map {
        numbers([("step", self.step), ("longest", self.longest)])
    }

    /// From the record.
    ///
    /// # Errors
    /// A key that is missing, or not a positive number.
    pub fn from_map(stream: &str, map: &Map) -> Result<BondRange, RecordError> {
        let number = |key: &str| positive(stream, metadata::BONDS, map, key);
        Ok(BondRange { step: number("step")?, longest: number("longest")? })
    }
}

/// A record of two numbers.
fn numbers(entries: [(&str, f64); 2]) -> Map {
    Map::from(entries.map(|(key, number)| (key.to_owned(), number.to_string())))
}
