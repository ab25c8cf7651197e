//! How long grains stay in a shape: from entering to leaving, by id.
//!
//! A centre that is outside in one frame and inside in the next entered between them, at the time that its path says
//! (see [`crate::path`]); so for leaving. A grain that appears inside (an inlet) entered, and one that vanishes inside
//! (an outlet) left, half-way between two frames. A grain that is inside in the first frame entered before the
//! run: it is counted, and its time is not used. Grains still inside at the end are counted, too: while there are many
//! of those, the mean is too low (long stays are missing).

use crate::observer::{NO_FRAMES, Observer};
use crate::path::PreviousFrame;
use crate::sheet::{Chart, Curve, Head, Look, Row, Summary};
use crate::statistics::{Mean, quantile};
use crate::{Frame, MeasureError, Run, RunMessage};
use geom::Shape;
use std::collections::HashMap;

/// Bars of the histogram.
const BARS: usize = 30;

#[derive(Debug, Clone, Copy)]
struct Stay {
    /// When it entered [s]; `None` when before the run.
    since: Option<f64>,
    mass: f64,
}

/// Measures stays in a shape.
pub struct Residence {
    shape: Shape,
    between: (f64, f64),
    before: PreviousFrame,
    inside: HashMap<u64, Stay>,
    stays: Vec<f64>,
    unknown: u64,
    frames: u64,
    bounds: Option<(geom::Vec3, geom::Vec3)>,
}

impl Residence {
    /// Nothing measured yet; frames outside of the times [s] are not looked at.
    pub fn new(shape: Shape, between: (f64, f64)) -> Residence {
        Residence {
            shape,
            between,
            before: PreviousFrame::default(),
            inside: HashMap::new(),
            stays: Vec::new(),
            unknown: 0,
            frames: 0,
            bounds: None,
        }
    }

    fn frame(&mut self, run: &Run, frame: &Frame, rows: &mut Vec<Row>) {
        let first = self.frames == 0;
        self.frames += 1;
        let (low, high) = frame.bounds();
        let (l, h) = self.bounds.unwrap_or((low, high));
        self.bounds = Some((l.inf(&low), h.sup(&high)));
        let middle = self.before.time().map(|t| 0.5 * (t + frame.time));
        let mut gone = std::mem::take(&mut self.inside);
        let mut left = Vec::new();
        for (row, id) in frame.id.iter().enumerate() {
            let Some(position) = frame.position.get(row) else { continue };
            let (was, is) = (gone.remove(id), self.shape.contains(position));
            let change = || {
                let path = self.before.paths(run, frame, row);
                // Through a periodic face the two ends may be on one side: half way then.
                let crosses = |p: &crate::path::Path| {
                    self.shape.contains(&p.at(0.0)) != self.shape.contains(&p.at(1.0))
                };
                let path = path.map(|(a, b)| b.filter(crosses).unwrap_or(a)).filter(crosses);
                path.map(|p| p.change(|x| self.shape.contains(x)).0).or(middle)
            };
            match (was, is) {
                (None, true) => {
                    let mass = frame.mass.get(row).copied().unwrap_or(f64::NAN);
                    let since = if first { None } else { change() };
                    self.unknown += u64::from(since.is_none());
                    self.inside.insert(*id, Stay { since, mass });
                }
                (Some(stay), true) => {
                    self.inside.insert(*id, stay);
                }
                (Some(stay), false) => left.push((change().unwrap_or(frame.time), *id, stay)),
                (None, false) => {}
            }
        }
        let vanished = gone.into_iter().map(|(id, stay)| (middle.unwrap_or(frame.time), id, stay));
        left.extend(vanished);
        left.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (time, id, stay) in left {
            match stay.since {
                None => {}
                Some(since) => {
                    self.stays.push(time - since);
                    rows.push(vec![id as f64, since, time, time - since, stay.mass]);
                }
            }
        }
        self.before.replace(frame);
    }
}

impl Observer for Residence {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[("id", "1"), ("entered", "s"), ("left", "s"), ("residence", "s"), ("mass", "kg")])
    }

    fn observe(&mut self, run: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        if let RunMessage::Frame(frame) = message
            && run.is_between(self.between, frame.time)
        {
            self.frame(run, frame.grains(), rows);
        }
        Ok(())
    }

    fn end(&mut self, _: &Run, _: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        if self.frames < 2 {
            let what = "a residence time";
            return Err(if self.frames == 0 {
                NO_FRAMES
            } else {
                MeasureError::OneFrame { what, frames: 1 }
            });
        }
        if self.stays.is_empty() && self.inside.is_empty() && self.unknown == 0 {
            let (low, high) = self.bounds.unwrap_or_default();
            return Err(MeasureError::NothingInside { what: "grain", low: low.into(), high: high.into() });
        }
        let mean = Mean::of(&self.stays);
        let mut sorted = self.stays.clone();
        let mut at = |share| quantile(&mut sorted, share);
        let summary = Summary::default()
            .with("stays", "1", mean.count as f64)
            .with("mean", "s", mean.mean)
            .with("deviation", "s", mean.deviation)
            .with("mean_interval", "s", mean.interval)
            .with("median", "s", at(0.5))
            .with("tenth", "s", at(0.1))
            .with("nine_tenths", "s", at(0.9))
            .with("still_inside", "1", self.inside.len() as f64)
            .with("inside_from_the_start", "1", self.unknown as f64);
        let many = self.inside.len() > self.stays.len();
        let note = "more grains are still inside than have left, so the mean is too low: run longer";
        Ok(if many { summary.note(note) } else { summary })
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let stays: Vec<f64> = rows.iter().map(|row| row[3]).collect();
        let longest = stays.iter().copied().fold(0.0, f64::max);
        let width = if longest > 0.0 { longest / BARS as f64 } else { 1.0 };
        let mut bars = [0usize; BARS];
        stays.iter().for_each(|s| bars[((s / width) as usize).min(BARS - 1)] += 1);
        let mut points: Vec<[f64; 2]> =
            bars.iter().enumerate().map(|(k, n)| [k as f64 * width, *n as f64]).collect();
        points.push([BARS as f64 * width, 0.0]);
        let curve = Curve { name: String::new(), points, look: Look::Steps };
        Chart::new("Residence times").curves("residence time [s]", "grains [1]", vec![curve])
    }
}
