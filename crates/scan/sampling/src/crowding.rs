//! Weighted sample elimination: removes the most crowded point again and again, until the count is left.
//!
//! ```text
//! w(i) = Σⱼ (1 − max(dᵢⱼ, d_min)/2 r_max)^4        dᵢⱼ < 2 r_max
//! r_max = √(A/(2√3 N)),   d_min = 2 r_max (1 − (N/M)^1.5) 0.65
//! ```
//!
//! M points in, N out; M is thinned to about 10 N first. Yuksel (2015), doi:10.1111/cgf.12538, with the power 4 where he has 8: those at the rim of the
//! reach count for more, which leaves less unevenness of large extent. The area A is not known; r_max comes from the spacing r
//! at which a Poisson-disk sample has N points: N = 0.7 A/r². Weights are whole numbers, so that the order of
//! subtractions changes nothing.

use crate::Sample;
use crate::cells::Cells;
use crate::sheets::others;
use geom::Vec3;
use rayon::prelude::*;
use std::collections::BinaryHeap;

/// r_max over r: √(1/(2√3 · 0.7)).
const RADIUS: f64 = 0.64;
/// Weights are multiples of this share of the largest one.
const UNIT: f64 = (1u64 << 40) as f64;

/// `count` of the points `all` without the most crowded ones, ascending; `like` has about the spacing of so many.
pub(crate) fn uncrowded(
    points: &[Vec3],
    forced: Option<&[bool]>,
    all: &[u32],
    count: usize,
    like: &Sample,
) -> Vec<u32> {
    let crowd: Vec<Vec3> = all.iter().map(|&i| points[i as usize]).collect();
    let forced: Option<Vec<bool>> = forced.map(|f| all.iter().map(|&i| f[i as usize]).collect());
    let reach = 2.0 * RADIUS * like.spacing;
    let cells = Cells::new(&crowd, reach);
    let left = 1.0 - libm::pow(count as f64 / crowd.len() as f64, 1.5);
    let apart = if like.beside > 0 { Apart::new(points, all, &cells, reach) } else { Apart::default() };
    let weight = Weight { reach, least: reach * left * 0.65, apart };
    let alive = remove(&cells, forced.as_deref(), count, &weight);
    let alive = (0..crowd.len()).filter(|&slot| alive[slot]);
    let mut kept: Vec<u32> = alive.map(|slot| all[cells.order()[slot] as usize]).collect();
    kept.sort_unstable();
    kept
}

struct Weight {
    /// 2 r_max [m].
    reach: f64,
    /// Nearer than this counts as this [m].
    least: f64,
    apart: Apart,
}

/// Pairs of slots of the crowd that lie on two sheets and do not crowd each other.
#[derive(Default)]
struct Apart(Vec<(u32, u32)>);

impl Apart {
    /// Judged in the whole cloud, of which the crowd has the indices `all`.
    fn new(points: &[Vec3], all: &[u32], crowd: &Cells, reach: f64) -> Apart {
        let cells = Cells::new(points, reach);
        let slot_of = cells.slots();
        let mut in_crowd = vec![u32::MAX; points.len()];
        (0..).zip(crowd.order()).for_each(|(slot, &k)| in_crowd[all[k as usize] as usize] = slot);
        let pairs = |(slot, &k): (usize, &u32)| {
            let found = others(&cells, slot_of[all[k as usize] as usize], reach);
            let theirs = found.into_iter().map(|p| in_crowd[cells.order()[p as usize] as usize]);
            let theirs: Vec<u32> = theirs.filter(|&p| p != u32::MAX).collect();
            theirs.into_iter().flat_map(move |other| [(slot as u32, other), (other, slot as u32)])
        };
        let mut apart: Vec<(u32, u32)> = crowd.order().par_iter().enumerate().flat_map_iter(pairs).collect();
        apart.par_sort_unstable();
        apart.dedup();
        Apart(apart)
    }

    fn has(&self, a: u32, b: u32) -> bool {
        !self.0.is_empty() && self.0.binary_search(&(a, b)).is_ok()
    }
}

impl Weight {
    fn of(&self, square: f64) -> u64 {
        let w = 1.0 - square.sqrt().max(self.least) / self.reach;
        let square = w * w;
        (square * square * UNIT) as u64
    }
}

/// Heap with late updates: a weight only falls, so an entry that is out of date is too high and is pushed back.
fn remove(cells: &Cells, forced: Option<&[bool]>, count: usize, weight: &Weight) -> Vec<bool> {
    let mut w: Vec<u64> = cells.map(|slot| {
        let mut sum = 0;
        cells.each_near(slot, weight.reach, |other, square| {
            sum += if other == slot || weight.apart.has(slot, other) { 0 } else { weight.of(square) }
        });
        sum
    });
    let free = |slot: &usize| forced.is_none_or(|f| !f[cells.order()[*slot] as usize]);
    let mut heap: BinaryHeap<(u64, u32)> =
        (0..cells.len()).filter(free).map(|slot| (w[slot], slot as u32)).collect();
    let mut alive = vec![true; cells.len()];
    let mut left = cells.len();
    while left > count {
        let Some((was, slot)) = heap.pop() else { break };
        if was != w[slot as usize] {
            heap.push((w[slot as usize], slot));
            continue;
        }
        alive[slot as usize] = false;
        left -= 1;
        cells.each_near(slot, weight.reach, |other, square| {
            if alive[other as usize] && !weight.apart.has(slot, other) {
                w[other as usize] -= weight.of(square);
            }
        });
    }
    alive
}
