//! Grains above the heap, such as those of a hopper: they would count as its surface.
//!
//! Upright columns as wide as a mean diameter are searched for an empty stretch of several diameters. A few grains in
//! the air are normal; where many columns hold grains above such a stretch, something else stands above the heap.

use super::Frame3;
use crate::Frame;

/// Length of an empty stretch [mean diameters].
const STRETCH: f64 = 4.0;
/// Share of columns from which on it is no matter of a few grains in the air.
const MANY: f64 = 0.1;
/// Most columns along one level direction.
const MOST: f64 = 1e6;

/// The share of the columns that hold grains above an empty stretch, if it is large.
pub(super) fn overhang(frame: &Frame, axes: &Frame3) -> Option<f64> {
    let width = frame.mean_diameter();
    let place = |x: f64| libm::floor(x / width).clamp(-MOST, MOST) as i64;
    let column = |p: &geom::Vec3| (place(p.dot(&axes.u)), place(p.dot(&axes.v)));
    let mut grains: Vec<((i64, i64), f64)> =
        frame.position.iter().map(|p| (column(p), p.dot(&axes.up))).collect();
    grains.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let (mut columns, mut open) = (0u64, 0u64);
    for column in grains.chunk_by(|a, b| a.0 == b.0) {
        columns += 1;
        open += u64::from(column.windows(2).any(|two| two[1].1 - two[0].1 > (STRETCH + 1.0) * width));
    }
    let share = open as f64 / columns as f64;
    (share > MANY).then_some(share)
}
