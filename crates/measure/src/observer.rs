//! What all measures of a run share: they read it event by event and return rows.

use crate::{Chart, Frame, Head, MeasureError, Row, Run, RunMessage, Summary};
use geom::{Shape, Vec3};

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

    /// Whether a time of a run lies in it.
    pub fn holds(&self, run: &Run, time: f64) -> bool {
        match *self {
            Which::Last => true,
            Which::At(at) => run.is_between((f64::NEG_INFINITY, at), time),
            Which::Between(from, until) => run.is_between((from, until), time),
        }
    }

    /// The error of a run that holds none of them: its frames are from a time to a time [s].
    pub(crate) fn missing(&self, (first, last): (f64, f64)) -> MeasureError {
        let wanted = match self {
            Which::Between(from, until) => format!("from {from} to {until} s"),
            Which::At(at) => format!("at or before {at} s"),
            Which::Last => "at all".to_owned(),
        };
        MeasureError::NoFrame { wanted, first, last }
    }
}

/// A hair of slack [s]: frames have their times in nanoseconds.
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
    within: Option<Within>,
    /// How many grains have fallen past all walls and are left out, of how many; `None`: they count.
    fallen: Option<[usize; 2]>,
    kept: Option<Frame>,
    /// Times of the first and the last frame [s].
    span: Option<(f64, f64)>,
    measured: u64,
}

impl<M: OfFrame> PerFrame<M> {
    /// Measures the frames that are chosen.
    pub fn new(measure: M, which: Which) -> PerFrame<M> {
        PerFrame { measure, which, within: None, fallen: None, kept: None, span: None, measured: 0 }
    }

    /// Only the grains whose centres a shape holds; `None`: all.
    pub fn within(mut self, shape: Option<Shape>) -> PerFrame<M> {
        self.within = shape.map(Within::new);
        self
    }

    /// Without grains that have fallen past all walls, and fall on: they belong to nothing that has a surface.
    pub fn without_fallen(mut self) -> PerFrame<M> {
        self.fallen = Some([0; 2]);
        self
    }
}

/// The part of a run that is measured.
struct Within {
    shape: Shape,
    /// Whether a frame had a grain in it.
    found: bool,
    /// Corners of the box around the centres of all grains [m].
    bounds: (Vec3, Vec3),
}

impl Within {
    fn new(shape: Shape) -> Within {
        let none = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
        Within { shape, found: false, bounds: none }
    }

    fn of(&mut self, frame: &Frame) -> Frame {
        let inside = frame.only(|row| frame.periodic.holds(&self.shape, &frame.position[row]));
        self.found |= !inside.is_empty();
        let (low, high) = self.bounds;
        self.bounds = frame.position.iter().fold((low, high), |(low, high), p| (low.inf(p), high.sup(p)));
        inside
    }

    /// An error if grains were there and none of them in the shape.
    fn check(&self) -> Result<(), MeasureError> {
        let (low, high) = self.bounds;
        if self.found || !low.x.is_finite() {
            return Ok(());
        }
        Err(MeasureError::NothingInside { what: "grain", low: low.into(), high: high.into() })
    }
}

impl<M: OfFrame> Observer for PerFrame<M> {
    fn heads(&self) -> Vec<Head> {
        self.measure.heads()
    }

    fn observe(&mut self, run: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        let RunMessage::Frame(frame) = message else { return Ok(()) };
        self.span = Some((self.span.map_or(frame.time, |s| s.0), frame.time));
        if !self.which.holds(run, frame.time) {
            return Ok(());
        }
        let frame = match (&mut self.fallen, run.walls_end) {
            (Some(fallen), Some((down, depth))) => {
                let there = |row: usize| frame.position[row].dot(&down) - frame.radius[row] <= depth;
                let rest = frame.only(there);
                if !frame.is_empty() {
                    *fallen = [frame.len() - rest.len(), frame.len()];
                }
                rest
            }
            _ => frame,
        };
        let frame = match &mut self.within {
            Some(within) => within.of(&frame),
            None => frame,
        };
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
        self.within.as_ref().map_or(Ok(()), Within::check)?;
        if let Some(frame) = self.kept.take() {
            rows.extend(self.measure.measure(run, &frame)?);
            self.measured += 1;
        }
        if self.measured == 0 {
            return Err(self.which.missing((first, last)));
        }
        let (more, summary) = self.measure.end()?;
        rows.extend(more);
        Ok(match self.fallen {
            Some([fallen, of]) if fallen > 0 => {
                summary.note(format!("{fallen} of {of} grains have fallen past all walls and are left out"))
            }
            _ => summary,
        })
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
