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
//! Of a part of a run, grains that fall do not count: those whose downward speed is above √(2 g d), which a free fall over
//! a mean diameter d gives. So a stream that feeds the heap is no part of it.
//!
//! The axis goes through the centre of what stands above half height; where no grain is, the surface is the ground.
//! For ways to measure the angle of repose see the review of Beakawi Al-Hashemi & Baghabra Al-Amoudi (2018), Powder
//! Technology 330, DOI 10.1016/j.powtec.2018.02.003; this one is the angle of the flank of a poured heap.

mod observe;
mod overhang;
mod profiles;
mod surface;

pub use observe::Repose;
pub use surface::{Frame3, HeapSurface};

use crate::statistics::{Line, Mean, median, theil_sen};
use crate::{Frame, MeasureError};
use geom::Vec3;

const MOST_SECTORS: usize = 1000;

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
    /// Whether falling grains are left out.
    pub without_falling: bool,
}

impl Default for HeapOptions {
    fn default() -> HeapOptions {
        HeapOptions {
            up: None,
            wall: None,
            sectors: 8,
            fractions: [0.2, 0.8],
            bin: None,
            ground: None,
            without_falling: false,
        }
    }
}

impl HeapOptions {
    /// Refuses what makes no sense.
    ///
    /// # Errors
    /// Fewer than two sectors, fractions out of order, a bin not above zero, a wall that is not upright.
    pub fn check(&self) -> Result<(), MeasureError> {
        let wrong = |what, value, unit, cure| Err(MeasureError::Setting { what, value, unit, cure });
        if !(2..=MOST_SECTORS).contains(&self.sectors) {
            return wrong("sectors", self.sectors as f64, "", "give 2 to 1000: the interval is over them");
        }
        check_fractions(self.fractions)?;
        if let Some(bin) = self.bin.filter(|b| !(*b > 0.0 && b.is_finite())) {
            return wrong("bin", bin, "m", "give a length above 0");
        }
        Ok(())
    }
}

/// Refuses fractions that are no part of a length.
pub(crate) fn check_fractions([low, high]: [f64; 2]) -> Result<(), MeasureError> {
    if 0.0 <= low && low < high && high <= 1.0 {
        return Ok(());
    }
    let cure = "give two numbers from 0 to 1, the lower first";
    Err(MeasureError::Setting { what: "lower fraction", value: low, unit: "", cure })
}

/// One sector or lane.
#[derive(Debug, Clone, PartialEq)]
pub struct Flank {
    /// Azimuth of the sector's middle [rad], or position of the lane's middle [m].
    pub middle: f64,
    /// Angle [rad].
    pub angle: f64,
    /// 95 % interval of the angle [rad], by the ranks of slopes.
    pub interval: [f64; 2],
    /// Distance from the axis or the wall, and height above the ground [m], of every bin.
    pub profile: Vec<[f64; 2]>,
    /// The bins that were fitted: first, and one past the last.
    pub fitted: [usize; 2],
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
    /// Level position of the axis [m], along the first and second level direction.
    pub axis: [f64; 2],
    /// Sectors or lanes.
    pub flanks: Vec<Flank>,
    /// Share of the area over which grains stand above an empty stretch, such as those in a hopper; `None` if small.
    pub overhang: Option<f64>,
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
    let up = options.up.or(up).unwrap_or(Vec3::z());
    let axes = match options.wall {
        None => Frame3::new(up),
        Some(wall) => Frame3::towards(up, -wall).ok_or(MeasureError::Setting {
            what: "wall direction along up",
            value: up.normalize().dot(&wall),
            unit: "",
            cure: "give a wall beside the heap, not above or below it (--side and --up)",
        })?,
    };
    let overhang = overhang::overhang(frame, &axes);
    let surface = HeapSurface::new(frame, &axes, options.ground);
    let bin = surface.bin(options.bin, frame.mean_diameter())?;
    let (axis, profiles) = match options.wall {
        None => profiles::sectors(&surface, options.sectors, bin),
        Some(_) => profiles::lanes(&surface, options.sectors, bin),
    };
    let top = |profile: &Vec<[f64; 2]>| profile.iter().map(|p| p[1]).fold(0.0, f64::max);
    let mut tops: Vec<f64> = profiles.iter().map(|(_, profile)| top(profile)).collect();
    let height = median(&mut tops);
    let fit = |(k, (middle, profile)): (usize, (f64, Vec<[f64; 2]>))| {
        flank(middle, profile, height, options.fractions).map_err(|found| {
            let part = if options.wall.is_some() { "lane" } else { "sector" };
            let (time, fractions) = (frame.time, options.fractions);
            MeasureError::SmallHeap {
                time,
                part: format!("{part} {k}"),
                found,
                fractions,
                height,
                bin,
                overhang,
            }
        })
    };
    let flanks = profiles.into_iter().enumerate().map(fit).collect::<Result<Vec<_>, _>>()?;
    let angles: Vec<f64> = flanks.iter().map(|f| f.angle).collect();
    Ok(HeapAngle { time: frame.time, angle: Mean::of(&angles), height, axis, flanks, overhang })
}

/// The fitted flank; else the number of bins that were there to fit.
fn flank(middle: f64, profile: Vec<[f64; 2]>, height: f64, fractions: [f64; 2]) -> Result<Flank, usize> {
    let [low, high] = fractions.map(|f| f * height);
    let start = profile.iter().rposition(|p| p[1] >= high).unwrap_or(0);
    let below = profile[start..].iter().position(|p| p[1] < low);
    let end = start + below.unwrap_or(profile.len() - start);
    let points = &profile[start..end];
    let line = theil_sen(points).filter(|_| points.len() >= 3).ok_or(points.len())?;
    let angle = |slope: f64| libm::atan(-slope);
    let [steep, shallow] = line.interval;
    let interval = [angle(shallow), angle(steep)];
    Ok(Flank { middle, angle: angle(line.slope), interval, fitted: [start, end], line, profile })
}
