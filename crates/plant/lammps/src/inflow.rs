//! Inlet streams, read up to the end of the run before LAMMPS starts: LAMMPS must have all grains from the beginning.

use crate::error::Result;
use dem::setup::Entry;
use scene::Plan;
use stages::inlet::{Arrival, InletStream};

/// What inlet streams bring.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Inflow {
    /// All grains, in the order of their times.
    pub(crate) entries: Vec<Entry>,
    /// Contacts of theirs that have a history.
    histories: usize,
    /// For each stream that ended while grains still came in: its index and the time of its end [s].
    ended: Vec<(usize, f64)>,
}

impl Inflow {
    /// Reads all inlets of a plan until a time [s], and takes them out of it; the plan gets the clusters of the grains.
    ///
    /// # Errors
    /// A stream that breaks off or is out of order.
    pub fn read(plan: &mut Plan, until: f64) -> Result<Inflow> {
        let mut inflow = Inflow::default();
        for (index, inlet) in std::mem::take(&mut plan.inlets).into_iter().enumerate() {
            let mut stream = InletStream::new(inlet)?;
            while let Some(arrival) = stream.next_until(until)? {
                match arrival {
                    Arrival::Enter(entry) => inflow.entries.push(entry),
                    Arrival::History { .. } => inflow.histories += 1,
                    // Scenes with recorded paths and with bonds are refused before.
                    Arrival::Guide { .. } | Arrival::Bond { .. } => {}
                }
            }
            inflow.ended.extend(stream.ended().map(|time| (index, time)));
        }
        inflow.entries.sort_by(|a, b| a.time.total_cmp(&b.time));
        let clusters = &mut plan.setup.clusters;
        let entries = inflow.entries.iter().filter(|e| e.cluster != 0);
        clusters.extend(entries.map(|e| (e.particle.id, e.cluster)));
        clusters.sort_unstable();
        Ok(inflow)
    }

    /// What a user should know of a run that ends at `end` [s]; `springs`: contacts of the scene have springs.
    pub(crate) fn warnings(&self, end: f64, springs: bool) -> Vec<String> {
        let short = self.ended.iter().filter_map(|(index, last)| stages::inlet::short(*index, *last, end));
        let count = self.histories;
        let histories = (count > 0 && springs).then(|| {
            format!("inlet: {count} contacts of the record have a history, which cannot be given to LAMMPS: they begin without it")
        });
        short.chain(histories).collect()
    }
}
