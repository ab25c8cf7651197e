//! The surface of a bed from above: the height of the highest grain over each point of a grid.

use crate::{Frame, MeasureError};
use geom::Vec3;

/// Rays per mean diameter.
const RAYS: f64 = 4.0;
/// Most rays along one axis; a wider bed gets wider steps.
const MOST: f64 = 2000.0;

/// Directions of a bed: two level ones and up, right-handed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame3 {
    /// First level direction.
    pub u: Vec3,
    /// Second level direction.
    pub v: Vec3,
    pub up: Vec3,
}

impl Frame3 {
    /// Directions with the given `up`, the first one as near to x (or else y) as can be.
    pub fn new(up: Vec3) -> Frame3 {
        let up = up.normalize();
        let towards = if up.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() };
        let u = (towards - up * up.dot(&towards)).normalize();
        Frame3 { u, v: up.cross(&u), up }
    }

    /// Directions with the given `up`, the first one towards a side; `None` if that is more upright than level.
    pub fn towards(up: Vec3, side: Vec3) -> Option<Frame3> {
        let up = up.normalize();
        let level = side - up * up.dot(&side);
        let u = level.try_normalize(0.5 * side.norm())?;
        Some(Frame3 { u, v: up.cross(&u), up })
    }
}

/// Heights over a grid.
#[derive(Debug, Clone)]
pub struct HeapSurface {
    /// Level positions of the rays (along u and v) and heights [m]; only rays that meet a grain.
    pub points: Vec<[f64; 3]>,
    /// Height of the ground [m]: below 99 % of the lowest points of grains.
    pub ground: f64,
    /// Steps of the grid [m].
    pub step: f64,
    /// Lowest level position along u and v [m], and rays along each.
    pub grid: ([f64; 2], [usize; 2]),
}

impl HeapSurface {
    /// The surface of a frame that holds grains.
    pub fn new(frame: &Frame, axes: &Frame3, ground: Option<f64>) -> HeapSurface {
        let position = |p: &Vec3| [p.dot(&axes.u), p.dot(&axes.v), p.dot(&axes.up)];
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for (p, r) in frame.position.iter().zip(&frame.radius) {
            let p = position(p);
            for k in 0..2 {
                (low[k], high[k]) = (low[k].min(p[k] - r), high[k].max(p[k] + r));
            }
        }
        let widest = (high[0] - low[0]).max(high[1] - low[1]);
        let step = (frame.mean_diameter() / RAYS).max(widest / MOST);
        let count = [0, 1].map(|k| ((high[k] - low[k]) / step) as usize + 1);
        let mut heights = vec![f64::NEG_INFINITY; count[0] * count[1]];
        let mut bottoms = Vec::with_capacity(frame.len());
        for (p, r) in frame.position.iter().zip(&frame.radius) {
            let p = position(p);
            bottoms.push(p[2] - r);
            let range = |k: usize| {
                let from = ((p[k] - r - low[k]) / step).ceil().max(0.0) as usize;
                from..(((p[k] + r - low[k]) / step) as usize + 1).min(count[k])
            };
            for j in range(1) {
                for i in range(0) {
                    let [x, y] = [low[0] + i as f64 * step - p[0], low[1] + j as f64 * step - p[1]];
                    let rest = r * r - x * x - y * y;
                    if rest >= 0.0 {
                        let top = &mut heights[j * count[0] + i];
                        *top = top.max(p[2] + rest.sqrt());
                    }
                }
            }
        }
        let at = |(k, h): (usize, &f64)| {
            [low[0] + (k % count[0]) as f64 * step, low[1] + (k / count[0]) as f64 * step, *h]
        };
        let points = heights.iter().enumerate().filter(|(_, h)| h.is_finite()).map(at).collect();
        let ground = ground.unwrap_or_else(|| crate::statistics::quantile(&mut bottoms, 0.01));
        HeapSurface { points, ground, step, grid: (low, count) }
    }

    /// Width of the bins of a profile [m]: the given one, or the usual one.
    ///
    /// # Errors
    /// Narrower than the grid.
    pub(crate) fn bin(&self, given: Option<f64>, usual: f64) -> Result<f64, MeasureError> {
        let bin = given.unwrap_or(usual);
        let cure = "give at least a quarter of a mean diameter";
        let narrow = MeasureError::Setting { what: "bin", value: bin, unit: "m", cure };
        if bin < self.step { Err(narrow) } else { Ok(bin) }
    }

    /// Level centre of what stands above half of the greatest height: where the top of a heap is.
    pub fn middle(&self) -> [f64; 2] {
        let mut tops: Vec<f64> = self.points.iter().map(|p| p[2]).collect();
        // Not the very highest: that may be a grain in the air.
        let top = crate::statistics::quantile(&mut tops, 0.995);
        let half = 0.5 * (top + self.ground);
        let mut sum = [0.0; 3];
        for p in self.points.iter().filter(|p| p[2] > half) {
            let weight = p[2].min(top) - half;
            sum = [sum[0] + weight * p[0], sum[1] + weight * p[1], sum[2] + weight];
        }
        [sum[0] / sum[2], sum[1] / sum[2]]
    }
}
