//! What all measures of a run share: they read it event by event and return rows.

use crate::{Chart, Frame, Geometry, Head, MeasureError, Row, Run, RunMessage, Summary};
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
    /// What it has measured, as geometry: after [`Observer::end`].
    ///
    /// # Errors
    /// It has none; why, and what to do.
    fn geometry(&self) -> Result<Geometry, &'static str> {
        Err("only --wear has a geometry: name the output .csv")
    }
    /// Whether a frame holds grains that it counts: the last of those is the last frame.
    fn counts(&self, _: &Run, frame: &Frame) -> bool {
        !frame.is_empty()
    }
}

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

/// Measures each frame that it is given.
pub struct PerFrame<M> {
    measure: M,
    within: Option<Within>,
    /// How many grains have fallen past all walls and are left out, of how many; `None`: they count.
    fallen: Option<[usize; 2]>,
    /// Frames that were given, and those of them that were measured.
    frames: [u64; 2],
    /// Why a frame without grains was not measured.
    empty: Option<MeasureError>,
}

impl<M: OfFrame> PerFrame<M> {
    /// Measures all frames; [`crate::Selected`] chooses them. One without grains has a row without numbers, if others have grains.
    pub fn new(measure: M) -> PerFrame<M> {
        PerFrame { measure, within: None, fallen: None, frames: [0; 2], empty: None }
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
    fn counts(&self, run: &Run, frame: &Frame) -> bool {
        let held = |row: usize| {
            let at = &frame.position[row];
            self.within.as_ref().is_none_or(|within| frame.periodic.holds(&within.shape, at))
                && (self.fallen.is_none() || !has_fallen(run, frame, row))
        };
        (0..frame.len()).any(held)
    }

    fn heads(&self) -> Vec<Head> {
        self.measure.heads()
    }

    fn observe(&mut self, run: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        let RunMessage::Frame(frame) = message else { return Ok(()) };
        self.frames[0] += 1;
        let frame = match &mut self.fallen {
            Some(fallen) if run.walls_end.is_some() => {
                let rest = frame.only(|row| !has_fallen(run, &frame, row));
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
        match self.measure.measure(run, &frame) {
            Ok(found) => rows.extend(found),
            Err(why @ MeasureError::NoGrains { .. }) => {
                rows.push(undefined(&self.measure.heads(), frame.time));
                self.empty = Some(why);
                return Ok(());
            }
            Err(other) => return Err(other),
        }
        self.frames[1] += 1;
        Ok(())
    }

    fn end(&mut self, _: &Run, rows: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        let [frames, measured] = self.frames;
        if frames == 0 {
            return Err(NO_FRAMES);
        }
        self.within.as_ref().map_or(Ok(()), Within::check)?;
        if measured == 0 {
            return Err(self.empty.take().unwrap_or(NO_FRAMES));
        }
        let (more, summary) = self.measure.end()?;
        rows.extend(more);
        let empty = geom::counted(frames - measured, "frame");
        let note = format!("{empty} without grains: empty cells");
        let summary = if measured < frames { summary.note(note) } else { summary };
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

/// Whether a grain has fallen past all walls.
fn has_fallen(run: &Run, frame: &Frame, row: usize) -> bool {
    run.walls_end.is_some_and(|end| end.is_past(&frame.position[row], frame.radius[row]))
}

/// A row at a time [s] in which nothing else is defined.
pub(crate) fn undefined(heads: &[Head], time: f64) -> Row {
    let cell = |head: &Head| if head.name == "time" { time } else { f64::NAN };
    heads.iter().map(cell).collect()
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
