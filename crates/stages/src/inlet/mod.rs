//! Inlet streams: recorded particles that enter a run, read as the run needs them.
//!
//! [`InletStream::next_until`] gives [`Arrival`]s in the order of their times and waits for the stream until its watermark has passed the
//! time asked for. A stream without recorded paths is a list of crossings; with them, the rows of two topics are merged ([`paths`]).

mod announced;
mod arrival;
mod paths;
mod stream;

pub use arrival::Arrival;
pub use stream::InletStream;
