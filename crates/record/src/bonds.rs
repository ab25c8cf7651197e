//! The record `bonds`: what the bonds that a stream can bring ask of a time step.

use crate::error::positive;
use crate::{Map, RecordError, metadata};

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
        let number = |key: &str, x: f64| (key.to_owned(), x.to_string());
        Map::from([number("step", self.step), number("longest", self.longest)])
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
