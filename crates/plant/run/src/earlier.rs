//! What a run had written before it was resumed, for an output that holds the whole run.

use crate::error::Result;
use record::{FRAME, LogMessage, RunTimes, metadata, nanoseconds, topic};
use scene::SceneError;
use std::io::{Read, Write};
use stream::mcap::{Event, McapError, Reader, Writer};

/// The file of a run that is resumed, read from its beginning.
pub struct Earlier {
    name: String,
    events: Reader<Box<dyn Read + Send>>,
    /// The first message, behind the head.
    first: Option<Event>,
    /// When that run began, which may have been resumed as well [s].
    pub(crate) start: f64,
}

impl Earlier {
    /// Reads the head of a run.
    ///
    /// # Errors
    /// A stream that is damaged.
    pub fn open(name: &str, source: Box<dyn Read + Send>) -> Result<Earlier> {
        let mut earlier =
            Earlier { name: name.to_owned(), events: Reader::new(source), first: None, start: 0.0 };
        while let Some(event) = earlier.next()? {
            let Event::Metadata { name, map } = event else {
                earlier.first = Some(event);
                break;
            };
            if name == metadata::TIME {
                earlier.start = RunTimes::read(&map).start.unwrap_or(0.0);
            }
        }
        Ok(earlier)
    }

    /// The next event; `None` at the end, also that of a run that was killed.
    fn next(&mut self) -> Result<Option<Event>> {
        match self.events.next() {
            None | Some(Err(McapError::Truncated { .. })) => Ok(None),
            Some(Ok(event)) => Ok(Some(event)),
            Some(Err(error)) => Err(SceneError::content(&self.name, "a run", error).into()),
        }
    }

    /// Writes all messages until the time of a checkpoint [s] but what no longer holds: why that run was stopped, its checkpoints, the histories of its
    /// last frame, and the frame of that time, which may be incomplete and is written again if it is due. Returns whether that frame had been begun.
    pub(crate) fn copy<W: Write>(mut self, writer: &mut Writer<W>, until: f64) -> Result<bool> {
        let (until, mut begun, mut has_walls) = (nanoseconds(until), false, false);
        let mut event = self.first.take();
        while let Some(message) = event {
            match message {
                Event::Points { topic, time_ns, table } if time_ns <= until && topic != topic::HISTORY => {
                    // Walls come once at the beginning, and with a frame where they move.
                    let of_frame = FRAMES.contains(&&*topic) || topic == topic::WALLS && has_walls;
                    has_walls |= topic == topic::WALLS;
                    begun |= topic == topic::PARTICLES && time_ns == until;
                    if time_ns < until || !of_frame {
                        writer.points(&topic, time_ns, FRAME, table)?;
                    }
                }
                Event::Bytes { topic, time_ns, data } => {
                    let of_frame = FRAMES.contains(&&*topic);
                    let kept = time_ns < until || time_ns == until && !of_frame;
                    if kept && holds(&topic, &data) {
                        writer.bytes(&topic, "json", time_ns, &data)?;
                    }
                }
                _ => {}
            }
            event = self.next()?;
        }
        Ok(begun)
    }
}

/// What a frame is made of.
const FRAMES: [&str; 9] = [
    topic::PARTICLES,
    topic::BODIES,
    topic::BONDS,
    topic::CONTACTS,
    topic::DOMAIN,
    topic::WALL_FORCES,
    topic::WALL_WEAR,
    topic::SETTLING,
    topic::ENERGY,
];

/// Whether a message in JSON is still true when the run goes on.
fn holds(topic: &str, data: &[u8]) -> bool {
    topic != topic::CHECKPOINT && !(topic == topic::LOG && LogMessage::read_stop(data).is_some())
}
