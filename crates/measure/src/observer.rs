//! What all measures of a run share: they read it event by event and return rows.

use crate::{Chart, Frame, Head, MeasureError, Row, Run, RunMessage, Summary};

/// Something measured on a run while it comes.
pub trait Observer {
    /// The columns of its rows; final once the first row is there.
    fn heads(&self) -> Vec<Head>;
    /// Takes a message; adds the rows that are now final.
    ///
    /// # Errors
    /// What cannot be measured.
    fn observe(&mut self, run: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError>;
    /// The run has ended: adds the last rows and sums up.
    ///
    /// # Errors
    /// What cannot be measured, such as a channel that never came.
    fn end(&mut self, run: &Run, rows: &mut Vec<Row>) -> Result<Summary, MeasureError>;
    /// What to draw, from all rows that were given.
    fn chart(&self, rows: &[Row]) -> Chart;
}

/// Which frames are looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Which {
    /// The last one that holds grains.
    Last,
    /// The last one not after a time [s].
    At(f64),
    /// All from a time to a time [s].
    Between(f64, f64),
}

impl Which {
    /// All of them.
    pub const ALL: Which = Which::Between(f64::NEG_INFINITY, f64::INFINITY);

    /// Whether a time lies in it.
    pub fn holds(&self, time: f64) -> bool {
        match *self {
            Which::Last => true,
            Which::At(at) => time <= at + SLACK,
            Which::Between(from, until) => from - SLACK <= time && time <= until + SLACK,
        }
    }
}

/// A hair of slack [s]: times are stored in nanoseconds.
pub const SLACK: f64 = 1e-9;

/// Something measured on one frame at a time.
pub trait OfFrame {
    /// The columns of its rows.
    fn heads(&self) -> Vec<Head>;
    /// The rows of a frame.
    ///
    /// # Errors
    /// What cannot be measured.
    fn measure(&mut self, run: &Run, frame: &Frame) -> Result<Vec<Row>, MeasureError>;
    /// Last rows and sum, after all frames.
    ///
    /// # Errors
    /// What cannot be measured.
    fn end(&mut self) -> Result<(Vec<Row>, Summary), MeasureError>;
    /// What to draw, from all rows that were given.
    fn chart(&self, rows: &[Row]) -> Chart;
}

/// Measures chosen frames.
pub struct PerFrame<M> {
    measure: M,
    which: Which,
    kept: Option<Frame>,
    /// Times of the first and the last frame [s].
    span: Option<(f64, f64)>,
    measured: u64,
}

impl<M: OfFrame> PerFrame<M> {
    /// Measures the frames that are chosen.
    pub fn new(measure: M, which: Which) -> PerFrame<M> {
        PerFrame { measure, which, kept: None, span: None, measured: 0 }
    }
}

impl<M: OfFrame> Observer for PerFrame<M> {
    fn heads(&self) -> Vec<Head> {
        self.measure.heads()
    }

    fn observe(&mut self, run: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        let RunMessage::Frame(frame) = message else { return Ok(()) };
        self.span = Some((self.span.map_or(frame.time, |s| s.0), frame.time));
        if !self.which.holds(frame.time) {
            return Ok(());
        }
        if let Which::Between(..) = self.which {
            rows.extend(self.measure.measure(run, &frame)?);
            self.measured += 1;
        } else if self.which != Which::Last || !frame.is_empty() || self.kept.is_none() {
            self.kept = Some(frame);
        }
        Ok(())
    }

    fn end(&mut self, run: &Run, rows: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        let (first, last) = self.span.ok_or(NO_FRAMES)?;
        if let Some(frame) = self.kept.take() {
            rows.extend(self.measure.measure(run, &frame)?);
            self.measured += 1;
        }
        if self.measured == 0 {
            let wanted = match self.which {
                Which::Between(from, until) => format!("from {from} to {until} s"),
                Which::At(at) => format!("at or before {at} s"),
                Which::Last => "at all".to_owned(),
            };
            return Err(MeasureError::NoFrame { wanted, first, last });
        }
        let (more, summary) = self.measure.end()?;
        rows.extend(more);
        Ok(summary)
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        self.measure.chart(rows)
    }
}

/// A run without frames.
pub(crate) const NO_FRAMES: MeasureError = MeasureError::Channel {
    topic: record::topic::PARTICLES,
    what: "frames",
    cure: "give a run of dem-run that has reached its first frame",
};

/// A run without contacts.
pub(crate) const NO_CONTACTS: MeasureError = MeasureError::Channel {
    topic: record::topic::CONTACTS,
    what: "contacts",
    cure: "set [output] contacts = true",
};
