//! The head of an inlet stream: its metadata records.

use super::{Input, ZoneRecord};
use crate::error::{Result, SceneError};
use record::{BondRange, ClumpRecord, Map, MaterialRecord, Sizes, metadata};
use std::io::Read;
use std::path::Path;
use stream::mcap::{Event, Reader};

/// Bytes of a file or a pipe.
pub type Source = Box<dyn Read + Send>;

/// The records of a stream before its first message.
#[derive(Default)]
pub(super) struct StreamHead {
    zone: Option<ZoneRecord>,
    sizes: Option<Sizes>,
    only_clumps: bool,
    pub(super) materials: Vec<MaterialRecord>,
    clumps: Vec<ClumpRecord>,
    bonds: Option<BondRange>,
}

impl StreamHead {
    /// Takes a record; records of other names are passed over.
    pub(super) fn take(&mut self, name: &str, record: &str, map: &Map) -> Result<()> {
        match record {
            metadata::MATERIALS => self.materials = MaterialRecord::from_map(name, map)?,
            metadata::CLUMPS => self.clumps = ClumpRecord::from_map(name, map)?,
            metadata::SIZES => {
                self.only_clumps = map.contains_key(metadata::ONLY_CLUMPS);
                self.sizes = Some(Sizes::from_map(name, map)?);
            }
            metadata::BONDS => self.bonds = Some(BondRange::from_map(name, map)?),
            metadata::INLET => self.zone = Some(ZoneRecord::from_map(name, metadata::INLET, map)?),
            _ => {}
        }
        Ok(())
    }
}

/// An inlet stream whose head was read.
pub struct InletSource {
    /// Its name, for messages.
    pub name: String,
    /// Its zone, when the stream names one.
    pub zone: Option<ZoneRecord>,
    /// Radii that it can bring.
    pub sizes: Sizes,
    /// Whether all that it brings are clumps.
    pub only_clumps: bool,
    /// Its materials, by index.
    pub materials: Vec<MaterialRecord>,
    /// Its shapes of clumps, by index.
    pub clumps: Vec<ClumpRecord>,
    /// Bonds that it can bring.
    pub bonds: Option<BondRange>,
    /// Whether it is a file: reading it to its end waits for no other program.
    pub file: bool,
    /// Its first message, when that was read.
    pub first: Option<Event>,
    /// The rest.
    pub reader: Reader<Source>,
}

impl InletSource {
    pub(super) fn input(
        name: &str,
        reader: Reader<Source>,
        first: Option<Event>,
        head: StreamHead,
    ) -> Result<Input> {
        let missing = |record: &str, what: &str| {
            let why = format!("the record '{record}' ({what}) is missing");
            SceneError::file(name, why, "write it with stage-replay")
        };
        let sizes = head.sizes.ok_or_else(|| missing(metadata::SIZES, "range of the radii"))?;
        let StreamHead { zone, only_clumps, materials, clumps, bonds, .. } = head;
        if materials.is_empty() {
            return Err(missing(metadata::MATERIALS, "names of the materials"));
        }
        let (name, file) = (name.to_owned(), Path::new(name).is_file());
        let source =
            InletSource { name, zone, sizes, only_clumps, materials, clumps, bonds, file, first, reader };
        Ok(Input::Inlet(Box::new(source)))
    }
}
