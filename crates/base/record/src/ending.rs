//! Whether a run came to its end, from its events.

use crate::{LogMessage, RunTimes, StopCause, metadata, nanoseconds, topic};
use geom::Shown;
use stream::mcap::Event;

/// How far a run was to go, and why it was stopped.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ending {
    /// Time at which it was to end [s].
    until: Option<f64>,
    stopped: Option<LogMessage>,
}

impl Ending {
    /// Takes an event of the run. A frame after the stop belongs to a run that was resumed.
    pub fn take(&mut self, event: &Event) {
        match event {
            Event::Metadata { name, map } if name == metadata::TIME => {
                self.until = RunTimes::read(map).end;
            }
            Event::Bytes { topic, data, .. } if topic == topic::LOG => {
                self.stopped = LogMessage::read_stop(data).or(self.stopped.take());
            }
            Event::Points { topic, time_ns, .. } if topic == topic::PARTICLES => {
                self.stopped = self.stopped.take().filter(|stop| *time_ns <= nanoseconds(stop.time));
            }
            _ => {}
        }
    }

    /// `stopped by a guard at 1.95 s of 8 s`; `None` if nothing stopped it.
    pub fn words(&self) -> Option<String> {
        let LogMessage { time, stop, .. } = self.stopped.as_ref()?;
        let of = self.until.map_or(String::new(), |until| format!(" of {} s", Shown(until)));
        let by = stop.map_or(String::new(), |cause| format!(" by a {}", cause.name()));
        Some(format!("stopped{by} at {} s{of}", Shown(*time)))
    }

    /// A warning before the run is used: what stopped it, when, of how much; `None` if nothing did.
    pub fn warning(&self) -> Option<String> {
        let (stop, words) = (self.stopped.as_ref()?, self.words()?);
        let why =
            if stop.stop == Some(StopCause::Signal) { String::new() } else { format!(": {}", stop.text) };
        Some(format!("the run was {words}, and what comes after is missing{why}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Guard, Map, SIGNAL};
    use stream::Table;

    fn warning(text: &str, cause: StopCause, frames: &[f64]) -> Option<String> {
        let mut ending = Ending::default();
        let map = Map::from([("end".to_owned(), "8".to_owned())]);
        ending.take(&Event::Metadata { name: metadata::TIME.to_owned(), map });
        let data = crate::json(&LogMessage::note(0.5, "a note")).into_bytes();
        ending.take(&Event::Bytes { topic: topic::LOG.to_owned(), time_ns: 0, data });
        assert_eq!(ending.warning(), None);
        let data = crate::json(&LogMessage::stopped(1.95, text, cause)).into_bytes();
        ending.take(&Event::Bytes { topic: topic::LOG.to_owned(), time_ns: nanoseconds(1.95), data });
        for time in frames {
            let (topic, table) = (topic::PARTICLES.to_owned(), Table::default());
            ending.take(&Event::Points { topic, time_ns: nanoseconds(*time), table });
        }
        ending.warning()
    }

    #[test]
    fn a_stopped_run_says_by_what_when_and_of_how_much() {
        let guard = "the run was stopped by a guard at 1.95 s of 8 s, and what comes after is missing: particle 7 overlaps";
        let cause = StopCause::Guard { guard: Guard::Overlap };
        assert_eq!(warning("particle 7 overlaps", cause, &[1.95]).as_deref(), Some(guard));
        let device = "the run was stopped by a device failure at 1.95 s of 8 s, and what comes after is missing: GPU 0";
        assert_eq!(warning("GPU 0", StopCause::Device, &[]).as_deref(), Some(device));
        let signal = "the run was stopped by a signal at 1.95 s of 8 s, and what comes after is missing";
        for text in [SIGNAL, "the terminal was closed"] {
            assert_eq!(warning(text, StopCause::Signal, &[]).as_deref(), Some(signal));
            assert_eq!(warning(text, StopCause::Signal, &[1.96]), None, "resumed in the same file");
        }
    }
}
