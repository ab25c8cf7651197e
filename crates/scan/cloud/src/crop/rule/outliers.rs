//! Isolated points: those much farther from their neighbours than is usual in the cloud.
//!
//! ```text
//! d̄ᵢ = mean distance from point i to its K nearest neighbours
//! i goes when d̄ᵢ > mean(d̄) + σ · deviation(d̄)
//! ```
//!
//! Rusu et al. (2008), Robotics and Autonomous Systems 56(11), doi:10.1016/j.robot.2008.08.005.

use crate::neighbours::distances::mean_distances;
use geom::Vec3;
use serde::Serialize;
use std::str::FromStr;
use thiserror::Error;

/// How far is too far.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Outliers {
    /// Neighbours looked at [–].
    pub neighbours: usize,
    /// Deviations above the mean that are still kept [–].
    pub sigma: f64,
}

/// Why a text is not `K,SIGMA`.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("'{0}' is not K,SIGMA: give a count from 1 to 1000 and a number of deviations ≥ 0, such as 12,3")]
pub struct OutliersError(String);

impl FromStr for Outliers {
    type Err = OutliersError;

    fn from_str(text: &str) -> Result<Outliers, OutliersError> {
        let wrong = || OutliersError(text.to_owned());
        let (k, sigma) = text.split_once(',').ok_or_else(wrong)?;
        let neighbours = k.trim().parse().map_err(|_| wrong())?;
        let sigma: f64 = sigma.trim().parse().map_err(|_| wrong())?;
        let fits = (1..=1000).contains(&neighbours) && sigma >= 0.0 && sigma.is_finite();
        if fits { Ok(Outliers { neighbours, sigma }) } else { Err(wrong()) }
    }
}

/// Rows of the finite `points` [m] that are no outliers, in order. Fewer than two points have none.
pub fn inliers(points: &[Vec3], rule: &Outliers) -> Vec<u32> {
    let distances = mean_distances(points, rule.neighbours);
    let count = distances.len() as f64;
    let mean = distances.iter().sum::<f64>() / count;
    let variance = distances.iter().map(|d| (d - mean) * (d - mean)).sum::<f64>() / count;
    // A cloud of equal distances must not lose points to rounding.
    let most = mean + rule.sigma * variance.sqrt() + 1e-9 * mean;
    (0u32..).zip(&distances).filter(|(_, d)| **d <= most).map(|(i, _)| i).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_distances_are_those_of_brute_force() {
        let point = |i: u32| {
            let v = |s: u32| f64::from(i.wrapping_mul(2654435761).rotate_left(s) % 1000) / 100.0;
            Vec3::new(v(1), v(9), v(17))
        };
        let points: Vec<Vec3> = (0..300).map(point).collect();
        for (i, found) in mean_distances(&points, 7).into_iter().enumerate() {
            let mut all: Vec<f64> = points.iter().map(|p| (p - points[i]).norm()).collect();
            all.sort_by(f64::total_cmp);
            assert!((found - all[1..8].iter().sum::<f64>() / 7.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_far_point_goes_and_a_lattice_stays() {
        let mut points: Vec<Vec3> =
            (0..400).map(|i| Vec3::new((i % 20) as f64, (i / 20) as f64, 0.0)).collect();
        let rule = Outliers { neighbours: 4, sigma: 12.0 };
        assert_eq!(inliers(&points, &rule).len(), 400);
        points.push(Vec3::new(10.0, 10.0, 30.0));
        assert_eq!(inliers(&points, &rule), (0..400).collect::<Vec<u32>>());
    }

    #[test]
    fn few_and_equal_points() {
        let rule = Outliers { neighbours: 8, sigma: 1.0 };
        assert_eq!(inliers(&[], &rule), Vec::<u32>::new());
        assert_eq!(inliers(&[Vec3::zeros()], &rule), [0]);
        assert_eq!(inliers(&[Vec3::x(); 500], &rule).len(), 500);
    }

    #[test]
    fn texts() {
        assert_eq!("12, 2.5".parse(), Ok(Outliers { neighbours: 12, sigma: 2.5 }));
        for text in ["", "12", "0,1", "5,-1", "5,nan", "a,b"] {
            assert!(text.parse::<Outliers>().is_err(), "{text}");
        }
    }
}
