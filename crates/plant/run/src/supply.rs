//! Particles of all inlet streams and insertions, in the order of their times.

use crate::checkpoint::Checkpoint;
use geom::Shown;
use scene::SceneError;
use scene::plan::{Insertion, PlannedInlet};
use stages::inlet::{Arrival, InletStream};

/// What comes in, from streams first and then insertions.
pub(crate) struct Supply {
    streams: Vec<InletStream>,
    insertions: Vec<Insertion>,
    /// The next arrival of each source, when it is known.
    next: Vec<Option<Arrival>>,
    /// How many arrivals each source has given.
    pub given: Vec<u64>,
    /// How many of them are particles.
    pub entered: u64,
}

impl Supply {
    /// A supply from the start.
    ///
    /// # Errors
    /// A stream whose first message is wrong.
    pub(crate) fn new(inlets: Vec<PlannedInlet>, insertions: Vec<Insertion>) -> Result<Supply, SceneError> {
        let streams = inlets.into_iter().map(InletStream::new).collect::<Result<Vec<_>, _>>()?;
        let count = streams.len() + insertions.len();
        Ok(Supply { streams, insertions, next: vec![None; count], given: vec![0; count], entered: 0 })
    }

    /// Longest time between samples of recorded paths [s]; 0 without any.
    pub(crate) fn samples(&self) -> f64 {
        self.streams.iter().map(InletStream::samples).fold(0.0, f64::max)
    }

    /// A warning for each stream that ended while particles still came in, long before the run does, at `end` [s].
    pub(crate) fn ended(&self, end: f64) -> Vec<String> {
        let warning =
            |(index, stream): (usize, &InletStream)| stages::inlet::short(index, stream.ended()?, end);
        self.streams.iter().enumerate().filter_map(warning).collect()
    }

    /// Whether an insertion still brings particles until `end` [s].
    pub(crate) fn comes(&self, end: f64) -> bool {
        let due = |insertion: &Insertion| insertion.next_time().is_some_and(|time| time <= end);
        self.next.iter().any(Option::is_some) || self.insertions.iter().any(due)
    }

    /// Checks what of inlet files comes after the end of the run.
    ///
    /// # Errors
    /// A file whose watermarks were too late: particles of it were not let in.
    pub(crate) fn check_rest(&mut self) -> Result<(), SceneError> {
        self.streams.iter_mut().try_for_each(InletStream::check_rest)
    }

    /// Skips what a run had taken when it was saved.
    ///
    /// # Errors
    /// A source that has less, or gives particles that were not due then.
    pub(crate) fn resume(&mut self, saved: &Checkpoint) -> Result<(), SceneError> {
        let horizon = saved.state.time() + saved.state.look_ahead() + self.samples();
        for (source, &count) in saved.given.iter().enumerate().take(self.given.len()) {
            for n in 0..count {
                let item = self.fetch(source, f64::INFINITY)?;
                self.entered += u64::from(matches!(item, Some(Arrival::Enter(_))));
                let why = match item.as_ref().map(Arrival::time) {
                    None => format!("ends after {n} particles, and the saved run had taken {count}"),
                    Some(due) if due > horizon => {
                        let (number, due) = (n + 1, Shown(due));
                        format!(
                            "{count} particles had come in when the run was saved, and number {number} of these is due at {due} s, later than that"
                        )
                    }
                    Some(_) => continue,
                };
                let cure = "give the same inlet as then, from its beginning";
                return Err(SceneError::file(&format!("inlet {source}"), why, cure));
            }
            self.given[source] = count;
        }
        Ok(())
    }

    fn fetch(&mut self, source: usize, until: f64) -> Result<Option<Arrival>, SceneError> {
        let streams = self.streams.len();
        if source < streams {
            return self.streams[source].next_until(until);
        }
        let insertion = &mut self.insertions[source - streams];
        let due = insertion.next_time().is_some_and(|time| time <= until);
        if due { Ok(insertion.next_entry()?.map(|planned| Arrival::Enter(planned.entry))) } else { Ok(None) }
    }

    /// The next arrival of all sources whose time is at most `until` [s].
    ///
    /// # Errors
    /// A stream that breaks off, an insertion with a particle that does not fit into its shape.
    pub(crate) fn next_until(&mut self, until: f64) -> Result<Option<Arrival>, SceneError> {
        for source in 0..self.next.len() {
            if self.next[source].is_none() {
                self.next[source] = self.fetch(source, until)?;
            }
        }
        let due = |e: &Option<Arrival>| e.as_ref().map(Arrival::time).filter(|time| *time <= until);
        let times = self.next.iter().enumerate().filter_map(|(i, e)| due(e).map(|t| (t, i)));
        let Some((_, first)) = times.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))) else {
            return Ok(None);
        };
        self.given[first] += 1;
        self.entered += u64::from(matches!(self.next[first], Some(Arrival::Enter(_))));
        Ok(self.next[first].take())
    }
}
