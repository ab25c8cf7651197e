//! Whether silhouettes agree with each other: every ray along the edge of a silhouette touches the stone, so it touches the hull.
//!
//! ```text
//! r = max(0, −max over the ray of  min over the other views of d)         [m], 0 for every ray of poses that agree
//! ```
//!
//! Hernández, Schmitt & Cipolla (2007), doi:10.1109/TPAMI.2007.42. Poses are refined by Gauss and Newton's method on these residuals, damped, with
//! weights 1/(1 + (r/c)²); c is three times the mean residual.

use crate::hull::View;
use geom::Vec3;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Samples of a ray, and how often the best place is narrowed to half.
const SAMPLES: usize = 48;
const HALVINGS: usize = 6;
/// Steps of the refinement, at most.
const STEPS: usize = 20;

/// A ball around the stone: rays are looked at inside it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Its centre [m].
    pub centre: Vec3,
    /// Its radius [m].
    pub radius: f64,
}

/// Residuals of some rays of each view [m], `each` a view at most.
pub fn residuals(views: &[View], ball: &Ball, each: usize) -> Vec<f64> {
    let of = |view: usize| {
        let edge = views[view].field.edge();
        let count = each.min(edge.len());
        (0..count).map(move |n| (view, edge[n * edge.len() / count])).collect::<Vec<_>>()
    };
    let rays: Vec<(usize, [f64; 2])> = (0..views.len()).flat_map(of).collect();
    let order = crate::hull::spread(views.len());
    rays.par_iter().map(|(view, pixel)| (-touch(views, &order, *view, *pixel, ball)).max(0.0)).collect()
}

/// The largest distance to the cones of the other views along a ray; below 0 it misses them all.
pub(crate) fn touch(views: &[View], order: &[usize], own: usize, pixel: [f64; 2], ball: &Ball) -> f64 {
    let camera = &views[own].camera;
    let (eye, ray) = (camera.eye(), camera.ray(pixel));
    let middle = ray.dot(&(ball.centre - eye));
    let least = |t: f64, best: f64| {
        let p = eye + ray * t;
        let mut least = f64::from(f32::MAX);
        for k in order.iter().filter(|k| **k != own) {
            least = least.min(views[*k].distance(&p));
            if least <= best {
                break;
            }
        }
        least
    };
    let mut step = 2.0 * ball.radius / SAMPLES as f64;
    let (mut best, mut at) = (-ball.radius, middle);
    for n in 0..=SAMPLES {
        let t = middle - ball.radius + n as f64 * step;
        let value = least(t, best);
        if value > best {
            (best, at) = (value, t);
        }
    }
    for _ in 0..HALVINGS {
        step /= 2.0;
        for t in [at - step, at + step] {
            let value = least(t, best);
            if value > best {
                (best, at) = (value, t);
            }
        }
    }
    best
}

/// Parameters that make residuals least, with the root mean square of these; `steps` are small changes of each parameter.
pub fn refine(start: &[f64], steps: &[f64], of: impl Fn(&[f64]) -> Vec<f64>) -> (Vec<f64>, f64) {
    let mut at = start.to_vec();
    let mut now = of(&at);
    let mut damping = 1e-3;
    for _ in 0..STEPS {
        let c = 3.0 * now.iter().sum::<f64>() / now.len() as f64;
        if !(c > 0.0) {
            break;
        }
        let weight = |r: f64| 1.0 / (1.0 + (r / c).powi(2));
        let cost = |all: &[f64]| all.iter().map(|r| c * c * libm::log1p((r / c).powi(2))).sum::<f64>();
        let mut jacobian = DMatrix::zeros(now.len(), at.len());
        for (k, step) in steps.iter().enumerate() {
            let mut moved = at.clone();
            moved[k] += step;
            let moved = of(&moved);
            for n in 0..now.len() {
                jacobian[(n, k)] = (moved[n] - now[n]) * weight(now[n]).sqrt();
            }
        }
        let weighted = DVector::from_iterator(now.len(), now.iter().map(|r| r * weight(*r).sqrt()));
        let (normal, right) = (jacobian.transpose() * &jacobian, jacobian.transpose() * weighted);
        let mut better = false;
        while damping < 1e3 {
            let damped = &normal
                + DMatrix::from_diagonal(&normal.diagonal()) * damping
                + DMatrix::identity(at.len(), at.len()) * 1e-30;
            let Some(change) = damped.lu().solve(&right) else { break };
            let next: Vec<f64> = (0..at.len()).map(|k| at[k] - change[k] * steps[k]).collect();
            let found = of(&next);
            if cost(&found) < cost(&now) * (1.0 - 1e-4) {
                (at, now, damping, better) = (next, found, damping / 5.0, true);
                break;
            }
            damping *= 5.0;
        }
        if !better {
            break;
        }
    }
    let left = rms(&now);
    (at, left)
}

/// Root mean square of residuals.
pub fn rms(residuals: &[f64]) -> f64 {
    (residuals.iter().map(|r| r * r).sum::<f64>() / residuals.len() as f64).sqrt()
}
