//! Rows of the topic `/crossings/paths`: samples of the last part of a path to a storage plane (motion = "recorded").
//!
//! A row for each particle at each sample, in the order of times; `gone` = 1 ends a path that leads back upstream. The row of the same id
//! on `/crossings` ends all others.

use super::crossing::{self, CrossingRow};
use dem::setup::PathSample;
use record::column::GONE;
use record::{Columns, RecordError};
use stream::Table;

/// Steps between two samples, where the scene does not say.
pub const STEPS: f64 = 10.0;

/// Most steps between two samples: a stage downstream reads not much farther ahead.
pub const MOST_STEPS: f64 = 100.0;

/// One row: a particle on its path, or where it has left it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathRow {
    /// State at its time.
    pub row: CrossingRow,
    /// Whether it has gone back upstream.
    pub gone: bool,
}

impl PathRow {
    /// A sample at a time [s], in a run whose clumps have these masses at scale 1 [kg].
    pub fn new(time: f64, sample: &PathSample, masses: &[f64]) -> PathRow {
        let row = CrossingRow {
            time,
            outlet: sample.outlet as u16,
            particle: sample.particle,
            contacts: 0,
            clump: crossing::with_mass(sample.clump, masses),
            turn: sample.turn,
            cluster: sample.cluster,
        };
        PathRow { row, gone: sample.gone }
    }
}

/// The table of the topic.
pub fn to_table(rows: &[PathRow]) -> Table {
    let crossings: Vec<CrossingRow> = rows.iter().map(|r| r.row).collect();
    crossing::columns(&crossings).u16(GONE, rows.iter().map(|r| u16::from(r.gone))).done()
}

/// The rows of a table.
///
/// # Errors
/// Columns that are missing or wrong; `materials` is the number of materials that the stream names.
pub fn from_table(stream: &str, table: &Table, materials: usize) -> Result<Vec<PathRow>, RecordError> {
    let rows = crossing::from_table(stream, table, materials)?;
    let gone = Columns { name: stream, table }.indices(GONE, 1.0)?;
    let gone = |i: usize| gone.as_ref().is_some_and(|g| g[i] == 1);
    Ok(rows.into_iter().enumerate().map(|(i, row)| PathRow { row, gone: gone(i) }).collect())
}
