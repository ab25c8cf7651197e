//! Mass and number of grains that pass a plane, over time.
//!
//! If an outlet of the run lies in the plane, its recorded crossings are counted, exact in time. Otherwise a grain passes
//! when its centre is on the other side in the next frame; when and where follows from its path between the frames
//! (see [`crate::path`]). Grains that come or go between two frames (inlets, outlets) cannot be judged there: those that
//! would have passed the plane at constant velocity are counted as `unjudged`. In a periodic box a grain passes the plane as often as its way does, by
//! any number of periods.

mod span;

pub use span::{PlaneCrossing, Span};

use crate::definition::{ArgumentKind, AskError, Asked, Figure, Frames, Measure, number};
use crate::observer::{NO_FRAMES, Observer};
use crate::path::{PreviousFrame, unsure_note};
use crate::run::SLACK;
use crate::sheet::{Chart, Head, Row, Summary};
use crate::statistics::Mean;
use crate::{Frame, MeasureError, Run, RunMessage};
use geom::{Plane, Shape, Shown, Vec3, counted};
use std::collections::VecDeque;

/// Most spans of a run: each is a row.
const MOST_SPANS: f64 = 1e6;

/// What the options ask for.
#[derive(Debug, Clone)]
pub struct FlowOptions {
    /// The plane; its normal is the direction of flow.
    pub plane: Plane,
    /// Count only what passes inside this shape.
    pub within: Option<Shape>,
    /// Length of the spans [s]; `None`: from frame to frame.
    pub span: Option<f64>,
    /// Start and end [s].
    pub between: (f64, f64),
}

/// Counts grains through a plane.
pub struct Flow {
    options: FlowOptions,
    /// The outlet in the plane and whether its normal is the plane's; known once the first frame is there.
    outlet: Option<(usize, bool)>,
    before: PreviousFrame,
    passes: VecDeque<PlaneCrossing>,
    /// Where the open span starts [s].
    start: Option<f64>,
    /// Number of the open span, of those of equal length.
    number: u64,
    /// How far spans may be closed [s].
    until: f64,
    frames: u64,
    /// Least and largest distance of grains from the plane [m].
    reach: (f64, f64),
    total: Span,
    flows: Vec<f64>,
    unjudged: u64,
    /// Ways through periodic faces that may be wrong by a period.
    unsure: u64,
}

impl Flow {
    /// Nothing counted yet.
    ///
    /// # Errors
    /// Spans that are not above zero.
    pub fn new(options: FlowOptions) -> Result<Flow, MeasureError> {
        if let Some(value) = options.span.filter(|s| !(*s > 0.0 && s.is_finite())) {
            let cure = "give a time above 0";
            return Err(MeasureError::Setting { what: "span", value, unit: "s", cure });
        }
        Ok(Flow {
            options,
            outlet: None,
            before: PreviousFrame::default(),
            passes: VecDeque::new(),
            start: None,
            number: 0,
            until: f64::NAN,
            frames: 0,
            reach: (f64::INFINITY, f64::NEG_INFINITY),
            total: Span::default(),
            flows: Vec::new(),
            unjudged: 0,
            unsure: 0,
        })
    }

    /// The outlet that lies in the plane, and whether its normal points the same way.
    fn outlet_of(&self, run: &Run) -> Option<(usize, bool)> {
        let plane = &self.options.plane;
        let same = |other: &Plane| {
            let size = plane.point.amax().max(other.point.amax()).max(1.0);
            plane.normal.cross(&other.normal).norm() < 1e-6
                && plane.signed_distance(&other.point).abs() < 1e-6 * size
        };
        let found = run.outlets.iter().position(same)?;
        Some((found, run.outlets[found].normal.dot(&plane.normal) > 0.0))
    }

    fn wanted(&self, run: &Run, position: &Vec3) -> bool {
        self.options.within.as_ref().is_none_or(|shape| run.holds(shape, position))
    }

    fn add(&mut self, time: f64, forward: bool, mass: f64) {
        let (from, until) = self.options.between;
        if from <= time && time < until {
            self.passes.push_back(PlaneCrossing { time, forward, mass });
        }
    }

    fn compare(&mut self, run: &Run, frame: &Frame) -> Result<(), MeasureError> {
        let masses = frame.masses()?;
        let plane = self.options.plane;
        let beyond = |p: &Vec3| plane.signed_distance(p) >= 0.0;
        let length = frame.time - self.before.time().unwrap_or(frame.time);
        let passing = |(x, v): &(Vec3, Vec3)| beyond(x) != beyond(&(x + v * length));
        self.unjudged += self.before.vanished(frame).filter(passing).count() as u64;
        let mut found = Vec::new();
        for (row, mass) in masses.iter().enumerate() {
            let Some(passage) = self.before.passage(frame, row) else {
                let position = frame.position[row];
                self.unjudged +=
                    u64::from(beyond(&position) != beyond(&(position - frame.velocity[row] * length)));
                continue;
            };
            self.unsure += u64::from(!passage.sure);
            let passed = passage.through(&plane).into_iter();
            let wanted = passed.filter(|(_, position, _)| self.wanted(run, position));
            found.extend(wanted.map(|(time, _, along)| (time, along, *mass)));
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.into_iter().for_each(|(time, forward, mass)| self.add(time, forward, mass));
        Ok(())
    }

    fn frame(&mut self, run: &Run, frame: &Frame, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        if self.frames == 0 {
            self.outlet = self.outlet_of(run);
            self.start = Some(frame.time.max(self.options.between.0));
        }
        self.frames += 1;
        for p in &frame.position {
            let s = self.options.plane.signed_distance(p);
            self.reach = (self.reach.0.min(s), self.reach.1.max(s));
        }
        if self.outlet.is_none() {
            if self.before.time().is_some() {
                self.compare(run, frame)?;
            }
            self.before.replace(frame);
        }
        self.close(frame.time.min(self.options.between.1), rows)
    }

    /// Rows of the spans that end at or before a time [s].
    fn close(&mut self, time: f64, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        self.until = time;
        let Some(origin) = self.start else { return Ok(()) };
        let length = time + SLACK - origin;
        if let Some(span) = self.options.span.filter(|span| length / span > MOST_SPANS) {
            return Err(MeasureError::Spans { span, length, most: MOST_SPANS });
        }
        match self.options.span {
            None if time > origin + SLACK => {
                self.row(origin, time, rows);
                self.start = Some(time);
            }
            None => {}
            Some(length) => loop {
                let [from, to] = [self.number, self.number + 1].map(|k| origin + k as f64 * length);
                if to > time + SLACK {
                    break;
                }
                self.row(from, to, rows);
                self.number += 1;
            },
        }
        Ok(())
    }

    fn row(&mut self, from: f64, to: f64, rows: &mut Vec<Row>) {
        let mut span = Span { from, to, ..Span::default() };
        while let Some(pass) = self.passes.front().filter(|pass| pass.time <= to) {
            span.add(pass);
            self.total.add(pass);
            self.passes.pop_front();
        }
        self.total.from = if self.flows.is_empty() { from } else { self.total.from };
        self.total.to = to;
        self.flows.push(span.mass_flow());
        let [there, back] = span.count.map(|n| n as f64);
        let sum = self.total.mass[0] - self.total.mass[1];
        rows.push(vec![
            from,
            to,
            there,
            back,
            span.mass[0],
            span.mass[1],
            span.mass_flow(),
            span.number_flow(),
            sum,
        ]);
    }
}

impl Observer for Flow {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[
            ("from", "s"),
            ("to", "s"),
            ("forward", "1"),
            ("backward", "1"),
            ("mass_forward", "kg"),
            ("mass_backward", "kg"),
            ("mass_flow", "kg/s"),
            ("number_flow", "1/s"),
            ("mass_sum", "kg"),
        ])
    }

    fn observe(&mut self, run: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        match message {
            RunMessage::Frame(frame) => self.frame(run, frame.grains(), rows)?,
            RunMessage::Crossings(crossings) => {
                if let Some((outlet, along)) = self.outlet_of(run) {
                    let own =
                        crossings.iter().filter(|p| p.outlet == outlet && self.wanted(run, &p.position));
                    for p in own.copied().collect::<Vec<_>>() {
                        if p.mass.is_nan() {
                            return Err(MeasureError::Density { index: p.material });
                        }
                        self.add(p.time, along, p.mass);
                    }
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn end(&mut self, _: &Run, _: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        if self.frames < 2 {
            let one = MeasureError::OneFrame { what: "a flow between frames", frames: 1 };
            return Err(if self.frames == 0 { NO_FRAMES } else { one });
        }
        if let (Some(span), Some(start), 0) = (self.options.span, self.start, self.number) {
            return Err(MeasureError::LongSpan { span, length: self.until - start });
        }
        let (low, high) = self.reach;
        let unreached = self.total.count == [0, 0] && (low >= 0.0 || high < 0.0) && self.outlet.is_none();
        let t = &self.total;
        let flow = Mean::of(&self.flows);
        let summary = Summary::default()
            .with("mass_flow", "kg/s", t.mass_flow())
            .with("mass_flow_deviation", "kg/s", flow.deviation)
            .with("number_flow", "1/s", t.number_flow())
            .with("forward", "1", t.count[0] as f64)
            .with("backward", "1", t.count[1] as f64)
            .with("mass", "kg", t.mass[0] - t.mass[1])
            .with("from", "s", t.from)
            .with("to", "s", t.to)
            .with("unjudged", "1", self.unjudged as f64)
            .note(if self.outlet.is_some() { "from recorded crossings" } else { "from frames, by id" });
        let unjudged = format!(
            "{} near the plane vanished or appeared between frames, and the flow leaves this out: set [output] every to \
             less, or measure at the outlet's own plane",
            counted(self.unjudged, "grain")
        );
        let away = format!(
            "no grain comes to the plane: they are from {} to {} m from it along its normal",
            Shown(low),
            Shown(high)
        );
        let summary = if unreached { summary.note(away) } else { summary };
        let summary = if self.unjudged > 0 { summary.note(unjudged) } else { summary };
        Ok(unsure_note(self.unsure).into_iter().fold(summary, Summary::note))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        Chart::new("Flow through the plane")
            .columns(("time [s]", 1), "mass flow [kg/s]", &[("", 6)], rows)
            .columns(("time [s]", 1), "mass passed [kg]", &[("", 8)], rows)
    }
}

impl Measure for Flow {
    const NAME: &'static str = "flow";
    const HELP: &'static str = "Mass and number of grains through PLANE over time";
    const ARGUMENT: ArgumentKind = ArgumentKind::Plane;
    const FRAMES: Frames = Frames::Events;
    const OPTIONS: &'static [&'static str] = &["within", "span"];
    const FIGURES: &'static [Figure] = &[number("discharge-rate", "mass_flow")];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        let (plane, within) = (asked.plane()?, asked.shape_within());
        Ok(Box::new(Flow::new(FlowOptions { plane, within, span: asked.span, between: asked.between })?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::run_of_five;

    /// Each passes x = 0.05 m once a period, in the direction in which it moves.
    #[test]
    fn grains_that_go_round_a_cell_pass_a_plane_each_time() {
        let plane = Plane::new(Vec3::new(0.05, 0.0, 0.0), Vec3::x()).unwrap();
        let between = (f64::NEG_INFINITY, f64::INFINITY);
        let mut flow = Flow::new(FlowOptions { plane, within: None, span: None, between }).unwrap();
        let mut rows = Vec::new();
        run_of_five(|run, frame| flow.observe(run, RunMessage::Frame(frame), &mut rows).unwrap());
        let summary = flow.end(&Run::default(), &mut rows).unwrap();
        // In 0.48 s each goes 4.8 periods: those within 0.08 m before the plane pass it five times.
        let right: f64 = [0.01, 0.03, 0.055, 0.07, 0.09]
            .map(|x: f64| ((x + 0.48 - 0.05) / 0.1).floor() - ((x - 0.05) / 0.1).floor())
            .iter()
            .sum();
        assert_eq!([summary.get("forward"), summary.get("backward")], [Some(right), Some(0.0)]);
        assert!((summary.get("mass_flow").unwrap() - 2.0 * right / 0.48).abs() < 1e-9);
        assert!(!summary.notes.iter().any(|note| note.contains("period")), "{:?}", summary.notes);
    }
}
