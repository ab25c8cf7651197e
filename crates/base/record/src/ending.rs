//! Whether a run came to its end, from its events.

use crate::{LogMessage, SIGNAL, metadata, nanoseconds, topic};
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
                self.until = map.get("end").and_then(|end| end.parse().ok());
            }
            Event::Bytes { topic, data, .. } if topic == topic::LOG => {
                self.stopped = LogMessage::stop(data).or(self.stopped.take());
            }
            Event::Points { topic, time_ns, .. } if topic == topic::PARTICLES => {
                self.stopped = self.stopped.take().filter(|stop| *time_ns <= nanoseconds(stop.time));
            }
            _ => {}
        }
    }

    /// `stopped by a guard at 1.95 s of 8 s`; `None` if nothing stopped it.
    pub fn words(&self) -> Option<String> {
        let LogMessage { text, time, .. } = self.stopped.as_ref()?;
        let of = self.until.map_or(String::new(), |until| format!(" of {} s", Shown(until)));
        let by = if text == SIGNAL { "signal" } else { "guard" };
        Some(format!("stopped by a {by} at {} s{of}", Shown(*time)))
    }

    /// A warning before the run is used: what stopped it, when, of how much; `None` if nothing did.
    pub fn warning(&self) -> Option<String> {
        let (stop, words) = (self.stopped.as_ref()?, self.words()?);
        let why = if stop.text == SIGNAL { String::new() } else { format!(": {}", stop.text) };
        Some(format!("the run was {words}, and what comes after is missing{why}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Map;
    use stream::Table;

    fn warning(text: &str, frames: &[f64]) -> Option<String> {
        let mut ending = Ending::default();
        let map = Map::from([("end".to_owned(), "8".to_owned())]);
        ending.take(&Event::Metadata { name: metadata::TIME.to_owned(), map });
        let data = crate::json(&LogMessage::note(0.5, "a note")).into_bytes();
        ending.take(&Event::Bytes { topic: topic::LOG.to_owned(), time_ns: 0, data });
        assert_eq!(ending.warning(), None);
        let data = crate::json(&LogMessage::stopped(1.95, text)).into_bytes();
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
        assert_eq!(warning("particle 7 overlaps", &[1.95]).as_deref(), Some(guard));
        let signal = "the run was stopped by a signal at 1.95 s of 8 s, and what comes after is missing";
        assert_eq!(warning(SIGNAL, &[]).as_deref(), Some(signal));
        assert_eq!(warning(SIGNAL, &[1.96]), None, "resumed in the same file");
    }
}
