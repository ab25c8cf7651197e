//! A ParaView collection (`.pvd`): which file shows what at which time.

use super::polydata::escaped;
use std::io::{self, Write};

/// One file of a collection.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// When it is shown [s].
    pub time: f64,
    /// Which block it is, from 0: the same thing at all times.
    pub part: usize,
    /// Name of the block.
    pub name: String,
    /// The file, from the folder of the collection, with `/`.
    pub file: String,
}

/// Writes the collection.
///
/// # Errors
/// A write that fails.
pub fn write(entries: &[Entry], out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "<?xml version=\"1.0\"?>")?;
    writeln!(out, "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">")?;
    writeln!(out, "<Collection>")?;
    for Entry { time, part, name, file } in entries {
        let [name, file] = [name, file].map(|text| escaped(text));
        writeln!(
            out,
            "<DataSet timestep=\"{time}\" group=\"\" part=\"{part}\" name=\"{name}\" file=\"{file}\"/>"
        )?;
    }
    writeln!(out, "</Collection>\n</VTKFile>")
}
