//! The record `sizes`: radii of all particles that a stream can bring.

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
        let number = |name: &str, v: f64| (name.to_owned(), v.to_string());
        Map::from([number("smallest_radius", self.smallest), number("largest_radius", self.largest)])
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
