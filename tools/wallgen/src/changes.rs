//! The pairs whose roughness is not the one asked for, as CSV.

use cli::OutputStream;
use std::io::Write;
use std::path::Path;
use wall::solve::Changed;

/// Writes a row for each pair, in the order of their points.
pub fn write(path: &Path, changed: &[Changed]) -> anyhow::Result<()> {
    let mut out = OutputStream::file(path)?;
    writeln!(out, "point_i,point_j,x,y,z,distance,asked,made")?;
    for c in changed {
        let ([i, j], [x, y, z]) = (c.points, c.at);
        writeln!(out, "{i},{j},{x},{y},{z},{},{},{}", c.distance, c.asked, c.made)?;
    }
    out.commit()
}
