//! Angle of a heap, in several directions.
//!
//! 1. The surface: the highest grain over each point of a grid of a quarter of a mean diameter.
//! 2. It is cut into sectors around the heap's axis or, for a heap that leans on a wall, into lanes that run away from
//!    the wall. In each, the median height over bins of distance is a profile: grains in the air do not move it.
//! 3. Of the profile, the bins from the last one above the upper fraction of the heap's height down to the first one
//!    below the lower fraction (0.8 and 0.2; without the rounded top and the thin foot) get a Theil–Sen line, whose
//!    slope is robust against outliers; see [`crate::statistics`] for the source and for the interval of each slope.
//! 4. The angle is the mean over the sectors, its 95 % interval ± t s/√n with the deviation s between them.
//!
//! The axis goes through the centre of what stands above half height; where no grain is, the surface is the ground.
//! A line through the middle part of the flank is what Beakawi Al-Hashemi & Baghabra Al-Amoudi (2018), Powder
//! Technology 330, DOI 10.1016/j.powtec.2018.02.003, review as the usual definition for heaps.

mod surface;

pub use surface::{Frame3, Surface};

use crate::observer::OfFrame;
use crate::sheet::{Chart, Curve, Head, Look, Row, Summary};
use crate::statistics::{Line, Mean, median, theil_sen};
use crate::{Frame, MeasureError, Run};
use geom::Vec3;
use std::f64::consts::PI;

/// How the angle is taken.
#[derive(Debug, Clone, PartialEq)]
pub struct HeapOptions {
    /// Up; `None`: against gravity, or z.
    pub up: Option<Vec3>,
    /// Direction from the heap to the wall that it leans on; `None`: a free heap.
    pub wall: Option<Vec3>,
    /// Number of sectors, or lanes.
    pub sectors: usize,
    /// Lower and upper fraction of the height between which the flank is fitted.
    pub fractions: [f64; 2],
    /// Width of the profile's bins [m]; `None`: a mean diameter.
    pub bin: Option<f64>,
    /// Height of the ground along `up` [m]; `None`: the lowest grains'.
    pub ground: Option<f64>,
}

impl Default for HeapOptions {
    fn default() -> HeapOptions {
        HeapOptions { up: None, wall: None, sectors: 8, fractions: [0.2, 0.8], bin: None, ground: None }
    }
}

impl HeapOptions {
    /// Refuses what makes no sense.
    ///
    /// # Errors
    /// Fewer than two sectors, fractions out of order, a bin not above zero, a wall that is not upright.
    pub fn check(&self) -> Result<(), MeasureError> {
        let wrong = |what, value, unit, cure| Err(MeasureError::Setting { what, value, unit, cure });
        let [low, high] = self.fractions;
        if self.sectors < 2 {
            return wrong("sectors", self.sectors as f64, "", "give at least 2, the interval is over them");
        }
        if !(0.0 <= low && low < high && high <= 1.0) {
            return wrong("lower fraction", low, "", "give two numbers from 0 to 1, the lower first");
        }
        if let Some(bin) = self.bin.filter(|b| !(*b > 0.0 && b.is_finite())) {
            return wrong("bin", bin, "m", "give a length above 0");
        }
        Ok(())
    }
}

/// One sector or lane.
#[derive(Debug, Clone, PartialEq)]
pub struct Flank {
    /// Azimuth of the sector's middle [rad], or place of the lane's middle [m].
    pub place: f64,
    /// Angle [rad].
    pub angle: f64,
    /// 95 % interval of the angle [rad], by the ranks of slopes.
    pub interval: [f64; 2],
    /// Distance from the axis or the wall, and height above the ground [m], of every bin.
    pub profile: Vec<[f64; 2]>,
    /// The bins that were fitted: first, and one past the last.
    pub fitted: [usize; 2],
    /// The line.
    pub line: Line,
}

/// The angle of a heap.
#[derive(Debug, Clone, PartialEq)]
pub struct HeapAngle {
    /// Time [s].
    pub time: f64,
    /// Mean over the flanks and its 95 % interval [rad].
    pub angle: Mean,
    /// Height above the ground [m].
    pub height: f64,
    /// Level place of the axis [m], along the first and second level direction.
    pub axis: [f64; 2],
    /// Sectors or lanes.
    pub flanks: Vec<Flank>,
}

/// The angle of the heap in a frame; `up` is used where the options name none.
///
/// # Errors
/// No grains, a wall that is not upright, a heap too small for its bins.
pub fn heap_angle(frame: &Frame, options: &HeapOptions, up: Option<Vec3>) -> Result<HeapAngle, MeasureError> {
    options.check()?;
    if frame.is_empty() {
        return Err(MeasureError::NoGrains { time: frame.time });
    }
    let mut axes = Frame3::new(options.up.or(up).unwrap_or(Vec3::z()));
    if let Some(wall) = options.wall {
        let level = wall - axes.up * axes.up.dot(&wall);
        if level.norm() < 0.5 * wall.norm() || level.norm() == 0.0 {
            let cure = "give a wall beside the heap, not above or below it (--side and --up)";
            return Err(MeasureError::Setting {
                what: "wall direction along up",
                value: axes.up.dot(&wall),
                unit: "",
                cure,
            });
        }
        axes.u = -level.normalize();
        axes.v = axes.up.cross(&axes.u);
    }
    let surface = Surface::new(frame, &axes, options.ground);
    let bin = options.bin.unwrap_or(frame.mean_diameter());
    let (axis, profiles) = match options.wall {
        None => sectors(&surface, options.sectors, bin),
        Some(_) => lanes(&surface, options.sectors, bin),
    };
    let top = |profile: &Vec<[f64; 2]>| profile.iter().map(|p| p[1]).fold(0.0, f64::max);
    let mut tops: Vec<f64> = profiles.iter().map(|(_, profile)| top(profile)).collect();
    let height = median(&mut tops);
    let fit = |(k, (place, profile)): (usize, (f64, Vec<[f64; 2]>))| {
        flank(place, profile, height, options.fractions).map_err(|found| {
            let part = if options.wall.is_some() { "lane" } else { "sector" };
            let (time, fractions) = (frame.time, options.fractions);
            MeasureError::SmallHeap { time, part: format!("{part} {k}"), found, fractions, height, bin }
        })
    };
    let flanks = profiles.into_iter().enumerate().map(fit).collect::<Result<Vec<_>, _>>()?;
    let angles: Vec<f64> = flanks.iter().map(|f| f.angle).collect();
    Ok(HeapAngle { time: frame.time, angle: Mean::of(&angles), height, axis, flanks })
}

type Profiles = Vec<(f64, Vec<[f64; 2]>)>;

fn sectors(surface: &Surface, count: usize, bin: f64) -> ([f64; 2], Profiles) {
    let middle = surface.middle();
    let turn = 2.0 * PI / count as f64;
    let of = |[x, y, _]: [f64; 3]| {
        let (x, y) = (x - middle[0], y - middle[1]);
        let azimuth = libm::atan2(y, x).rem_euclid(2.0 * PI);
        (((azimuth / turn) as usize).min(count - 1), (x * x + y * y).sqrt())
    };
    (middle, profiles(surface, count, bin, of, |k| (k as f64 + 0.5) * turn))
}

fn lanes(surface: &Surface, count: usize, bin: f64) -> ([f64; 2], Profiles) {
    let (low, rays) = surface.grid;
    let width = rays[1] as f64 * surface.step / count as f64;
    let of = |[x, y, _]: [f64; 3]| ((((y - low[1]) / width) as usize).min(count - 1), x - low[0]);
    let middle = low[1] + 0.5 * width * count as f64;
    ([low[0], middle], profiles(surface, count, bin, of, |k| low[1] + (k as f64 + 0.5) * width))
}

/// Median heights of the bins of each part; `of` gives a point's part and distance.
fn profiles(
    surface: &Surface,
    count: usize,
    bin: f64,
    of: impl Fn([f64; 3]) -> (usize, f64),
    place: impl Fn(usize) -> f64,
) -> Profiles {
    let mut bins: Vec<Vec<(Vec<f64>, Vec<f64>)>> = vec![Vec::new(); count];
    let mut put = |point: [f64; 3], height: f64| {
        let (part, distance) = of(point);
        let bins = &mut bins[part];
        let k = (distance / bin) as usize;
        if bins.len() <= k {
            bins.resize(k + 1, Default::default());
        }
        bins[k].0.push(distance);
        bins[k].1.push(height);
    };
    let (low, rays) = surface.grid;
    let mut covered = vec![false; rays[0] * rays[1]];
    for p in &surface.points {
        let [i, j] = [0, 1].map(|k| libm::round((p[k] - low[k]) / surface.step) as usize);
        covered[j * rays[0] + i] = true;
        put(*p, (p[2] - surface.ground).max(0.0));
    }
    for (k, _) in covered.iter().enumerate().filter(|(_, covered)| !**covered) {
        let [i, j] = [k % rays[0], k / rays[0]].map(|n| n as f64);
        put([low[0] + i * surface.step, low[1] + j * surface.step, 0.0], 0.0);
    }
    let middle = |(mut at, mut heights): (Vec<f64>, Vec<f64>)| [median(&mut at), median(&mut heights)];
    let filled = |bins: Vec<(Vec<f64>, Vec<f64>)>| {
        bins.into_iter().filter(|b| !b.0.is_empty()).map(middle).collect::<Vec<_>>()
    };
    bins.into_iter().enumerate().map(|(k, bins)| (place(k), filled(bins))).collect()
}

/// The fitted flank; else the number of bins that were there to fit.
fn flank(place: f64, profile: Vec<[f64; 2]>, height: f64, fractions: [f64; 2]) -> Result<Flank, usize> {
    let [low, high] = fractions.map(|f| f * height);
    let start = profile.iter().rposition(|p| p[1] >= high).unwrap_or(0);
    let below = profile[start..].iter().position(|p| p[1] < low);
    let end = start + below.unwrap_or(profile.len() - start);
    let points = &profile[start..end];
    let line = theil_sen(points).filter(|_| points.len() >= 3).ok_or(points.len())?;
    let angle = |slope: f64| libm::atan(-slope);
    let [steep, shallow] = line.interval;
    let interval = [angle(shallow), angle(steep)];
    Ok(Flank { place, angle: angle(line.slope), interval, fitted: [start, end], line, profile })
}

/// Measures the heap of chosen frames.
pub struct Repose {
    options: HeapOptions,
    last: Option<HeapAngle>,
}

impl Repose {
    /// With these options.
    ///
    /// # Errors
    /// As [`HeapOptions::check`].
    pub fn new(options: HeapOptions) -> Result<Repose, MeasureError> {
        options.check()?;
        Ok(Repose { options, last: None })
    }
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
        let heap = heap_angle(frame, &self.options, run.up)?;
        let degrees = |angle: f64| angle.to_degrees();
        let free = self.options.wall.is_none();
        let row = |(k, f): (usize, &Flank)| {
            let [start, end] = f.fitted;
            let place = if free { degrees(f.place) } else { f.place };
            let [low, high] = f.interval.map(degrees);
            let [from, to] = [start, end - 1].map(|k| f.profile[k][0]);
            vec![heap.time, k as f64, place, degrees(f.angle), low, high, (end - start) as f64, from, to]
        };
        let rows = heap.flanks.iter().enumerate().map(row).collect();
        self.last = Some(heap);
        Ok(rows)
    }

    fn end(&mut self) -> Result<(Vec<Row>, Summary), MeasureError> {
        let Some(heap) = &self.last else { return Ok(Default::default()) };
        let a = &heap.angle;
        let summary = Summary::default()
            .with("angle", "deg", a.mean.to_degrees())
            .with("angle_interval", "deg", a.interval.to_degrees())
            .with("angle_deviation", "deg", a.deviation.to_degrees())
            .with("parts", "1", a.count as f64)
            .with("height", "m", heap.height)
            .with("time", "s", heap.time);
        Ok((Vec::new(), summary))
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
