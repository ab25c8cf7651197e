//! What comes in: a particle, or news of one that came.

use dem::setup::{Entry, Guide, Link, Memory};

/// What an inlet or an insertion gives, in the order of times.
#[derive(Debug, Clone, Copy)]
#[allow(missing_docs)]
pub enum Arrival {
    /// A particle or clump enters.
    Enter(Entry),
    /// The next position of a particle on a recorded path.
    Guide { time: f64, id: u32, guide: Guide },
    /// The contact history of two that came.
    Remember { time: f64, memory: Memory },
    /// A bond of two that came.
    Bond { time: f64, bond: Link },
}

impl Arrival {
    /// When it is due [s].
    pub fn time(&self) -> f64 {
        match self {
            Arrival::Enter(entry) => entry.time,
            Arrival::Guide { time, .. } | Arrival::Remember { time, .. } | Arrival::Bond { time, .. } => {
                *time
            }
        }
    }
}
