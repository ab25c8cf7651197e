//! The heap of chosen frames of a run.

use super::{Flank, HeapAngle, HeapOptions, heap_angle};
use crate::definition::{AskError, Asked, Figure, Frames, Measure, number};
use crate::observer::{Observer, OfFrame, PerFrame};
use crate::sheet::{Chart, Curve, Head, Look, Row, Summary};
use crate::{Frame, MeasureError, Run};
use geom::{Vec3, counted};

/// Measures the heap of chosen frames.
pub struct Repose {
    options: HeapOptions,
    last: Option<HeapAngle>,
    /// Frames whose heap was too small, and why.
    left_out: (u64, Option<MeasureError>),
}

impl Repose {
    /// With these options.
    ///
    /// # Errors
    /// As [`HeapOptions::check`].
    pub fn new(options: HeapOptions) -> Result<Repose, MeasureError> {
        options.check()?;
        Ok(Repose { options, last: None, left_out: (0, None) })
    }
}

/// The grains that do not fall; `None` where gravity is not known.
fn standing(run: &Run, frame: &Frame, up: Option<Vec3>) -> Option<Frame> {
    let up = up.or(run.up).unwrap_or(Vec3::z()).normalize();
    let fall = (2.0 * run.gravity * frame.mean_diameter()).sqrt();
    (fall > 0.0).then(|| frame.only(|row| frame.velocity[row].dot(&up) >= -fall))
}

impl OfFrame for Repose {
    fn heads(&self) -> Vec<Head> {
        let place = if self.options.wall.is_some() { ("across", "m") } else { ("azimuth", "deg") };
        Head::list(&[
            ("time", "s"),
            ("part", "1"),
            place,
            ("angle", "deg"),
            ("angle_low", "deg"),
            ("angle_high", "deg"),
            ("bins", "1"),
            ("fitted_from", "m"),
            ("fitted_to", "m"),
        ])
    }

    fn measure(&mut self, run: &Run, frame: &Frame) -> Result<Vec<Row>, MeasureError> {
        let standing =
            if self.options.without_falling { standing(run, frame, self.options.up) } else { None };
        let heap = match heap_angle(standing.as_ref().unwrap_or(frame), &self.options, run.up) {
            Ok(heap) => heap,
            // A heap that still grows may be measured later.
            Err(why @ (MeasureError::SmallHeap { .. } | MeasureError::NoGrains { .. })) => {
                self.left_out = (self.left_out.0 + 1, Some(why));
                return Ok(Vec::new());
            }
            Err(other) => return Err(other),
        };
        let degrees = |angle: f64| angle.to_degrees();
        let free = self.options.wall.is_none();
        let row = |(k, f): (usize, &Flank)| {
            let [start, end] = f.fitted;
            let place = if free { degrees(f.middle) } else { f.middle };
            let [low, high] = f.interval.map(degrees);
            let [from, to] = [start, end - 1].map(|k| f.profile[k][0]);
            vec![heap.time, k as f64, place, degrees(f.angle), low, high, (end - start) as f64, from, to]
        };
        let rows = heap.flanks.iter().enumerate().map(row).collect();
        self.last = Some(heap);
        Ok(rows)
    }

    fn end(&mut self) -> Result<(Vec<Row>, Summary), MeasureError> {
        let Some(heap) = &self.last else {
            let few = MeasureError::FewGrains { what: "a heap", most: 0, wanted: 1 };
            return Err(self.left_out.1.take().unwrap_or(few));
        };
        let a = &heap.angle;
        let summary = Summary::default()
            .with("angle", "deg", a.mean.to_degrees())
            .with("angle_interval", "deg", a.interval.to_degrees())
            .with("angle_deviation", "deg", a.deviation.to_degrees())
            .with("parts", "1", a.count as f64)
            .with("height", "m", heap.height)
            .with("time", "s", heap.time);
        let summary = match heap.overhang.map(|share| (100.0 * share).round()) {
            None => summary,
            Some(percent) => summary.note(format!(
                "over {percent} % of the area grains stand above a gap of more than 4 diameters and count as the \
                 surface: if they are not of the heap, measure the part below them with --within SHAPE"
            )),
        };
        let left_out = counted(self.left_out.0, "frame");
        let note = format!("{left_out} left out: no heap, or a heap that is too small");
        Ok((Vec::new(), if self.left_out.0 > 0 { summary.note(note) } else { summary }))
    }

    fn chart(&self, _: &[Row]) -> Chart {
        let Some(heap) = &self.last else { return Chart::default() };
        let profile = |(k, f): (usize, &Flank)| Curve {
            name: format!("{k}"),
            points: f.profile[..(f.fitted[1] + 4).min(f.profile.len())].to_vec(),
            look: Look::Dots,
        };
        let mut curves: Vec<Curve> = heap.flanks.iter().enumerate().map(profile).collect();
        let count = heap.flanks.len() as f64;
        let ends = [0, 1].map(|e| {
            heap.flanks
                .iter()
                .map(|f| f.profile[if e == 0 { f.fitted[0] } else { f.fitted[1] - 1 }][0])
                .sum::<f64>()
                / count
        });
        // Through the middle of the lines, with the mean slope.
        let slope = -libm::tan(heap.angle.mean);
        let centre = 0.5 * (ends[0] + ends[1]);
        let level = heap.flanks.iter().map(|f| f.line.intercept + f.line.slope * centre).sum::<f64>() / count;
        let points = ends.map(|x| [x, level + slope * (x - centre)]).to_vec();
        curves.push(Curve { name: "mean".to_owned(), points, look: Look::Dashed });
        let [mean, interval] = [heap.angle.mean, heap.angle.interval].map(f64::to_degrees);
        let from = if self.options.wall.is_some() {
            "distance from the wall [m]"
        } else {
            "distance from the axis [m]"
        };
        Chart::new(format!("Heap angle {mean:.2} ± {interval:.2} deg")).curves(
            from,
            "height above the ground [m]",
            curves,
        )
    }
}

impl Measure for Repose {
    const NAME: &'static str = "repose";
    const HELP: &'static str = "Angle of a heap, with its 95 % interval, in several directions";
    const FRAMES: Frames = Frames::Last;
    const OPTIONS: &'static [&'static str] =
        &["up", "sectors", "fractions", "bin", "ground", "side", "within"];
    const FIGURES: &'static [Figure] = &[number("heap-angle", "angle")];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        let default = HeapOptions::default();
        let options = HeapOptions {
            up: asked.up,
            wall: asked.side,
            sectors: asked.sectors.unwrap_or(default.sectors),
            fractions: asked.fractions.unwrap_or(default.fractions),
            bin: asked.bin,
            ground: asked.ground,
            without_falling: asked.within.is_some(),
        };
        let heap = PerFrame::new(Repose::new(options)?).within(asked.shape_within());
        Ok(Box::new(heap.without_fallen()))
    }
}
