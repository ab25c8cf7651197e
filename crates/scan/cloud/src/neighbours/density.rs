//! Points per area of a scanned surface.

use geom::Vec3;
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use rayon::prelude::*;
use std::f64::consts::PI;
use std::num::NonZero;

/// Points that stand for the cloud when its density is surveyed.
const SAMPLE: usize = 16_000;
/// Places where it is measured.
const PLACES: usize = 1_500;
/// Neighbours that a measurement takes in.
const NEIGHBOURS: usize = 16;
/// Fewer points have no density worth the name.
pub const FEWEST: usize = 30;

/// Density [1/m²] below which only the sparsest `share` of the surface lies; none when points are too few or all
/// at one position.
///
/// Measured at positions spread over the points, from the distance to the 16th neighbour in a random part of the
/// cloud; each position counts for the area it stands for.
pub fn sparse(points: &[Vec3], share: f64) -> Option<f64> {
    if points.len() < FEWEST {
        return None;
    }
    let sample = spread(points, SAMPLE);
    let part = sample.len() as f64 / points.len() as f64;
    let tree = ImmutableKdTree::<f64, 3>::new_from_slice(&sample).ok()?;
    let step = sample.len().div_ceil(PLACES);
    let positions: Vec<[f64; 3]> = sample.iter().copied().step_by(step).collect();
    let wanted = NonZero::new(NEIGHBOURS + 1)?;
    let measure = |position: &[f64; 3]| {
        let found = tree.query(position).nearest_n::<SquaredEuclidean<f64>>(wanted).execute();
        let radius2 = found.iter().map(|n| n.distance).fold(0.0, f64::max);
        NEIGHBOURS as f64 / (PI * radius2 * part)
    };
    let mut found: Vec<f64> = positions.par_iter().map(measure).filter(|d| d.is_finite()).collect();
    found.sort_by(f64::total_cmp);
    // A lone far point stands for a huge area: the sparsest hundredth of the positions does not count.
    let found = &found[found.len() / 100..];
    let whole: f64 = found.iter().map(|d| 1.0 / d).sum();
    let mut area = 0.0;
    found.iter().copied().find(|d| {
        area += 1.0 / d;
        area >= share * whole
    })
}

/// About `count` of the points, one at random out of every run, so that the rows of a scanner leave no pattern.
pub(crate) fn spread(points: &[Vec3], count: usize) -> Vec<[f64; 3]> {
    let step = (points.len() / count).max(1);
    let pick = |(run, points): (usize, &[Vec3])| {
        let mixed = (run as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let p = points[(mixed >> 33) as usize % points.len()];
        [p.x, p.y, p.z]
    };
    points.chunks(step).enumerate().map(pick).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(count: u32, side: f64) -> Vec<Vec3> {
        let share = |x: u32| f64::from(x) / f64::from(u32::MAX);
        let point = |i: u32| {
            let x = i.wrapping_mul(2654435769);
            let y = i.wrapping_mul(1640531527) ^ (i.wrapping_mul(374761393) >> 7);
            Vec3::new(side * share(x), side * share(y.wrapping_mul(2246822519)), 0.0)
        };
        (1..=count).map(point).collect()
    }

    #[test]
    fn the_survey_finds_the_density_of_a_plane_and_forgets_a_far_point() {
        let mut points = plane(40_000, 2.0);
        points.push(Vec3::repeat(1e7));
        let median = sparse(&points, 0.5).unwrap();
        assert!((median / 10_000.0 - 1.0).abs() < 0.2, "{median}");
        let low = sparse(&points, 0.05).unwrap();
        assert!(low > 4_000.0 && low < median, "{low}");
    }

    #[test]
    fn few_or_equal_points_have_none() {
        assert_eq!(sparse(&plane(10, 1.0), 0.5), None);
        assert_eq!(sparse(&[Vec3::x(); 1000], 0.5), None);
    }
}
