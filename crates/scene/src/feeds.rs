//! Particles of all faucets and inlet streams, in the order of their times.

use crate::error::SceneError;
use crate::plan::Feeds;
use dem::setup::Entry;

/// What comes in, and how much of it has.
pub(crate) struct Supply {
    feeds: Feeds,
    /// The next particle of each feed, when it is known.
    next: Vec<Option<Entry>>,
    /// How many particles each feed has given.
    pub given: Vec<u64>,
}

impl Supply {
    /// A supply from the start; streams first, then faucets.
    pub(crate) fn new(feeds: Feeds) -> Supply {
        let count = feeds.streams.len() + feeds.faucets.len();
        Supply { feeds, next: vec![None; count], given: vec![0; count] }
    }

    /// Passes over what a run had taken when it was saved.
    ///
    /// # Errors
    /// A feed that has less.
    pub(crate) fn skip(&mut self, given: &[u64]) -> Result<(), SceneError> {
        for (feed, &count) in given.iter().enumerate().take(self.given.len()) {
            for n in 0..count {
                if self.fetch(feed, f64::INFINITY)?.is_none() {
                    let why = format!("ends after {n} particles, and the saved run had taken {count}");
                    return Err(SceneError::file(
                        &format!("inlet {feed}"),
                        why,
                        "give the same inlet as then",
                    ));
                }
            }
            self.given[feed] = count;
        }
        Ok(())
    }

    fn fetch(&mut self, feed: usize, until: f64) -> Result<Option<Entry>, SceneError> {
        let streams = self.feeds.streams.len();
        if feed < streams {
            return self.feeds.streams[feed].next_until(until);
        }
        let faucet = &mut self.feeds.faucets[feed - streams];
        if faucet.next_time().is_some_and(|t| t <= until) { faucet.next() } else { Ok(None) }
    }

    /// The next particle of all feeds whose time is at most `until` [s].
    ///
    /// # Errors
    /// A stream that breaks off, a faucet without room.
    pub(crate) fn next_until(&mut self, until: f64) -> Result<Option<Entry>, SceneError> {
        for feed in 0..self.next.len() {
            if self.next[feed].is_none() {
                self.next[feed] = self.fetch(feed, until)?;
            }
        }
        let due = |e: &Option<Entry>| e.as_ref().filter(|e| e.time <= until).map(|e| e.time);
        let times = self.next.iter().enumerate().filter_map(|(i, e)| due(e).map(|t| (t, i)));
        let Some((_, first)) = times.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))) else {
            return Ok(None);
        };
        self.given[first] += 1;
        Ok(self.next[first].take())
    }
}
