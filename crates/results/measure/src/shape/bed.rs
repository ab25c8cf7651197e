//! Height and slope of a bed.
//!
//! The surface is that of the heap angle (see [`crate::repose`]): the highest grain over each point of a grid of a quarter of
//! a mean diameter; cells without grains are left out. The height is the median over the ground. The slope is that of a Theil–Sen line (see
//! [`crate::statistics`]) through the medians of the surface in bins along a direction. Grains in the air affect neither.

use crate::definition::{ArgumentKind, AskError, Asked, Figure, Frames, Measure, number};
use crate::observer::{Observer, OfFrame, PerFrame};
use crate::repose::{Frame3, HeapOptions, HeapSurface, check_fractions};
use crate::sheet::{Chart, Head, Row, Summary};
use crate::statistics::{median, quantile, theil_sen};
use crate::{Frame, MeasureError, Run};
use geom::Vec3;

/// Measures the height of a bed in chosen frames.
pub struct BedHeight {
    up: Option<Vec3>,
    ground: Option<f64>,
    last: [f64; 4],
}

impl BedHeight {
    /// Along `up` (`None`: against gravity, or z) over the `ground` [m] (`None`: the lowest grains').
    pub fn new(up: Option<Vec3>, ground: Option<f64>) -> BedHeight {
        BedHeight { up, ground, last: [f64::NAN; 4] }
    }
}

impl OfFrame for BedHeight {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[("time", "s"), ("height", "m"), ("tenth", "m"), ("nine_tenths", "m")])
    }

    fn measure(&mut self, run: &Run, frame: &Frame) -> Result<Vec<Row>, MeasureError> {
        if frame.is_empty() {
            return Err(MeasureError::NoGrains { time: frame.time });
        }
        let up = self.up.or(run.up).unwrap_or(Vec3::z());
        let surface = HeapSurface::new(frame, &Frame3::new(up), self.ground);
        let mut heights: Vec<f64> = surface.points.iter().map(|p| p[2] - surface.ground).collect();
        let [height, low, high] = [0.5, 0.1, 0.9].map(|share| quantile(&mut heights, share));
        self.last = [frame.time, height, low, high];
        Ok(vec![self.last.to_vec()])
    }

    fn end(&mut self) -> Result<(Vec<Row>, Summary), MeasureError> {
        let [time, height, low, high] = self.last;
        let summary = Summary::default()
            .with("height", "m", height)
            .with("tenth", "m", low)
            .with("nine_tenths", "m", high)
            .with("time", "s", time);
        Ok((Vec::new(), summary))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let lines = [("median", 1), ("tenth", 2), ("nine tenths", 3)];
        Chart::new("Height of the bed").columns(("time [s]", 0), "height [m]", &lines, rows)
    }
}

/// Fewest bins that a line is fitted to.
const FEWEST: usize = 3;

/// How the slope of a bed is taken.
#[derive(Debug, Clone, PartialEq)]
pub struct SlopeOptions {
    /// The side to which the angle counts as downhill.
    pub side: Vec3,
    /// Up; `None`: against gravity, or z.
    pub up: Option<Vec3>,
    /// The part of the length of the bed, towards the side, whose surface is fitted.
    pub fractions: [f64; 2],
    /// Width of the bins [m]; `None`: a mean diameter.
    pub bin: Option<f64>,
}

/// Measures the angle of the surface of a bed in chosen frames.
pub struct BedSlope {
    options: SlopeOptions,
    angles: Vec<f64>,
    last: [f64; 4],
    /// Most bins of the frames that have too few.
    bins: usize,
}

impl BedSlope {
    /// With these options.
    ///
    /// # Errors
    /// Fractions out of order.
    pub fn new(options: SlopeOptions) -> Result<BedSlope, MeasureError> {
        check_fractions(options.fractions)?;
        Ok(BedSlope { options, angles: Vec::new(), last: [f64::NAN; 4], bins: 0 })
    }

    /// Place along the side and height [m] of each bin that is fitted.
    fn profile(&self, surface: &HeapSurface, bin: f64) -> Vec<[f64; 2]> {
        // Without what flies beside the bed.
        let mut along: Vec<f64> = surface.points.iter().map(|p| p[0]).collect();
        let [low, high] = [0.01, 0.99].map(|share| quantile(&mut along, share));
        let [from, to] = self.options.fractions.map(|share| low + share * (high - low));
        let mut bins: Vec<(Vec<f64>, Vec<f64>)> = vec![Default::default(); ((to - from) / bin) as usize + 1];
        for p in surface.points.iter().filter(|p| p[0] >= from && p[0] <= to) {
            let bin = &mut bins[((p[0] - from) / bin) as usize];
            bin.0.push(p[0]);
            bin.1.push(p[2]);
        }
        let filled = bins.into_iter().filter(|bin| !bin.0.is_empty());
        filled.map(|(mut at, mut heights)| [median(&mut at), median(&mut heights)]).collect()
    }
}

impl OfFrame for BedSlope {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[("time", "s"), ("angle", "deg"), ("angle_low", "deg"), ("angle_high", "deg")])
    }

    fn measure(&mut self, run: &Run, frame: &Frame) -> Result<Vec<Row>, MeasureError> {
        if frame.is_empty() {
            return Err(MeasureError::NoGrains { time: frame.time });
        }
        let up = self.options.up.or(run.up).unwrap_or(Vec3::z());
        let axes = Frame3::towards(up, self.options.side).ok_or(MeasureError::Setting {
            what: "side along up",
            value: up.normalize().dot(&self.options.side),
            unit: "",
            cure: "give a side of the bed, not above or below it (--bed-slope and --up)",
        })?;
        let surface = HeapSurface::new(frame, &axes, None);
        let bin = surface.bin(self.options.bin, frame.mean_diameter().max(surface.step))?;
        let points = self.profile(&surface, bin);
        let Some(line) = theil_sen(&points).filter(|_| points.len() >= FEWEST) else {
            self.bins = self.bins.max(points.len());
            return Ok(vec![vec![frame.time, f64::NAN, f64::NAN, f64::NAN]]);
        };
        let angle = |slope: f64| libm::atan(-slope).to_degrees();
        let [steep, shallow] = line.interval;
        self.last = [frame.time, angle(line.slope), angle(shallow), angle(steep)];
        self.angles.push(self.last[1]);
        Ok(vec![self.last.to_vec()])
    }

    fn end(&mut self) -> Result<(Vec<Row>, Summary), MeasureError> {
        let [time, angle, low, high] = self.last;
        if self.angles.is_empty() {
            let cure = "give a smaller --bin, wider --fractions, or frames with more grains";
            return Err(MeasureError::Setting {
                what: "bins with grains",
                value: self.bins as f64,
                unit: "of 3 at least",
                cure,
            });
        }
        let summary = match self.angles.len() {
            1 => Summary::default().with("angle", "deg", angle).with("angle_low", "deg", low).with(
                "angle_high",
                "deg",
                high,
            ),
            n => Summary::default()
                .with("mean_angle", "deg", self.angles.iter().sum::<f64>() / n as f64)
                .with("smallest_angle", "deg", self.angles.iter().copied().fold(f64::INFINITY, f64::min))
                .with("largest_angle", "deg", self.angles.iter().copied().fold(f64::NEG_INFINITY, f64::max))
                .with("angle", "deg", angle),
        };
        Ok((Vec::new(), summary.with("time", "s", time)))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        Chart::new("Slope of the bed").columns(("time [s]", 0), "angle [deg]", &[("angle", 1)], rows)
    }
}

impl Measure for BedHeight {
    const NAME: &'static str = "bed-height";
    const HELP: &'static str = "Height of a bed: the median of its surface";
    const FRAMES: Frames = Frames::Last;
    const OPTIONS: &'static [&'static str] = &["up", "ground", "within"];
    const FIGURES: &'static [Figure] = &[number("bed-height", "height")];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        let height = PerFrame::new(BedHeight::new(asked.up, asked.ground)).within(asked.shape_within());
        Ok(Box::new(height.without_fallen()))
    }
}

impl Measure for BedSlope {
    const NAME: &'static str = "bed-slope";
    const HELP: &'static str = "Angle of the surface of a bed, downhill to SIDE: x- x+ y- y+ z- z+";
    const ARGUMENT: ArgumentKind = ArgumentKind::Side;
    const FRAMES: Frames = Frames::Every;
    const OPTIONS: &'static [&'static str] = &["up", "fractions", "bin"];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        let fractions = asked.fractions.unwrap_or(HeapOptions::default().fractions);
        let options = SlopeOptions { side: asked.given_side()?, up: asked.up, fractions, bin: asked.bin };
        Ok(Box::new(PerFrame::new(BedSlope::new(options)?).without_fallen()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square layer of equal balls of radius r on the ground: over the rays that meet a ball the surface is r + √(r² − ρ²) high, ρ uniform
    /// in the disc, so that half of it lies above r (1 + √½).
    #[test]
    fn the_median_of_a_layer_of_balls_is_that_of_a_half_sphere() {
        let r = 0.01;
        let position = |k: i32| Vec3::new(0.0213 * f64::from(k % 40), 0.0217 * f64::from(k / 40), 0.3 + r);
        let frame = Frame {
            time: 1.0,
            id: (0..1600).collect(),
            position: (0..1600).map(position).collect(),
            radius: vec![r; 1600],
            ..Frame::default()
        };
        let mut bed = BedHeight::new(None, Some(0.3));
        let rows = bed.measure(&Run::default(), &frame).unwrap();
        let right = r * (1.0 + 0.5f64.sqrt());
        println!("{} {right}", rows[0][1]);
        assert!((rows[0][1] / right - 1.0).abs() < 0.01, "{} is not {right}", rows[0][1]);
        let empty = Frame::default();
        assert!(matches!(bed.measure(&Run::default(), &empty), Err(MeasureError::NoGrains { .. })));
    }

    /// A layer of balls on a plane of 20° that falls towards x, with every tenth ball lifted off it: the angle is that of the plane.
    #[test]
    fn the_slope_of_a_layer_is_that_of_the_plane_below_it() {
        let r = 0.005;
        let fall = 20f64.to_radians().tan();
        let position = |k: i32| {
            let (x, y) = (0.0089 * f64::from(k % 60), 0.0091 * f64::from(k / 60));
            let lifted = if k % 10 == 3 { 0.05 } else { 0.0 };
            Vec3::new(x, y, 1.0 - fall * x + lifted)
        };
        let frame = Frame {
            id: (0..1800).collect(),
            position: (0..1800).map(position).collect(),
            radius: vec![r; 1800],
            ..Frame::default()
        };
        let angle = |side: Vec3| {
            let options = SlopeOptions { side, up: None, fractions: [0.2, 0.8], bin: None };
            BedSlope::new(options)?.measure(&Run::default(), &frame).map(|rows| rows[0][1])
        };
        let [down, up, across] = [Vec3::x(), -Vec3::x(), Vec3::y()].map(|side| angle(side).unwrap());
        assert!(
            (down - 20.0).abs() < 0.3 && (up + 20.0).abs() < 0.3 && across.abs() < 0.3,
            "{down} {up} {across}"
        );
        assert!(matches!(angle(Vec3::z()), Err(MeasureError::Setting { .. })));
        // A grain far beside the bed, which makes the grid coarser.
        let mut stray = frame.clone();
        stray.id.push(1800);
        stray.position.push(Vec3::new(5.0, 0.0, 0.0));
        stray.radius.push(r);
        let options = SlopeOptions { side: Vec3::x(), up: None, fractions: [0.2, 0.8], bin: None };
        let found = BedSlope::new(options.clone()).unwrap().measure(&Run::default(), &stray).unwrap()[0][1];
        assert!((found - 20.0).abs() < 0.5, "{found}");
        let narrow = SlopeOptions { fractions: [0.49, 0.5], ..options };
        let mut few = BedSlope::new(narrow).unwrap();
        assert!(few.measure(&Run::default(), &frame).unwrap()[0][1].is_nan() && few.end().is_err());
    }
}
