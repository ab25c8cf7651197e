//! Finds the spacing that gives the requested count or density.

use crate::beside::{Thrown, complete};
use crate::cells::Cells;
use crate::crowding::uncrowded;
use crate::lattice::lattice;
use crate::poisson::poisson;
use crate::tile::tiled;
use crate::{Amount, Method, Sample, SampleError, SampleSettings};
use geom::Vec3;

/// A count is met within this share.
const COUNT_WITHIN: f64 = 0.005;
const MOST_TRIES: usize = 40;
/// Kept points per area of a maximal sample of a dense cloud, times the spacing squared [–]; measured.
const PACKING: f64 = 0.7;
/// Local density is counted in a disk of this many spacings.
const DENSITY_DISK: f64 = 3.0;
/// Median distance of nearest points over the spacing above which the spacing says nothing about them [–].
const SPARSE: f64 = 1.5;

/// Counts below this are met exactly: there one point is half a percent.
const FEW: usize = 200;

/// Sample of the given amount by disks, or by a grid.
pub(crate) fn sample_of(
    points: &[Vec3],
    forced: Option<&[bool]>,
    settings: &SampleSettings,
) -> Result<Sample, SampleError> {
    let throw = |cells: &Cells, spacing: f64| match settings.method {
        Method::Grid => Thrown { kept: lattice(points, forced, spacing), beside: 0 },
        Method::Tile => {
            let kept = tiled(points, cells, spacing, settings.seed, forced);
            complete(cells, spacing, settings.seed, kept, settings.distance)
        }
        _ => complete(
            cells,
            spacing,
            settings.seed,
            poisson(cells, spacing, settings.seed, forced),
            settings.distance,
        ),
    };
    match settings.amount {
        Amount::Spacing(spacing) => Ok(throw(&Cells::new(points, spacing), spacing).into_sample(spacing, 1)),
        Amount::Count(count) => by_count(points, forced, count, settings.method != Method::Grid, throw),
        Amount::Density(low, high) => Ok(by_density(points, low, high, throw)),
    }
}

/// Secant on log(count) against log(spacing), kept inside a bracket. A small count is met exactly (`exactly`): of a sample that
/// has a point or two too many, the most crowded go.
fn by_count(
    points: &[Vec3],
    forced: Option<&[bool]>,
    count: usize,
    exactly: bool,
    throw: impl Fn(&Cells, f64) -> Thrown,
) -> Result<Sample, SampleError> {
    let must = forced.map_or(0, |f| f.iter().filter(|&&f| f).count());
    if must > count {
        return Err(SampleError::TooManyForced { forced: must, count });
    }
    let (mut cells, mut spacing) = first_guess(points, count);
    // A small count aims a little above itself: what is too many can go, what is missing cannot come.
    let aim = if exactly && count < FEW { 0.5 / count as f64 } else { 0.0 };
    let mut secant = Secant { low: f64::NEG_INFINITY, high: f64::INFINITY, last: None, aim };
    let goal = (count as f64).ln();
    let mut tried = Tried::default();
    for tries in 1..=MOST_TRIES {
        if spacing > cells.width || spacing < 0.5 * cells.width {
            cells = Cells::new(points, 1.1 * spacing);
        }
        let sample = throw(&cells, spacing).into_sample(spacing, tries);
        let found = sample.kept.len();
        let (x, y) = (spacing.ln(), (found as f64).ln() - goal);
        tried.add(sample, count);
        if tried.is_near(count, exactly) {
            break;
        }
        let share = ((y + goal).exp() / points.len() as f64).min(1.0);
        spacing = secant.next(x, y, share).exp();
        if secant.high - secant.low < 1e-9 || spacing < f64::MIN_POSITIVE.sqrt() {
            break;
        }
    }
    tried.best(points, forced, count, exactly)
}

/// A secant search for the zero of y(x), kept inside its bracket; y falls with x.
struct Secant {
    low: f64,
    high: f64,
    /// x and y of the last try.
    last: Option<[f64; 2]>,
    /// The y that is aimed at.
    aim: f64,
}

impl Secant {
    /// The x to try after y came out at x, with a share of all points in the sample.
    fn next(&mut self, x: f64, y: f64, share: f64) -> f64 {
        if y > 0.0 {
            self.low = self.low.max(x)
        } else {
            self.high = self.high.min(x)
        }
        let slope = match self.last {
            Some([x0, y0]) if x0 != x && y0 != y => ((y - y0) / (x - x0)).clamp(-3.0, -0.05),
            // The fuller the sample already is, the less a smaller spacing adds.
            _ => -2.0 * (1.0 - share).max(0.1),
        };
        self.last = Some([x, y]);
        let step = x - ((y - self.aim) / slope).clamp(-1.5, 1.5);
        if step > self.low && step < self.high {
            step
        } else if self.low.is_finite() && self.high.is_finite() {
            0.5 * (self.low + self.high)
        } else {
            x - (y / slope).signum()
        }
    }
}

/// The samples nearest to a count, from below and from above.
#[derive(Default)]
struct Tried {
    below: Option<Sample>,
    above: Option<Sample>,
}

impl Tried {
    fn add(&mut self, sample: Sample, count: usize) {
        let found = sample.kept.len();
        if found <= count && self.below.as_ref().is_none_or(|s| s.kept.len() < found) {
            self.below = Some(sample.clone());
        }
        if found >= count && self.above.as_ref().is_none_or(|s| s.kept.len() > found) {
            self.above = Some(sample);
        }
    }

    /// Whether a sample is good enough to stop.
    fn is_near(&self, count: usize, exactly: bool) -> bool {
        let within = (COUNT_WITHIN * count as f64) as usize;
        let off = |s: &Option<Sample>| s.as_ref().map_or(usize::MAX, |s| s.kept.len().abs_diff(count));
        let crowded = if exactly && count < FEW { (count / 50).max(1) } else { 0 };
        off(&self.below) <= within || off(&self.above) <= within.max(crowded)
    }

    fn best(
        self,
        points: &[Vec3],
        forced: Option<&[bool]>,
        count: usize,
        exactly: bool,
    ) -> Result<Sample, SampleError> {
        let off = |s: &Sample| s.kept.len().abs_diff(count);
        let near = |s: &Sample| 100 * off(s) <= count && (count >= FEW || off(s) == 0);
        let closest = [&self.below, &self.above].into_iter().flatten().min_by_key(|s| off(s));
        match (closest, self.above.as_ref()) {
            (Some(sample), _) if near(sample) || !exactly => Ok(sample.clone()),
            (_, Some(above)) => Ok(without_crowded(points, forced, above.clone(), count)),
            (Some(below), None) if 100 * off(below) <= count => Ok(below.clone()),
            (Some(below), None) => Err(SampleError::Duplicates { asked: count, distinct: below.kept.len() }),
            (None, None) => Err(SampleError::Empty),
        }
    }
}

/// The sample without its most crowded points: `count` are left.
fn without_crowded(points: &[Vec3], forced: Option<&[bool]>, sample: Sample, count: usize) -> Sample {
    // The spacing of a sample that has no more than are wanted.
    let wider = sample.spacing * (sample.kept.len() as f64 / count as f64).sqrt();
    let like = Sample { spacing: wider, ..sample };
    let kept = uncrowded(points, forced, &like.kept, count, &like);
    Sample { kept, spacing: sample.spacing, ..like }
}

/// Area from the number of occupied cells, and the spacing that fills it.
fn first_guess(points: &[Vec3], count: usize) -> (Cells, f64) {
    let (lo, hi) = geom::grid::bounds(points);
    let mut sides = [hi.x - lo.x, hi.y - lo.y, hi.z - lo.z];
    sides.sort_by(f64::total_cmp);
    let scale = lo.abs().max().max(hi.abs().max());
    let rough = (sides[2] * sides[1].max(sides[2] / count as f64) / count as f64).sqrt();
    let rough = if rough > 0.0 { rough } else { (1e-9 * scale).max(1e-9) };
    let cells = Cells::new(points, rough);
    // A surface of area A at random tilt enters about 1.5 A/c² cells of width c.
    let area = cells.occupied() as f64 * cells.width * cells.width / 1.5;
    let guess = (PACKING * area / count as f64).sqrt();
    (cells, guess.max(0.2 * rough))
}

/// Aims at the middle (geometric mean) of the range; corrected by the density that came out.
fn by_density(points: &[Vec3], low: f64, high: f64, throw: impl Fn(&Cells, f64) -> Thrown) -> Sample {
    let goal = (low * high).sqrt();
    let mut spacing = (PACKING / goal).sqrt();
    let mut tries = 1;
    loop {
        let sample = throw(&Cells::new(points, spacing), spacing).into_sample(spacing, tries);
        let chosen: Vec<Vec3> = sample.kept.iter().map(|&i| points[i as usize]).collect();
        let density = median_density(&chosen, spacing);
        if (low..=high).contains(&density) || tries == 5 {
            return sample;
        }
        spacing *= (density / goal).sqrt();
        tries += 1;
    }
}

/// Median number of points per area around a point [1/m²], each counted in a disk of three spacings: of the points' own, where they are farther apart than
/// `spacing` [m] says, since a disk that holds its own point alone has the density of that disk.
pub fn median_density(points: &[Vec3], spacing: f64) -> f64 {
    let apart = crate::nearest::typical(points).filter(|apart| *apart > SPARSE * spacing);
    let disk = DENSITY_DISK * apart.unwrap_or(spacing);
    let cells = Cells::new(points, disk);
    let mut counts = cells.map(|slot| cells.count_near(slot, disk, u32::MAX / 2));
    counts.sort_unstable();
    counts.get(counts.len() / 2).map_or(0.0, |&n| n as f64 / (std::f64::consts::PI * disk * disk))
}
