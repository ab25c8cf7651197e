//! Particles that follow recorded paths: which of them are on their way.

use super::Arrival;
use crate::outlet::path::PathRow;
use dem::setup::{Entry, Guide, Sample};
use std::collections::{BTreeMap, VecDeque};

/// Rows of the topic of paths that have been read, and the particles on their way.
#[derive(Default)]
pub(super) struct Paths {
    pub rows: VecDeque<PathRow>,
    /// Time of the last sample of each particle on its way in [s].
    pub present: BTreeMap<u32, f64>,
    /// Time of the crossing of those that have just crossed [s].
    pub crossed: BTreeMap<u32, f64>,
}

impl Paths {
    /// What the row of a path gives, with the entry of its state.
    pub fn sample(&mut self, row: &PathRow, entry: Entry) -> Option<Arrival> {
        let (id, time) = (row.row.particle.id, row.row.time);
        // A crossing at the very time of a sample may come before it, by rounding: the sample adds nothing.
        let same = |t: f64| time - t <= 4.0 * f64::EPSILON * time.abs();
        self.crossed.retain(|_, t| same(*t));
        if self.crossed.contains_key(&id) {
            return None;
        }
        let known = if row.gone { self.present.remove(&id) } else { self.present.insert(id, time) }.is_some();
        match (known, row.gone) {
            (false, true) => None,
            (false, false) => Some(Arrival::Enter(entry)),
            (true, true) => Some(Arrival::Guide { time, id, guide: Guide::Gone }),
            (true, false) => Some(Arrival::Guide { time, id, guide: Guide::At(Sample::of(&entry)) }),
        }
    }

    /// The record has ended: particles that have not crossed go no farther.
    pub fn end(&mut self) -> impl Iterator<Item = Arrival> + use<> {
        let gone = |(id, time)| Arrival::Guide { time, id, guide: Guide::Gone };
        std::mem::take(&mut self.present).into_iter().map(gone)
    }
}
