//! Which frames of a run a measure sees: chosen here for all of them, and as pictures choose them.
//!
//! A measure takes every message that it is given; what it is given comes from here. So a time means the same frame everywhere, and times without a
//! frame are an error everywhere.

use crate::observer::Observer;
use crate::run::SLACK;
use crate::sheet::{Chart, Geometry, Head, Row, Summary};
use crate::{MeasureError, Run, RunMessage};
use geom::Shown;
use record::topic::PARTICLES;
use std::collections::BTreeMap;

/// Which frames are looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Which {
    /// The last one that holds grains that the measure counts; if none does, the last one.
    Last,
    /// The one nearest to a time [s], as in pictures; of two as near the earlier one.
    At(f64),
    /// All from a time to a time [s], these included.
    Between(f64, f64),
    /// All, for a measure that takes the events from a time to a time [s] by their own times.
    Events(f64, f64),
}

impl Which {
    pub const ALL: Which = Which::Between(f64::NEG_INFINITY, f64::INFINITY);

    /// What no frame is: for a message.
    fn wanted(&self) -> String {
        match self {
            Which::Between(from, until) | Which::Events(from, until) => format!("from {from} to {until} s"),
            Which::At(at) => format!("at {at} s"),
            Which::Last => "at all".to_owned(),
        }
    }
}

/// Messages of one time: a frame, its contacts, its bonds.
#[derive(Default)]
struct Moment {
    time: f64,
    /// Whether a frame is among them, and whether it holds grains that the measure counts.
    frame: Option<bool>,
    messages: Vec<RunMessage>,
}

/// What has come on a channel.
struct Seen {
    /// Times of the first and the last message [s].
    span: (f64, f64),
    /// Whether the measure was given one.
    given: bool,
}

/// A measure of chosen frames.
pub struct Selected {
    measure: Box<dyn Observer>,
    which: Which,
    /// The moment that is chosen so far, and the one that still comes.
    chosen: Option<Moment>,
    coming: Option<Moment>,
    seen: BTreeMap<&'static str, Seen>,
}

impl Selected {
    /// Gives a measure these frames. Crossings and cracks have their own times: it is given all of them.
    pub fn new(measure: Box<dyn Observer>, which: Which) -> Selected {
        Selected { measure, which, chosen: None, coming: None, seen: BTreeMap::new() }
    }

    /// The moment that has come replaces the chosen one where it fits better.
    fn choose(&mut self) {
        let Some(coming) = self.coming.take().filter(|moment| moment.frame.is_some()) else { return };
        let better = match (self.which, &self.chosen) {
            (_, None) => true,
            (Which::At(at), Some(chosen)) => (coming.time - at).abs() < (chosen.time - at).abs(),
            (_, Some(chosen)) => coming.frame == Some(true) || chosen.frame == Some(false),
        };
        if better {
            self.chosen = Some(coming);
        }
    }

    fn give(&mut self, run: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        if let Some(seen) = message.at().and_then(|(topic, _)| self.seen.get_mut(topic)) {
            seen.given = true;
        }
        self.measure.observe(run, message, rows)
    }
}

impl Observer for Selected {
    fn heads(&self) -> Vec<Head> {
        self.measure.heads()
    }

    fn observe(&mut self, run: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        let Some((topic, time)) = message.at() else { return self.measure.observe(run, message, rows) };
        self.seen.entry(topic).or_insert(Seen { span: (time, time), given: false }).span.1 = time;
        match self.which {
            Which::Between(from, until) if !run.is_between((from, until), time) => return Ok(()),
            Which::Between(..) | Which::Events(..) => return self.give(run, message, rows),
            Which::Last | Which::At(_) => {}
        }
        // The time of contacts is in nanoseconds, that of the ledger is not.
        if self.coming.as_ref().is_some_and(|moment| (moment.time - time).abs() > SLACK) {
            self.choose();
        }
        let moment = self.coming.get_or_insert_with(|| Moment { time, ..Moment::default() });
        if let RunMessage::Frame(frame) = &message {
            moment.frame = Some(self.measure.counts(run, frame));
        }
        moment.messages.push(message);
        Ok(())
    }

    fn end(&mut self, run: &Run, rows: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        self.choose();
        if let (Which::Events(from, until), Some(Seen { span: (first, last), .. })) =
            (self.which, self.seen.get(PARTICLES))
            && !(from <= *last && *first <= until)
        {
            return Err(MeasureError::NoFrame { wanted: self.which.wanted(), first: *first, last: *last });
        }
        let mut note = None;
        if let (Which::At(at), Some(Seen { span: (first, last), .. })) =
            (self.which, self.seen.get(PARTICLES))
            && !run.is_between((*first, f64::INFINITY), at)
        {
            return Err(MeasureError::NoFrame { wanted: self.which.wanted(), first: *first, last: *last });
        }
        if let Some(Moment { time, messages, .. }) = self.chosen.take() {
            if let Which::At(at) = self.which
                && !run.is_between((at, at), time)
            {
                note = Some(format!("the frame nearest to {} s is that of {} s", Shown(at), Shown(time)));
            }
            messages.into_iter().try_for_each(|message| self.give(run, message, rows))?;
        }
        match self.measure.end(run, rows) {
            // The run has the channel, but not at these times.
            Err(MeasureError::Channel { topic, .. }) if self.seen.get(topic).is_some_and(|s| !s.given) => {
                let (first, last) = self.seen[topic].span;
                Err(MeasureError::NoFrame { wanted: self.which.wanted(), first, last })
            }
            Ok(summary) => Ok(note.into_iter().fold(summary, Summary::note)),
            error => error,
        }
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        self.measure.chart(rows)
    }

    fn geometry(&self) -> Result<Geometry, &'static str> {
        self.measure.geometry()
    }
}
