//! How the points around a point lie: on a surface or in a volume, and which way the surface faces.
//!
//! ```text
//! C          covariance of a point and its K nearest neighbours, with eigenvalues λ₀ ≤ λ₁ ≤ λ₂
//! variation  λ₀/(λ₀ + λ₁ + λ₂): 0 on a plane, 1/3 where points fill space        Pauly, Gross & Kobbelt (2002), doi:10.1109/VISUAL.2002.1183771
//! scattered  the mean variation of a point and its K nearest neighbours is at least SHARE
//! grazing    from every viewpoint the axis of λ₀ and the line of sight have an angle of more than ANGLE
//! ```
//!
//! Leaves and branches are scattered. A beam that meets an edge is reflected by both surfaces, and its point lies between them in the air; such
//! points form sheets along the line of sight (Tang, Huber & Akinci 2007, doi:10.1109/3DIM.2007.5).

use geom::{Vec3, least_axis};
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::num::NonZero;
use std::str::FromStr;
use thiserror::Error;

/// Neighbours that say which way a surface faces.
const FACING: usize = 12;

/// When points are too scattered for a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scattered {
    /// Neighbours looked at [–].
    pub neighbours: usize,
    /// Mean variation from which on a point is scattered [–].
    pub share: f64,
}

/// Why a text is not `K,SHARE`.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "'{0}' is not K,SHARE: give a count of neighbours from 3 to 1000 and a variation above 0 and up to 1/3, such as 30,0.1"
)]
pub struct ScatteredError(String);

impl FromStr for Scattered {
    type Err = ScatteredError;

    fn from_str(text: &str) -> Result<Scattered, ScatteredError> {
        let wrong = || ScatteredError(text.to_owned());
        let (k, share) = text.split_once(',').ok_or_else(wrong)?;
        let neighbours = k.trim().parse().map_err(|_| wrong())?;
        let share: f64 = share.trim().parse().map_err(|_| wrong())?;
        let fits = (3..=1000).contains(&neighbours) && share > 0.0 && share <= 1.0 / 3.0;
        if fits { Ok(Scattered { neighbours, share }) } else { Err(wrong()) }
    }
}

/// Rows of the finite `points` [m] that are not scattered, in order. Too few points for the rule are not.
pub fn compact(points: &[Vec3], rule: &Scattered) -> Vec<u32> {
    let all = 0..points.len() as u32;
    let Some(around) = Around::new(points, rule.neighbours) else { return all.collect() };
    let variations: Vec<f64> = points.par_iter().map(|p| variation(&around.covariance(p))).collect();
    let mean = |p: &Vec3| {
        let near = around.nearest(p);
        near.iter().map(|&i| variations[i as usize]).sum::<f64>() / near.len() as f64
    };
    let means: Vec<f64> = points.par_iter().map(mean).collect();
    all.zip(means).filter(|(_, mean)| *mean < rule.share).map(|(i, _)| i).collect()
}

/// Rows of the finite `points` [m] whose surface some viewpoint of `eyes` [m] sees at `degrees` to its normal at most, in order. Too few points
/// have no surface, and stay.
pub fn faced(points: &[Vec3], eyes: &[Vec3], degrees: f64) -> Vec<u32> {
    let all = 0..points.len() as u32;
    let Some(around) = Around::new(points, FACING) else { return all.collect() };
    let least = degrees.to_radians().cos();
    let stays = |p: &Vec3| {
        // Where the points around have no least axis (one place, or a line) nothing is known.
        let Some(normal) = least_axis(&around.covariance(p)) else { return true };
        let sees = |eye: &Vec3| normal.dot(&(eye - p)).abs() >= least * (eye - p).norm();
        eyes.iter().any(sees)
    };
    let stay: Vec<bool> = points.par_iter().map(stays).collect();
    all.zip(stay).filter(|(_, stays)| *stays).map(|(i, _)| i).collect()
}

/// λ₀ over the sum of all, of a covariance.
fn variation(covariance: &Matrix3<f64>) -> f64 {
    let trace = covariance.trace();
    let least = least_axis(covariance).map_or(0.0, |axis| axis.dot(&(covariance * axis)));
    if trace > 0.0 { (least / trace).max(0.0) } else { 0.0 }
}

/// The nearest neighbours of points.
struct Around<'a> {
    points: &'a [Vec3],
    tree: ImmutableKdTree<f64, 3>,
    and_self: NonZero<usize>,
}

impl<'a> Around<'a> {
    /// `None`: there are too few.
    fn new(points: &'a [Vec3], neighbours: usize) -> Option<Around<'a>> {
        let and_self = NonZero::new(neighbours + 1).filter(|n| n.get() <= points.len())?;
        let positions: Vec<[f64; 3]> = points.iter().map(|p| [p.x, p.y, p.z]).collect();
        let tree = ImmutableKdTree::new_from_slice(&positions).ok()?;
        Some(Around { points, tree, and_self })
    }

    /// Rows of a point and its nearest neighbours, in order.
    fn nearest(&self, p: &Vec3) -> Vec<u32> {
        let place = [p.x, p.y, p.z];
        let found = self.tree.query(&place).nearest_n::<SquaredEuclidean<f64>>(self.and_self).execute();
        let mut rows: Vec<u32> = found.iter().map(|n| n.item).collect();
        // Of equal distances the tree has no order to rely on; sums need one.
        rows.sort_unstable();
        rows
    }

    fn covariance(&self, p: &Vec3) -> Matrix3<f64> {
        let near = self.nearest(p);
        let off = |i: &u32| self.points[*i as usize] - p;
        let mean = near.iter().map(off).sum::<Vec3>() / near.len() as f64;
        near.iter().map(off).map(|d| (d - mean) * (d - mean).transpose()).sum::<Matrix3<f64>>()
            / near.len() as f64
    }
}
