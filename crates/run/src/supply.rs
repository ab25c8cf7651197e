//! Particles of all faucets and inlet streams, in the order of their times.

use crate::error::SceneError;
use crate::plan::Feeds;
use dem::setup::{Entry, Guide, Link, Memory};
use geom::Shown;

/// What a feed gives: a particle, or news of one that it gave.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Item {
    Enter(Entry),
    Guide { time: f64, id: u32, guide: Guide },
    Remember { time: f64, memory: Memory },
    Link { time: f64, link: Link },
}

impl Item {
    /// When it is due [s].
    pub fn time(&self) -> f64 {
        match self {
            Item::Enter(entry) => entry.time,
            Item::Guide { time, .. } | Item::Remember { time, .. } | Item::Link { time, .. } => *time,
        }
    }
}

/// What comes in, and how much of it has.
pub(crate) struct Supply {
    feeds: Feeds,
    /// The next item of each feed, when it is known.
    next: Vec<Option<Item>>,
    /// How many items each feed has given.
    pub given: Vec<u64>,
    /// How many of them are particles.
    pub entered: u64,
}

impl Supply {
    /// A supply from the start; streams first, then faucets.
    pub(crate) fn new(feeds: Feeds) -> Supply {
        let count = feeds.streams.len() + feeds.faucets.len();
        Supply { feeds, next: vec![None; count], given: vec![0; count], entered: 0 }
    }

    /// Longest time between samples of recorded paths [s]; 0 without any.
    pub(crate) fn samples(&self) -> f64 {
        let gates = self.feeds.streams.iter().filter_map(|s| s.gate.as_ref());
        gates.filter_map(|gate| gate.samples).fold(0.0, f64::max)
    }

    /// What is said of streams that ended while grains still came in, long before the run does, at `end` [s]: from then on nothing comes.
    pub(crate) fn ended(&self, end: f64) -> Vec<String> {
        let early = self.feeds.streams.iter().filter_map(|s| s.ended().map(|told| (s, told)));
        let early = early.filter(|(_, told)| *told < end * (1.0 - 1e-6));
        early
            .map(|(stream, told)| {
                format!(
                    "{}: the record ends at t = {} s while grains still came in, and this run at {} s: nothing came in after it; \
                     let the stage upstream run longer, or end this one there (--until)",
                    stream.name,
                    Shown(told),
                    Shown(end)
                )
            })
            .collect()
    }

    /// Passes over what a run had taken when it was saved: nothing that is due after `horizon` [s].
    ///
    /// # Errors
    /// A feed that has less, or others.
    pub(crate) fn skip(&mut self, given: &[u64], horizon: f64) -> Result<(), SceneError> {
        for (feed, &count) in given.iter().enumerate().take(self.given.len()) {
            for n in 0..count {
                let item = self.fetch(feed, f64::INFINITY)?;
                self.entered += u64::from(matches!(item, Some(Item::Enter(_))));
                let why = match item.as_ref().map(Item::time) {
                    None => format!("ends after {n} particles, and the saved run had taken {count}"),
                    Some(due) if due > horizon => format!(
                        "{count} particles had come in when the run was saved, and number {} of these is due at {} s, later than that",
                        n + 1,
                        Shown(due)
                    ),
                    Some(_) => continue,
                };
                return Err(SceneError::file(
                    &format!("inlet {feed}"),
                    why,
                    "give the same inlet as then, from its beginning",
                ));
            }
            self.given[feed] = count;
        }
        Ok(())
    }

    fn fetch(&mut self, feed: usize, until: f64) -> Result<Option<Item>, SceneError> {
        let streams = self.feeds.streams.len();
        if feed < streams {
            return self.feeds.streams[feed].next_until(until);
        }
        let faucet = &mut self.feeds.faucets[feed - streams];
        if faucet.next_time().is_some_and(|t| t <= until) {
            Ok(faucet.next()?.map(Item::Enter))
        } else {
            Ok(None)
        }
    }

    /// The next item of all feeds whose time is at most `until` [s].
    ///
    /// # Errors
    /// A stream that breaks off, a faucet without room.
    pub(crate) fn next_until(&mut self, until: f64) -> Result<Option<Item>, SceneError> {
        for feed in 0..self.next.len() {
            if self.next[feed].is_none() {
                self.next[feed] = self.fetch(feed, until)?;
            }
        }
        let due = |e: &Option<Item>| e.as_ref().map(Item::time).filter(|time| *time <= until);
        let times = self.next.iter().enumerate().filter_map(|(i, e)| due(e).map(|t| (t, i)));
        let Some((_, first)) = times.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))) else {
            return Ok(None);
        };
        self.given[first] += 1;
        self.entered += u64::from(matches!(self.next[first], Some(Item::Enter(_))));
        Ok(self.next[first].take())
    }
}
