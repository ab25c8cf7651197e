//! Walls as MCAP: metadata `materials`, then one message on `/walls`.

use crate::Regions;
use crate::attributes;
use std::io::Write;
use stream::Table;
use stream::mcap::{McapError, Provenance, Writer};

/// Topic of wall spheres.
pub const TOPIC: &str = "/walls";

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
    writer.metadata("materials", attributes::record(&regions.materials))?;
    writer.points(TOPIC, 0, "world", table)?;
    writer.finish()
}
