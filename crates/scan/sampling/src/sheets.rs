//! Distances along the surface: points of another sheet, such as the far side of a thin plate, do not thin this one.
//!
//! ```text
//! s = √(π r²/n)                        input spacing in a ball of radius r that holds n points
//! i, j on two sheets:  every way from i to j by steps ≤ 2.4 s is longer than 1.5 r, and
//!                      j is more than 1.2 s off the plane of what those ways reach from i
//! ```
//!
//! The first condition is an on-surface distance in the graph of near points (Tenenbaum et al. 2000,
//! doi:10.1126/science.290.5500.2319); a right-angled edge makes a way at most √2 times longer, so that points on both sides of
//! an edge thin each other as ever. The second keeps the rows of a scanner, which lie in one surface, together however far they
//! are apart. Two sheets are separated from a distance of 1.7 s; below that, and where a spacing is less than about five times s,
//! points alone do not say what lies on which.
//!
//! Nearly all surroundings are one sheet and are not searched: there a paraboloid of least squares passes all points within 0.8 s.

use crate::cells::Cells;
use crate::poisson::chance;
use geom::{PrincipalAxes, Vec3};
use nalgebra::{Cholesky, SMatrix, SVector};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Points of a ball from which sheets can be separated [–].
const FEWEST: u32 = 60;
/// Longest step of a way, in input spacings as the ball shows them: two sheets in a ball show √½ of each one's own.
const STEP: f64 = 2.4;
/// Way on the surface over the ball's radius, beyond which a point is on another sheet.
const WAY: f64 = 1.5;
/// Least distance of such a point from the plane of this sheet, in steps.
const OFF: f64 = 0.5;
/// A paraboloid that passes all points within so many steps is one sheet.
const SMOOTH: f64 = 0.35;
/// Points that the paraboloid is fitted to.
const FITTED: usize = 48;
/// Points of a ball that ways lead over, about, at most: more tell apart sheets nearer than a twentieth of the radius.
const MOST: usize = 3000;
/// Cells of a ball's own grid along an axis, at most.
const CELLS: f64 = 24.0;

/// Slots in the ball of `radius` [m] around the point at `slot` that lie on another sheet; ascending, mostly none.
/// `radius` is at most the cell width.
pub(crate) fn others(cells: &Cells, slot: u32, radius: f64) -> Vec<u32> {
    if cells.count_near(slot, radius, FEWEST) < FEWEST {
        return Vec::new();
    }
    let mut slots = Vec::new();
    cells.each_near(slot, radius, |other, _| slots.push(other));
    let centre = cells.points[slot as usize];
    let near: Vec<Vec3> = slots.iter().map(|&p| cells.points[p as usize] - centre).collect();
    let (some, start) = stand_ins(&slots, slot);
    let step = STEP * (std::f64::consts::PI * radius * radius / some.len() as f64).sqrt();
    if is_smooth(&near, SMOOTH * step) {
        return Vec::new();
    }
    let net: Vec<Vec3> = some.iter().map(|&k| near[k]).collect();
    let ball = Ball::new(&net, step, radius);
    let ways = ball.ways(start, WAY * radius);
    let reached: Vec<Vec3> =
        net.iter().zip(&ways).filter(|(_, way)| **way <= radius).map(|(p, _)| *p).collect();
    let Some(normal) = normal(&reached) else { return Vec::new() };
    let is_other = |p: &Vec3| p.dot(&normal).abs() > OFF * step && ball.is_far(p, &ways, WAY * radius);
    let mut found: Vec<u32> =
        slots.iter().zip(&near).filter(|(_, p)| is_other(p)).map(|(slot, _)| *slot).collect();
    found.sort_unstable();
    found
}

/// Positions in `slots` of the points that paths use: all, or a random choice where there are many; and which of them is the
/// centre.
fn stand_ins(slots: &[u32], centre: u32) -> (Vec<usize>, usize) {
    let one_of = (slots.len() / MOST).max(1) as u64;
    let stands = |k: &usize| slots[*k] == centre || chance(0, u64::from(slots[*k])).is_multiple_of(one_of);
    let some: Vec<usize> = (0..slots.len()).filter(stands).collect();
    let start = some.iter().position(|&k| slots[k] == centre).unwrap_or(0);
    (some, start)
}

/// Whether a paraboloid over the plane of least squares passes all points within `off` [m].
fn is_smooth(near: &[Vec3], off: f64) -> bool {
    let some: Vec<Vec3> = near.iter().copied().step_by(near.len().div_ceil(FITTED)).collect();
    let principal = PrincipalAxes::of(some.iter());
    let ([u, v], up) = (principal.in_plane(), principal.normal());
    let largest = principal.spreads.into_iter().fold(f64::NEG_INFINITY, f64::max);
    if largest <= 0.0 || !largest.is_finite() {
        return true;
    }
    let scale = (largest / some.len() as f64).sqrt();
    let place = |p: &Vec3| {
        let d = p - principal.middle;
        [d.dot(&u) / scale, d.dot(&v) / scale, d.dot(&up)]
    };
    let terms = |[u, v, _]: [f64; 3]| SVector::<f64, 6>::new(1.0, u, v, u * u, u * v, v * v);
    let (mut normal, mut right) = (SMatrix::<f64, 6, 6>::zeros(), SVector::<f64, 6>::zeros());
    for p in &some {
        let at = place(p);
        let row = terms(at);
        normal += row * row.transpose();
        right += row * at[2];
    }
    // Points on a line leave the paraboloid open: a little stiffness closes it.
    normal += SMatrix::<f64, 6, 6>::identity() * (1e-9 * some.len() as f64);
    let Some(solver) = Cholesky::new(normal) else { return false };
    let fit = solver.solve(&right);
    near.iter().all(|p| {
        let at = place(p);
        (at[2] - fit.dot(&terms(at))).abs() <= off
    })
}

/// Normal of the plane of least squares; `None` where points do not span one.
fn normal(points: &[Vec3]) -> Option<Vec3> {
    let principal = PrincipalAxes::of(points.iter());
    let mut sizes = principal.spreads;
    sizes.sort_by(f64::total_cmp);
    // A row of points is no sheet.
    let spans = points.len() >= 3 && sizes[1] > 1e-2 * sizes[2];
    spans.then(|| principal.normal())
}

/// The points of a ball in cells as wide as a step.
struct Ball<'a> {
    near: &'a [Vec3],
    step: f64,
    radius: f64,
    width: f64,
    side: usize,
    /// First place of each cell in `order`, and one more.
    starts: Vec<u32>,
    order: Vec<u32>,
}

impl<'a> Ball<'a> {
    fn new(near: &'a [Vec3], step: f64, radius: f64) -> Ball<'a> {
        let width = step.max(2.0 * radius / CELLS);
        let side = (2.0 * radius / width) as usize + 1;
        let mut ball =
            Ball { near, step, radius, width, side, starts: vec![0; side.pow(3) + 1], order: vec![] };
        let keys: Vec<usize> = near.iter().map(|p| ball.key(ball.cell(p))).collect();
        keys.iter().for_each(|&key| ball.starts[key + 1] += 1);
        (1..ball.starts.len()).for_each(|k| ball.starts[k] += ball.starts[k - 1]);
        let mut next = ball.starts.clone();
        ball.order = vec![0; near.len()];
        for (k, key) in (0..).zip(keys) {
            ball.order[next[key] as usize] = k;
            next[key] += 1;
        }
        ball
    }

    fn cell(&self, p: &Vec3) -> [usize; 3] {
        [0, 1, 2].map(|a| (((p[a] + self.radius) / self.width).max(0.0) as usize).min(self.side - 1))
    }

    fn key(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.side + y) * self.side + x
    }

    /// Length of the shortest way from the point `start` to each one [m], by steps inside the ball; infinite beyond `longest`
    /// (Dijkstra 1959, doi:10.1007/BF01386390).
    fn ways(&self, start: usize, longest: f64) -> Vec<f64> {
        let mut ways = vec![f64::INFINITY; self.near.len()];
        ways[start] = 0.0;
        // Lengths are not negative: their bits are in their order.
        let mut heap = BinaryHeap::from([Reverse((0u64, start as u32))]);
        while let Some(Reverse((bits, at))) = heap.pop() {
            let way = f64::from_bits(bits);
            if way > ways[at as usize] {
                continue;
            }
            self.each_step(&self.near[at as usize], |to, length| {
                let longer = way + length;
                if longer < ways[to as usize] && longer <= longest {
                    ways[to as usize] = longer;
                    heap.push(Reverse((longer.to_bits(), to)));
                }
            });
        }
        ways
    }

    /// Whether a place of the ball is at the end of long ways only; a place without any point within a step is not.
    fn is_far(&self, p: &Vec3, ways: &[f64], longest: f64) -> bool {
        let (mut way, mut alone) = (f64::INFINITY, true);
        self.each_step(p, |from, length| {
            alone = false;
            way = way.min(ways[from as usize] + length);
        });
        !alone && way > longest
    }

    /// Calls `f` with each point within a step of a place, and its distance [m].
    fn each_step(&self, from: &Vec3, mut f: impl FnMut(u32, f64)) {
        let around = |c: usize| c.saturating_sub(1)..(c + 2).min(self.side);
        let [x, y, z] = self.cell(from).map(around);
        for (z, y) in z.flat_map(|z| y.clone().map(move |y| (z, y))) {
            let run = self.starts[self.key([x.start, y, z])]..self.starts[self.key([x.end - 1, y, z]) + 1];
            for &to in &self.order[run.start as usize..run.end as usize] {
                let square = (self.near[to as usize] - from).norm_squared();
                if square <= self.step * self.step {
                    f(to, square.sqrt());
                }
            }
        }
    }
}
