//! Finds the spacing that leaves the count, or the density, that was asked for.

use crate::cells::Cells;
use crate::poisson::poisson;
use crate::{Amount, Sample, SampleError};
use geom::Vec3;

/// A count is met within this share.
const COUNT_WITHIN: f64 = 0.005;
const MOST_TRIES: usize = 40;
/// Kept points per area of a maximal sample of a dense cloud, times the spacing squared [–]; measured.
const PACKING: f64 = 0.7;
/// Local density is counted in a disk of this many spacings.
const DENSITY_DISK: f64 = 3.0;

/// Poisson-disk sample of the given amount.
pub(crate) fn poisson_of(
    points: &[Vec3],
    forced: Option<&[bool]>,
    amount: Amount,
    seed: u64,
) -> Result<Sample, SampleError> {
    let throw = |cells: &Cells, spacing: f64| poisson(cells, spacing, seed, forced);
    match amount {
        Amount::Spacing(spacing) => {
            Ok(Sample { kept: throw(&Cells::new(points, spacing), spacing), spacing, tries: 1 })
        }
        Amount::Count(count) => by_count(points, count, throw),
        Amount::Density(low, high) => Ok(by_density(points, low, high, throw)),
    }
}

/// Secant on log(count) against log(spacing), kept inside a bracket.
fn by_count(
    points: &[Vec3],
    count: usize,
    throw: impl Fn(&Cells, f64) -> Vec<u32>,
) -> Result<Sample, SampleError> {
    let (mut cells, mut spacing) = first_guess(points, count);
    let goal = (count as f64).ln();
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut best: Option<(f64, Sample)> = None;
    let mut last: Option<(f64, f64)> = None;
    for tries in 1..=MOST_TRIES {
        if spacing > cells.width || spacing < 0.5 * cells.width {
            cells = Cells::new(points, 1.1 * spacing);
        }
        let kept = throw(&cells, spacing);
        let (x, y) = (spacing.ln(), (kept.len() as f64).ln() - goal);
        let off = (kept.len() as f64 - count as f64).abs();
        if best.as_ref().is_none_or(|(b, _)| off < *b) {
            best = Some((off, Sample { kept, spacing, tries }));
        }
        if off <= COUNT_WITHIN * count as f64 {
            break;
        }
        if y > 0.0 {
            low = low.max(x)
        } else {
            high = high.min(x)
        }
        let share = ((y + goal).exp() / points.len() as f64).min(1.0);
        let slope = match last {
            Some((x0, y0)) if x0 != x && y0 != y => ((y - y0) / (x - x0)).clamp(-3.0, -0.05),
            // The fuller the sample already is, the less a smaller spacing adds.
            _ => -2.0 * (1.0 - share).max(0.1),
        };
        last = Some((x, y));
        let step = x - (y / slope).clamp(-1.5, 1.5);
        let inside = step > low && step < high;
        spacing = if inside {
            step
        } else if low.is_finite() && high.is_finite() {
            0.5 * (low + high)
        } else {
            x - (y / slope).signum()
        }
        .exp();
        if high - low < 1e-9 || spacing < f64::MIN_POSITIVE.sqrt() {
            break;
        }
    }
    let (off, sample) = best.ok_or(SampleError::Empty)?;
    if off > 0.01 * count as f64 && off > 1.0 && sample.kept.len() < count && !low.is_finite() {
        return Err(SampleError::Duplicates { asked: count, distinct: sample.kept.len() });
    }
    Ok(sample)
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
fn by_density(points: &[Vec3], low: f64, high: f64, throw: impl Fn(&Cells, f64) -> Vec<u32>) -> Sample {
    let goal = (low * high).sqrt();
    let mut spacing = (PACKING / goal).sqrt();
    let mut tries = 1;
    loop {
        let kept = throw(&Cells::new(points, spacing), spacing);
        let chosen: Vec<Vec3> = kept.iter().map(|&i| points[i as usize]).collect();
        let density = median_density(&chosen, spacing);
        if (low..=high).contains(&density) || tries == 5 {
            return Sample { kept, spacing, tries };
        }
        spacing *= (density / goal).sqrt();
        tries += 1;
    }
}

/// Median number of points per area around a point [1/m²], each counted in a disk of three spacings.
pub fn median_density(points: &[Vec3], spacing: f64) -> f64 {
    let disk = DENSITY_DISK * spacing;
    let cells = Cells::new(points, disk);
    let mut counts = cells.map(|place| cells.count_near(place, disk, u32::MAX / 2));
    counts.sort_unstable();
    counts.get(counts.len() / 2).map_or(0.0, |&n| n as f64 / (std::f64::consts::PI * disk * disk))
}
