//! Recorded paths as tables: where grains are on their last way to a storage plane (motion = "recorded").
//!
//! Topic `/crossings/paths` has a row for each of them at each sample, in the order of times; `gone` = 1 ends a path that leads back
//! upstream. The row of the same id on `/crossings` ends all others.

use crate::columns::Columns;
use crate::crossings::{self, Builder, Passage};
use crate::error::SceneError;
use dem::setup::PathSample;
use stream::{Table, Values};

/// Topic of the samples.
pub const PATHS: &str = "/crossings/paths";

/// Steps between two samples, where the scene does not say.
pub(crate) const STEPS: f64 = 10.0;

/// Most steps between two samples: a stage downstream reads not much farther ahead.
pub(crate) const MOST_STEPS: f64 = 100.0;

/// One row: a grain on its way, or where it has left it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Waypoint {
    /// State at its time.
    pub passage: Passage,
    /// Whether it has gone back upstream.
    pub gone: bool,
}

impl Waypoint {
    /// A sample at a time [s], in a run whose clumps have these masses at scale 1 [kg].
    pub(crate) fn new(time: f64, sample: &PathSample, masses: &[f64]) -> Waypoint {
        let passage = Passage {
            time,
            outlet: sample.outlet as u16,
            particle: sample.particle,
            contacts: 0,
            clump: crossings::with_mass(sample.clump, masses),
            turn: sample.turn,
        };
        Waypoint { passage, gone: sample.gone }
    }
}

/// The table of the topic.
pub fn to_table(rows: &[Waypoint]) -> Table {
    let passages: Vec<Passage> = rows.iter().map(|r| r.passage).collect();
    let gone = rows.iter().map(|r| u16::from(r.gone)).collect();
    Builder(crossings::to_table(&passages)).with("gone", Values::U16(gone)).0
}

/// The rows of a table.
///
/// # Errors
/// Columns that are missing or wrong; `materials` is the number of materials that the stream names.
pub fn from_table(stream: &str, table: &Table, materials: usize) -> Result<Vec<Waypoint>, SceneError> {
    let passages = crossings::from_table(stream, table, materials)?;
    let gone = Columns { name: stream, table }.indices("gone", 1.0)?;
    let gone = |i: usize| gone.as_ref().is_some_and(|g| g[i] == 1);
    Ok(passages.into_iter().enumerate().map(|(i, passage)| Waypoint { passage, gone: gone(i) }).collect())
}
