//! Digits that coordinates in 4-byte numbers have lost, far from the origin.

use crate::Vec3;
use std::fmt;

/// Points that stand for all.
pub const SOME: usize = 4096;
/// Fewer points say nothing of a spacing.
const FEWEST: usize = 10;
/// Share of the points at either end of an axis that does not count: far outliers.
const ENDS: f64 = 0.05;
/// Share of the spacing that a coordinate may be off [–].
const EXACT: f64 = 0.01;

/// Where most points are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// Lengths of the box around most points, ascending [m].
    pub sides: [f64; 3],
    /// Largest coordinate in it [m].
    pub largest: f64,
}

/// Coordinates in 4-byte numbers that are exact only to a share of the spacing that can be seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LostDigits {
    /// Largest coordinate [m].
    pub largest: f64,
    /// Distance between neighbouring numbers there [m].
    pub step: f64,
    /// Mean distance of points [m].
    pub spacing: f64,
}

impl fmt::Display for LostDigits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [largest, step, spacing] = [self.largest, self.step, self.spacing].map(rough);
        write!(
            f,
            "coordinates up to {largest} m stand in 4-byte numbers, which are {step} m apart there, and the points are {spacing} m apart"
        )
    }
}

/// A number of two digits: an estimate.
pub fn rough(value: f64) -> crate::Shown {
    crate::Shown(format!("{value:.1e}").parse().unwrap_or(value))
}

impl Extent {
    /// Of points that stand for all; `None` of too few.
    pub fn of(some: &[Vec3]) -> Option<Extent> {
        if some.len() < FEWEST {
            return None;
        }
        let ends = |axis: usize| {
            let mut values: Vec<f64> = some.iter().map(|p| p[axis]).collect();
            values.sort_by(f64::total_cmp);
            let off = (ENDS * values.len() as f64) as usize;
            (values[off], values[values.len() - 1 - off])
        };
        let ends = [0, 1, 2].map(ends);
        let mut sides = ends.map(|(low, high)| high - low);
        sides.sort_by(f64::total_cmp);
        let largest = ends.iter().map(|(low, high)| low.abs().max(high.abs())).fold(0.0, f64::max);
        Some(Extent { sides, largest })
    }

    /// Mean distance of so many points on a surface or a line [m].
    pub fn spacing(&self, count: f64) -> f64 {
        (self.sides[2] * self.sides[1].max(self.sides[2] / count) / count).sqrt()
    }

    /// What 4-byte numbers have lost of so many points.
    pub fn lost_digits(&self, count: f64) -> Option<LostDigits> {
        let (largest, spacing) = (self.largest, self.spacing(count));
        let step = largest * f64::from(f32::EPSILON);
        (step > EXACT * spacing && spacing > 0.0).then_some(LostDigits { largest, step, spacing })
    }
}

/// What 4-byte numbers have lost of these points [m].
pub fn lost(points: &[Vec3]) -> Option<LostDigits> {
    let step = points.len().div_ceil(SOME).max(1);
    let finite = |p: &&Vec3| p.iter().all(|c| c.is_finite());
    let some: Vec<Vec3> = points.iter().step_by(step).filter(finite).copied().collect();
    Extent::of(&some)?.lost_digits(points.len() as f64)
}
