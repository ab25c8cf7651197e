//! Mean distances from each point to its nearest others, by a grid whose cells are about as wide as these distances.
//!
//! All points of a cell share their candidates: the points of the cells around it, which lie together in sorted order. The k nearest of the
//! candidates are the k nearest of all if they are no farther than the border of those cells; else more cells are looked at, then wider
//! ones. What is farther still is found among all points: one by one while few are left, by a tree otherwise.

use super::smallest::{Smallest, squares};
use geom::{Grid, Vec3};
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use multiversion::multiversion;
use rayon::prelude::*;
use std::num::NonZero;

/// Points whose distances are measured to choose the width of cells.
const SAMPLE: usize = 32;
/// Of these distances, sorted, the share that a cell is as wide as [–].
const SHARE: f64 = 0.75;
/// How many cells around that of the point are looked at, one after the other.
const RINGS: [i64; 2] = [1, 2];
/// Widths of cells, one after the other, each so many times the one before.
const WIDER: f64 = 4.0;
/// How many such widths of cells are tried.
const LEVELS: usize = 3;
/// Clouds of fewer points have no grid.
const FEW: usize = 4096;
/// Distances that may be measured one by one before a tree is made.
const ONE_BY_ONE: usize = 500_000_000;
/// Candidates for each neighbour, and beside them, up to which a cell of more than [`SPARSE`] points is looked at: where a part of the
/// cloud is much denser than most, a tree is faster.
const DENSE: (usize, usize) = (32, 256);
/// See [`DENSE`].
const SPARSE: usize = 8;
/// Of the square of the distance to its last neighbour, the share up to which the nearest of the next point are looked for first [–].
const MORE: f64 = 1.4;
/// Squares that are chosen from at once.
const PART: usize = 64;
/// Cells that one thread takes at a time.
const CELLS: usize = 256;

/// Mean distance [m] from each of the finite `points` [m] to its `k` nearest others.
pub(crate) fn mean_distances(points: &[Vec3], k: usize) -> Vec<f64> {
    let k = k.min(points.len().saturating_sub(1));
    if k == 0 {
        return vec![0.0; points.len()];
    }
    let all: Vec<u32> = (0..points.len() as u32).collect();
    let width = if points.len() < FEW { 0.0 } else { width(points, k) };
    if !(width > 0.0) {
        return by_tree(points, &all, k);
    }
    let mut means = vec![f64::NAN; points.len()];
    let mut far = all;
    for level in 0..LEVELS as i32 {
        if far.len() * points.len() > ONE_BY_ONE {
            Sorted::new(points, width * WIDER.powi(level)).add(&mut means, k, level == 0);
            far.retain(|&i| means[i as usize].is_nan());
        }
    }
    let rest = match far.len() * points.len() <= ONE_BY_ONE {
        true => far.par_iter().map(|&i| mean(&nearest(points, &points[i as usize], k))).collect(),
        false => by_tree(points, &far, k),
    };
    far.iter().zip(rest).for_each(|(&i, mean)| means[i as usize] = mean);
    means
}

/// Squares of the distances from `p` to the `k` + 1 nearest of all points, ascending.
fn nearest(points: &[Vec3], p: &Vec3, k: usize) -> Vec<f64> {
    let mut found = vec![f64::INFINITY; k + 1];
    for q in points {
        let square = (p - q).norm_squared();
        if square < found[k] {
            insert(&mut found, square);
        }
    }
    found
}

/// Puts a square where it belongs; the last goes.
fn insert(ascending: &mut [f64], square: f64) {
    let place = ascending.partition_point(|&s| s <= square);
    let last = ascending.len() - 1;
    ascending.copy_within(place..last, place + 1);
    ascending[place] = square;
}

/// The mean distance to the others, of the squares of the distances to a point itself and its nearest others, ascending.
fn mean(nearest: &[f64]) -> f64 {
    let sum: f64 = nearest.iter().map(|square| square.sqrt()).sum();
    sum / (nearest.len() - 1) as f64
}

/// About the distance to the `k`-th neighbour [m].
fn width(points: &[Vec3], k: usize) -> f64 {
    let sample: Vec<Vec3> = points.iter().step_by(points.len().div_ceil(SAMPLE)).copied().collect();
    let mut distances: Vec<f64> =
        nearest_of_sample(points, &sample, k).iter().map(|squares| squares[k].sqrt()).collect();
    distances.sort_by(f64::total_cmp);
    distances[(SHARE * (distances.len() - 1) as f64) as usize]
}

/// As [`nearest`], for each of up to [`SAMPLE`] points at once: all points are read once.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn nearest_of_sample(points: &[Vec3], sample: &[Vec3], k: usize) -> Vec<Vec<f64>> {
    let of: [[f64; SAMPLE]; 3] =
        [0, 1, 2].map(|axis| std::array::from_fn(|i| sample.get(i).map_or(f64::NAN, |p| p[axis])));
    let mut found = vec![vec![f64::INFINITY; k + 1]; sample.len()];
    let mut most = [f64::INFINITY; SAMPLE];
    for q in points {
        let mut squares = [0.0; SAMPLE];
        let mut near = false;
        for i in 0..SAMPLE {
            let (x, y, z) = (of[0][i] - q.x, of[1][i] - q.y, of[2][i] - q.z);
            squares[i] = x * x + y * y + z * z;
            near |= squares[i] < most[i];
        }
        if near {
            for ((found, most), square) in found.iter_mut().zip(&mut most).zip(squares) {
                if square < *most {
                    insert(found, square);
                    *most = found[k];
                }
            }
        }
    }
    found
}

fn by_tree(points: &[Vec3], rows: &[u32], k: usize) -> Vec<f64> {
    let positions: Vec<[f64; 3]> = points.iter().map(|p| [p.x, p.y, p.z]).collect();
    let (Some(and_self), Ok(tree)) =
        (NonZero::new(k + 1), ImmutableKdTree::<f64, 3>::new_from_slice(&positions))
    else {
        return vec![0.0; rows.len()];
    };
    let mean = |&row: &u32| {
        let query = tree.query(&positions[row as usize]);
        let found = query.nearest_n::<SquaredEuclidean<f64>>(and_self).execute();
        found.iter().map(|n| n.distance.sqrt()).sum::<f64>() / k as f64
    };
    rows.par_iter().map(mean).collect()
}

/// Points in the order of a grid.
struct Sorted {
    grid: Grid,
    points: Vec<Vec3>,
    low: Vec3,
}

impl Sorted {
    fn new(points: &[Vec3], width: f64) -> Sorted {
        let grid = Grid::new(points, width);
        let low = geom::grid::bounds(points).0;
        let points = grid.order().par_iter().map(|&i| points[i as usize]).collect();
        Sorted { grid, points, low }
    }

    /// Adds the means that are missing (NaN), where no nearest point may be farther away than [`RINGS`]; all are missing of
    /// `fresh` ones.
    fn add(&self, means: &mut [f64], k: usize, fresh: bool) {
        let (keys, starts) = self.grid.filled();
        let cells: Vec<[usize; 2]> =
            starts.windows(2).map(|run| [run[0] as usize, run[1] as usize]).collect();
        let order = self.grid.order();
        let known = &*means;
        let parts: Vec<Vec<f64>> = cells
            .par_chunks(CELLS)
            .map(|cells| {
                let mut candidates = Candidates::new(self, &keys, &starts);
                let mut found = Vec::new();
                for &[from, to] in cells {
                    let first = found.len();
                    match fresh {
                        true => found.resize(first + to - from, f64::NAN),
                        false => found.extend(order[from..to].iter().map(|&i| known[i as usize])),
                    }
                    self.cell(&self.points[from..to], k, &mut candidates, &mut found[first..]);
                }
                found
            })
            .collect();
        let found = parts.iter().flatten();
        order.iter().zip(found).for_each(|(&i, &mean)| means[i as usize] = mean);
    }

    /// Finds the means that are missing of the points of a cell.
    fn cell(&self, points: &[Vec3], k: usize, candidates: &mut Candidates, means: &mut [f64]) {
        let cell = self.grid.cell_of(&points[0]);
        for (level, ring) in RINGS.into_iter().enumerate() {
            let open = means.iter().filter(|mean| mean.is_nan()).count();
            if open == 0 {
                return;
            }
            candidates.gather(cell, level);
            let count = candidates.squares.len();
            if open > SPARSE && count > DENSE.0 * (k + 1) + DENSE.1 {
                return;
            }
            for (found, p) in means.iter_mut().zip(points).filter(|(mean, _)| mean.is_nan()) {
                if let Some(nearest) = candidates.nearest(p, k, self.reach(p, cell, ring)) {
                    *found = mean(nearest);
                }
            }
        }
    }

    /// No point outside of the cells `ring` around `cell` is nearer to `p` than this [m].
    fn reach(&self, p: &Vec3, cell: [i64; 3], ring: i64) -> f64 {
        let width = self.grid.cell();
        let axis = |a: usize| {
            let at = p[a] - self.low[a];
            let (before, behind) = ((cell[a] - ring) as f64 * width, (cell[a] + ring + 1) as f64 * width);
            (at - before).min(behind - at)
        };
        // A little less: a point at a border may be on either side of it by rounding.
        axis(0).min(axis(1)).min(axis(2)) * (1.0 - 1e-9) - 1e-12 * width
    }
}

/// Writes the squares that are not above `most` to the front of `chosen`; how many.
fn choose(squares: &[f64], most: f64, chosen: &mut [f64]) -> usize {
    let mut count = 0;
    for squares in squares.chunks(PART) {
        // Without a branch: each is written, and only what is near stays.
        let (mut few, mut near) = ([0.0; PART], 0);
        for &square in squares {
            few[near % PART] = square;
            near += usize::from(square <= most);
        }
        chosen[count..count + near].copy_from_slice(&few[..near]);
        count += near;
    }
    count
}

/// Points near a cell.
struct Candidates<'a> {
    sorted: &'a Sorted,
    /// The cells that hold points, by their numbers in the grid, and where the points of each begin.
    keys: &'a [u64],
    starts: &'a [u32],
    /// For each ring and row of cells in it, where the last search ended: cells are asked for in the order of their numbers.
    ends: [Vec<Option<usize>>; RINGS.len()],
    points: Vec<Vec3>,
    /// Squares of their distances from a point, and those of them that may be among the nearest.
    squares: Vec<f64>,
    near: Vec<f64>,
    /// The square below which the nearest of the point before were, and some more.
    usual: f64,
    smallest: Smallest,
}

impl<'a> Candidates<'a> {
    fn new(sorted: &'a Sorted, keys: &'a [u64], starts: &'a [u32]) -> Candidates<'a> {
        let ends = RINGS.map(|ring| vec![None; ((2 * ring + 1) * (2 * ring + 1)) as usize]);
        Candidates {
            sorted,
            keys,
            starts,
            ends,
            points: vec![],
            squares: vec![],
            near: vec![],
            usual: f64::INFINITY,
            smallest: Smallest::new(),
        }
    }

    /// Takes the points of the cells around one; of each ring, cells come in the order of their numbers.
    fn gather(&mut self, [x, y, z]: [i64; 3], level: usize) {
        self.points.clear();
        let (ring, [nx, ny, nz]) = (RINGS[level], self.sorted.grid.dims());
        let rows = (z - ring..=z + ring).flat_map(|z| (y - ring..=y + ring).map(move |y| (z, y)));
        for ((z, y), end) in rows.zip(&mut self.ends[level]) {
            if !(0..nz).contains(&z) || !(0..ny).contains(&y) {
                continue;
            }
            let row = (z * ny + y) * nx;
            let [low, high] = [(x - ring).max(0), (x + ring).min(nx - 1)].map(|x| (row + x) as u64);
            let mut at = end.unwrap_or_else(|| self.keys.partition_point(|&key| key < low));
            while self.keys.get(at).is_some_and(|&key| key < low) {
                at += 1;
            }
            *end = Some(at);
            let count = self.keys[at..].iter().take_while(|&&key| key <= high).count();
            let run = self.starts[at] as usize..self.starts[at + count] as usize;
            self.points.extend_from_slice(&self.sorted.points[run]);
        }
        self.squares.resize(self.points.len(), 0.0);
        self.near.resize(self.points.len(), 0.0);
    }

    /// As [`nearest`], if so many candidates are within `reach` [m].
    fn nearest(&mut self, p: &Vec3, k: usize, reach: f64) -> Option<&[f64]> {
        let most = if reach > 0.0 { reach * reach } else { return None };
        squares(p, &self.points, &mut self.squares);
        // The point before is near: few are as near as its neighbours were, and these are soon sorted.
        let mut count = choose(&self.squares, most.min(self.usual), &mut self.near);
        if count <= k && self.usual < most {
            count = choose(&self.squares, most, &mut self.near);
        }
        if count <= k {
            return None;
        }
        let nearest = self.smallest.of(&mut self.near[..count], k + 1);
        self.usual = MORE * nearest[k];
        Some(nearest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(i: u32, s: u32) -> f64 {
        f64::from(i.wrapping_mul(2_654_435_761).rotate_left(s) % 10_000) / 10_000.0
    }

    /// A surface with noise, a sparse part, points far away, and several at one place.
    fn cloud() -> Vec<Vec3> {
        let on = |i: u32| Vec3::new(noise(i, 1), noise(i, 9), 0.002 * noise(i, 17));
        let sparse = |i: u32| Vec3::new(2.0 + 9.0 * noise(i, 3), 7.0 * noise(i, 11), noise(i, 19));
        let mut points: Vec<Vec3> = (0..9000).map(on).chain((0..300).map(sparse)).collect();
        points.extend((0..20).map(|i| Vec3::new(1e3 * f64::from(i), -1e4, 0.0)));
        points.extend([Vec3::new(0.5, 0.5, 0.0); 40]);
        points
    }

    /// Every bit, whatever way a distance was found.
    #[test]
    fn are_those_of_a_tree() {
        let points = cloud();
        let all: Vec<u32> = (0..points.len() as u32).collect();
        for k in [1, 7, 12, 60] {
            let (found, wanted) = (mean_distances(&points, k), by_tree(&points, &all, k));
            let wrong = found.iter().zip(&wanted).position(|(a, b)| a.to_bits() != b.to_bits());
            assert_eq!(wrong, None, "k = {k}");
        }
    }
}
