//! Pairs: which points are neighbours.
//!
//! ```text
//! {i, j} is a pair when no other point k has |k − (i + j)/2| < |i − j|/2   and   |i − j| ≤ 2 max(n_i, n_j)
//! ```
//!
//! n_i is the distance from i to the point nearest to it. The first is the Gabriel graph (Gabriel & Sokal 1969, doi:10.2307/2412323): on
//! an even lattice its edges, without diagonals. The second keeps pairs from reaching across the outline. With i at the origin the ball
//! of i and j holds k where k² < k·j, and whatever is in it is nearer to i than j: i looks no further than 2 n_i, and sees every rival.

use super::equation::ROUNDED;
use geom::Vec3;
use multiversion::multiversion;
use rayon::prelude::*;
use sampling::cells::Cells;

/// A pair is at most this many times as far apart as the farther of its two nearest distances.
const LONGEST: f64 = 2.0;
/// Points farther apart than this many typical distances are no pair.
pub(crate) const FURTHEST: f64 = 6.0;
/// A point as near as this to the border of the ball counts as inside: on a square lattice there is no diagonal.
const ON_BORDER: f64 = 1e-9;
/// Slots are worked on in parts of this many.
const PART: usize = 1024;
/// Points that are compared at once.
const LANES: usize = 8;
/// Stands for no point: in no ball.
const NO_POINT: f64 = 1e150;

/// Width of the cells that [`pairs`] wants, in typical distances.
pub const REACH: f64 = 2.8;

/// Pairs of neighbours, as slots in the order of the cells.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Pairs {
    /// Slots a < b, ascending.
    pub pairs: Vec<(u32, u32)>,
    /// Distance of each pair [m].
    pub lengths: Vec<f64>,
    /// Distance from the point of each slot to the nearest other one [m]; infinite when none is near.
    pub nearest: Vec<f64>,
}

/// The pairs of points whose nearest distance is typically `typical` [m].
pub fn pairs(cells: &Cells, typical: f64) -> Pairs {
    let count = cells.len();
    let parts: Vec<PointPairs> = (0..count.div_ceil(PART))
        .into_par_iter()
        .map(|part| {
            let mut found = PointPairs::default();
            look_all(cells, part * PART..count.min((part + 1) * PART), FURTHEST * typical, &mut found);
            found
        })
        .collect();
    let mut all = Pairs { nearest: Vec::with_capacity(count), ..Pairs::default() };
    all.pairs.reserve_exact(parts.iter().map(|part| part.up.len()).sum());
    all.lengths.reserve_exact(all.pairs.capacity());
    parts.iter().for_each(|part| all.nearest.extend(&part.nearest));
    // From above: what the lower one did not see, because it looks less far.
    let unseen = |link: &&Link| link.square > LONGEST * LONGEST * all.nearest[link.to as usize];
    let mut late: Vec<Link> =
        parts.iter().flat_map(|part| part.down.iter().filter(unseen)).copied().collect();
    late.iter_mut().for_each(|link| (link.from, link.to) = (link.to, link.from));
    late.par_sort_unstable_by_key(|link| (link.from, link.to));
    let mut late = late.into_iter().peekable();
    for link in parts.iter().flat_map(|part| &part.up) {
        while let Some(other) = late.next_if(|other| (other.from, other.to) < (link.from, link.to)) {
            all.push(&other);
        }
        all.push(link);
    }
    late.for_each(|link| all.push(&link));
    all.nearest.iter_mut().for_each(|square| *square = square.sqrt());
    all
}

impl Pairs {
    fn push(&mut self, link: &Link) {
        self.pairs.push((link.from, link.to));
        self.lengths.push(link.square.sqrt());
    }
}

/// A neighbour of a point.
#[derive(Debug, Clone, Copy)]
struct Link {
    from: u32,
    to: u32,
    /// Squared distance [m²].
    square: f64,
}

/// The neighbours that one task found.
#[derive(Default)]
struct PointPairs {
    /// Squared [m²].
    nearest: Vec<f64>,
    /// To higher slots, ascending.
    up: Vec<Link>,
    /// To lower slots.
    down: Vec<Link>,
    work: PairScratch,
}

/// Buffers that every point uses again.
#[derive(Default)]
struct PairScratch {
    /// Squared distances of the candidates [m²].
    squares: Vec<f64>,
    /// Slots of the points near by, ascending.
    near: Vec<u32>,
    /// The same points from the one in the middle [m], and their squared distances; filled up with [`NO_POINT`].
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    square: Vec<f64>,
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn look_all(cells: &Cells, slots: std::ops::Range<usize>, furthest: f64, part: &mut PointPairs) {
    for slot in slots {
        look(cells, slot as u32, furthest, part);
    }
}

#[inline(always)]
fn look(cells: &Cells, slot: u32, furthest: f64, part: &mut PointPairs) {
    let centre = cells.points[slot as usize];
    let PointPairs { nearest, up, down, work } = part;
    let mut runs = [(0, 0); 9];
    let mut used = 0;
    for run in cells.runs(slot) {
        runs[used] = (run.start as u32, run.end as u32);
        used += 1;
    }
    let runs = &runs[..used];
    let mut least = work.measure(cells, slot, centre, runs);
    // The square of 2 n is exactly 4 n²: from both ends, a pair is as long.
    let most = |least: f64| (LONGEST * LONGEST * least).min(furthest * furthest);
    if LONGEST * least.sqrt() > cells.width {
        // The nearest itself may be beyond what was looked at.
        let reach = (LONGEST * least.sqrt()).min(furthest) * ROUNDED;
        let wide = cells.grid.runs_near(centre, reach).map(|run| (run.start as u32, run.end as u32));
        let wide: Vec<(u32, u32)> = wide.collect();
        least = work.measure(cells, slot, centre, &wide);
        work.gather(cells, centre, &wide, most(least));
    } else {
        work.gather(cells, centre, runs, most(least));
    }
    nearest.push(if least <= furthest * furthest { least } else { f64::INFINITY });
    for (at, &to) in work.near.iter().enumerate() {
        if work.is_pair(at) {
            let link = Link { from: slot, to, square: work.square[at] };
            if to > slot { up.push(link) } else { down.push(link) }
        }
    }
}

impl PairScratch {
    /// Squared distances of the points of `runs`; the least of them, without the point itself.
    #[inline(always)]
    fn measure(&mut self, cells: &Cells, slot: u32, centre: Vec3, runs: &[(u32, u32)]) -> f64 {
        self.squares.clear();
        for &(from, to) in runs {
            let points = &cells.points[from as usize..to as usize];
            let first = self.squares.len();
            self.squares.extend(points.iter().map(|p| square(p, &centre)));
            if (from..to).contains(&slot) {
                self.squares[first + (slot - from) as usize] = f64::INFINITY;
            }
        }
        // Eight at a time: the least is the same in any order.
        let mut least = [f64::INFINITY; LANES];
        let mut chunks = self.squares.chunks_exact(LANES);
        for chunk in &mut chunks {
            for k in 0..LANES {
                least[k] = if chunk[k] < least[k] { chunk[k] } else { least[k] };
            }
        }
        least.iter().chain(chunks.remainder()).copied().fold(f64::INFINITY, f64::min)
    }

    /// The measured points whose squared distance is at most `most` [m²].
    #[inline(always)]
    fn gather(&mut self, cells: &Cells, centre: Vec3, runs: &[(u32, u32)], most: f64) {
        self.near.clear();
        self.near.resize(self.squares.len(), 0);
        let (mut count, mut at) = (0, 0);
        for &(from, to) in runs {
            // Without a branch: which points are near cannot be predicted.
            for (slot, &square) in (from..to).zip(&self.squares[at..]) {
                self.near[count] = slot;
                count += (square <= most) as usize;
            }
            at += (to - from) as usize;
        }
        self.near.truncate(count);
        let padded = count.next_multiple_of(LANES);
        for column in [&mut self.x, &mut self.y, &mut self.z, &mut self.square] {
            column.clear();
            column.resize(padded, NO_POINT);
        }
        for (k, &slot) in self.near.iter().enumerate() {
            let to = cells.points[slot as usize] - centre;
            (self.x[k], self.y[k], self.z[k]) = (to.x, to.y, to.z);
            self.square[k] = square(&cells.points[slot as usize], &centre);
        }
        self.square[count..].fill(NO_POINT * NO_POINT);
    }

    /// Whether no other point lies in the ball of the point in the middle and the one at `at`.
    #[inline(always)]
    fn is_pair(&self, at: usize) -> bool {
        let (x, y, z) = (self.x[at], self.y[at], self.z[at]);
        let border = ON_BORDER * self.square[at];
        let rows = self.x.chunks_exact(LANES).zip(self.y.chunks_exact(LANES));
        let rows = rows.zip(self.z.chunks_exact(LANES)).zip(self.square.chunks_exact(LANES));
        // The point itself lies on the border, and counts once.
        let mut inside = 0;
        for (((xs, ys), zs), squares) in rows {
            let mut here = [0u64; LANES];
            for k in 0..LANES {
                here[k] = (squares[k] - (xs[k] * x + ys[k] * y + zs[k] * z) < border) as u64;
            }
            inside += here.iter().sum::<u64>();
        }
        inside == 1
    }
}

#[inline(always)]
fn square(p: &Vec3, q: &Vec3) -> f64 {
    let (x, y, z) = (p.x - q.x, p.y - q.y, p.z - q.z);
    x * x + y * y + z * z
}
