//! Inlet streams: recorded particles that enter a run, read as the run needs them.
//!
//! [`InletStream::next_until`] gives [`Arrival`]s in the order of their times and waits for the stream until its watermark has passed the
//! time asked for. A stream without recorded paths is a list of crossings; with them, the rows of two topics are merged ([`paths`]).

mod announced;
mod paths;
mod short;
mod stream;

pub use short::short;
pub use stream::InletStream;

use dem::setup::{CrossingBond, Entry, Guide, PairHistory};

/// What an inlet or an insertion gives, in the order of times.
#[derive(Debug, Clone, Copy)]
pub enum Arrival {
    /// A particle or clump enters.
    Enter(Entry),
    /// The next position of a particle on a recorded path.
    Guide { time: f64, id: u32, guide: Guide },
    /// The contact history of two that came.
    History { time: f64, pair: PairHistory },
    /// A bond of two that came.
    Bond { time: f64, bond: CrossingBond },
}

impl Arrival {
    /// When it is due [s].
    pub fn time(&self) -> f64 {
        match self {
            Arrival::Enter(entry) => entry.time,
            Arrival::Guide { time, .. } | Arrival::History { time, .. } | Arrival::Bond { time, .. } => *time,
        }
    }
}
