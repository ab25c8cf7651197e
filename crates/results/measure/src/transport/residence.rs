//! How long grains stay in a shape: from entering to leaving, by id.
//!
//! A centre that is outside in one frame and inside in the next entered between them, at the time that its path says
//! (see [`crate::path`]); so for leaving. A grain whose straight way between two frames goes through the shape entered and left, too, in a periodic box by
//! any number of periods. A grain that appears inside (an inlet) entered, and one that vanishes inside
//! (an outlet) left, half-way between two frames. A grain that is inside in the first frame entered before the
//! run: it is counted, and its time is not used. Grains still inside at the end are counted, too: while there are many
//! of those, the mean is too low (long stays are missing).

use crate::definition::{ArgumentKind, AskError, Asked, Frames, Measure};
use crate::observer::{NO_FRAMES, Observer};
use crate::path::{Passage, PreviousFrame, unsure_note};
use crate::periodic::PeriodicBox;
use crate::sheet::{Chart, Curve, Head, Look, Row, Summary};
use crate::statistics::{Mean, quantile};
use crate::{Frame, MeasureError, Run, RunMessage};
use geom::{Shape, Vec3};
use std::collections::HashMap;

/// Bars of the histogram.
const BARS: usize = 30;
/// Changes so near to an end of a way [–] are those of its ends.
const ENDS: f64 = 1e-9;

#[derive(Debug, Clone, Copy)]
struct Stay {
    /// When it entered [s]; `None` when before the run.
    since: Option<f64>,
    mass: f64,
}

/// Measures stays in a shape.
pub struct Residence {
    shape: Shape,
    before: PreviousFrame,
    inside: HashMap<u64, Stay>,
    stays: Vec<f64>,
    unknown: u64,
    /// Ways through periodic faces that may be wrong by a period.
    unsure: u64,
    frames: u64,
    bounds: Option<(Vec3, Vec3)>,
}

impl Residence {
    /// Nothing measured yet; frames outside of the times [s] are not looked at.
    pub fn new(shape: Shape) -> Residence {
        Residence {
            shape,
            before: PreviousFrame::default(),
            inside: HashMap::new(),
            stays: Vec::new(),
            unknown: 0,
            unsure: 0,
            frames: 0,
            bounds: None,
        }
    }

    fn frame(&mut self, frame: &Frame, rows: &mut Vec<Row>) {
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
            let is = frame.periodic.holds(&self.shape, position);
            let passage = self.before.passage(frame, row);
            self.unsure += u64::from(passage.as_ref().is_some_and(|p| !p.sure));
            let mut stay = gone.remove(id);
            let changes = match passage {
                Some(passage) => self.changes(&frame.periodic, &passage, stay.is_some(), is),
                None if stay.is_some() != is => vec![if first { None } else { middle }],
                None => Vec::new(),
            };
            for time in changes {
                stay = match stay {
                    None => {
                        let mass = frame.mass.get(row).copied().unwrap_or(f64::NAN);
                        self.unknown += u64::from(time.is_none());
                        Some(Stay { since: time, mass })
                    }
                    Some(stay) => {
                        left.push((time.unwrap_or(frame.time), *id, stay));
                        None
                    }
                };
            }
            self.inside.extend(stay.map(|stay| (*id, stay)));
        }
        let vanished = gone.into_iter().map(|(id, stay)| (middle.unwrap_or(frame.time), id, stay));
        left.extend(vanished);
        left.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (time, id, stay) in left {
            if let Some(since) = stay.since {
                self.stays.push(time - since);
                rows.push(vec![id as f64, since, time, time - since, stay.mass]);
            }
        }
        self.before.replace(frame);
    }

    /// When a grain went in or out since the frame before [s], in turns. One change is where the path says. Where the straight way goes through
    /// the shape, or leaves it and comes back, as through periodic faces, the changes are where the straight way says.
    fn changes(&self, periodic: &PeriodicBox, passage: &Passage, was: bool, is: bool) -> Vec<Option<f64>> {
        let [start, end] = passage.path.times();
        let mut pieces = periodic.inside(&self.shape, &passage.path.at(0.0), &passage.way);
        pieces.retain(|[a, b]| *b > ENDS && *a < 1.0 - ENDS);
        let [starts, stops] =
            [pieces.first().is_some_and(|p| p[0] <= ENDS), pieces.last().is_some_and(|p| p[1] >= 1.0 - ENDS)];
        let between = pieces.iter().flatten().copied().filter(|t| ENDS < *t && *t < 1.0 - ENDS);
        // An end on the surface of the shape may be on either side of it.
        let on_surface = |differs: bool, t: f64| Some(t).filter(|_| differs);
        let all =
            on_surface(was != starts, 0.0).into_iter().chain(between).chain(on_surface(is != stops, 1.0));
        let all: Vec<f64> = all.collect();
        if all.len() > 1 {
            return all.into_iter().map(|t| Some(start + t * (end - start))).collect();
        }
        if was == is {
            return Vec::new();
        }
        let holds = |x: &Vec3| periodic.holds(&self.shape, x);
        let crosses = holds(&passage.path.at(0.0)) != holds(&passage.path.at(1.0));
        let time = if crosses { passage.path.change(holds).0 } else { 0.5 * (start + end) };
        vec![Some(time)]
    }
}

impl Observer for Residence {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[("id", "1"), ("entered", "s"), ("left", "s"), ("residence", "s"), ("mass", "kg")])
    }

    fn observe(&mut self, _: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        if let RunMessage::Frame(frame) = message {
            self.frame(frame.grains(), rows);
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
        let summary = if many { summary.note(note) } else { summary };
        Ok(unsure_note(self.unsure).into_iter().fold(summary, Summary::note))
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

impl Measure for Residence {
    const NAME: &'static str = "residence";
    const HELP: &'static str = "How long grains stay in SHAPE";
    const ARGUMENT: ArgumentKind = ArgumentKind::Shape;
    const FRAMES: Frames = Frames::OverTime;

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::new(Residence::new(asked.shape()?.shape.clone())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::run_of_five;

    /// A shape of 0.02 m, across a face or not, is passed in 0.02 s, though frames are 0.06 s apart.
    #[test]
    fn grains_that_go_round_a_cell_stay_as_long_as_they_need() {
        for shape in ["box:0.04,-1,-1,0.06,1,1", "box:-0.01,-1,-1,0.01,1,1"] {
            let mut stays = Residence::new(shape.parse().unwrap());
            let mut rows = Vec::new();
            run_of_five(|run, frame| stays.observe(run, RunMessage::Frame(frame), &mut rows).unwrap());
            let summary = stays.end(&Run::default(), &mut rows).unwrap();
            assert!((20.0..=25.0).contains(&summary.get("stays").unwrap()), "{shape}: {summary:?}");
            assert!(rows.iter().all(|row| (row[3] - 0.02).abs() < 1e-9), "{shape}: {rows:?}");
        }
    }
}
