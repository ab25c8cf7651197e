//! Walls as MCAP: metadata `materials`, then one message on `/walls`.

use crate::regions::Regions;
use record::{FRAME, MaterialRecord, metadata, topic};
use std::io::Write;
use stream::Table;
use stream::mcap::{McapError, Provenance, Writer};

/// Writes the wall's columns and materials, and gives the output back, whole.
///
/// # Errors
/// A write that fails; then the stream has no end, and readers refuse it.
pub fn write_mcap<W: Write>(
    out: W,
    table: &Table,
    regions: &Regions,
    provenance: &Provenance,
) -> Result<W, McapError> {
    let mut writer = Writer::new(out, provenance)?;
    writer.metadata(metadata::MATERIALS, MaterialRecord::to_map(&regions.materials))?;
    writer.points(topic::WALLS, 0, FRAME, table)?;
    writer.finish()
}
