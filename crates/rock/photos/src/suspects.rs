//! Views that do not agree with most others: out of order, moved, or with a wrong mask.
//!
//! The hull is what all silhouettes leave, so one wrong silhouette makes all others look wrong. Two by two it stands out:
//!
//! ```text
//! m(i, j) = mean over rays along the edge of silhouette i of  max(0, −max over the ray of d_j)     [m], 0 where i and j agree
//! score(k) = median over j of  (m(k, j) + m(j, k))/2                                               large where k disagrees with most
//! ```
//!
//! A view is suspect if its score is more than [`LEAST`] of the size of the stone, and [`TIMES`] that of most views.

use crate::coherence::{Ball, touch};
use crate::hull::View;
use crate::mask::median;
use rayon::prelude::*;

/// Rays of a view.
const RAYS: usize = 24;
/// Least score, over the radius of the ball.
const LEAST: f64 = 0.0005;
/// Least score, over the median of all.
const TIMES: f64 = 4.0;

/// Numbers of the suspect views, in their order; `ball` holds the stone. Half of the views, or more, cannot be suspect.
pub fn suspects(views: &[View], ball: &Ball) -> Vec<usize> {
    let count = views.len();
    if count < 4 {
        return Vec::new();
    }
    let misses: Vec<f64> =
        (0..count * count).into_par_iter().map(|n| miss(views, n / count, n % count, ball)).collect();
    let score = |k: usize| {
        let others = (0..count).filter(|j| *j != k);
        median(others.map(|j| (misses[k * count + j] + misses[j * count + k]) / 2.0).collect())
    };
    let scores: Vec<f64> = (0..count).map(score).collect();
    let limit = (LEAST * ball.radius).max(TIMES * median(scores.clone()));
    let found: Vec<usize> = (0..count).filter(|k| scores[*k] > limit).collect();
    if 2 * found.len() < count { found } else { Vec::new() }
}

/// How far rays along the edge of one silhouette pass the cone of another [m].
fn miss(views: &[View], own: usize, other: usize, ball: &Ball) -> f64 {
    let edge = views[own].field.edge();
    let rays = RAYS.min(edge.len());
    if own == other || rays == 0 {
        return 0.0;
    }
    let far = |n: usize| (-touch(views, &[other], own, edge[n * edge.len() / rays], ball)).max(0.0);
    (0..rays).map(far).sum::<f64>() / rays as f64
}
