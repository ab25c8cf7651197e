//! The pairs whose roughness is not the one asked for, as CSV.

use cli::OutputStream;
use std::path::Path;
use wall::solve::Changed;

/// Writes a row for each pair, in the order of their points.
pub fn write(path: &Path, changed: &[Changed]) -> anyhow::Result<()> {
    let mut out = OutputStream::file(path)?;
    let mut table = csv::Writer::from_writer(&mut out);
    table.write_record(["point_i", "point_j", "x", "y", "z", "distance", "asked", "made"])?;
    for c in changed {
        let ([i, j], [x, y, z]) = (c.points, c.at);
        let numbers = [x, y, z, c.distance, c.asked, c.made].map(|v| v.to_string());
        table.write_record([i.to_string(), j.to_string()].iter().chain(&numbers))?;
    }
    table.flush()?;
    drop(table);
    out.commit()
}
