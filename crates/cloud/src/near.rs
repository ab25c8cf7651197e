//! Mean distances from each point to its nearest others, by a grid whose cells are about as wide as these distances.
//!
//! All points of a cell share their candidates: the points of the cells around it, which lie together in sorted order. The k nearest of the
//! candidates are the k nearest of all if they are no farther than the border of those cells; else more cells are looked at, then wider
//! ones. What is farther still is found among all points: one by one while few are left, by a tree otherwise.

use geom::{Grid, Vec3};
use kiddo::{ImmutableKdTree, SquaredEuclidean};
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
/// How many widths.
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
            Sorted::new(points, width * WIDER.powi(level)).add(&mut means, k);
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
fn nearest(points: &[Vec3], p: &Vec3, k: usize) -> Vec<u64> {
    let mut found = vec![u64::MAX; k + 1];
    for q in points {
        let square = square([p.x - q.x, p.y - q.y, p.z - q.z]);
        if square < found[k] {
            let place = found.partition_point(|&s| s <= square);
            found.copy_within(place..k, place + 1);
            found[place] = square;
        }
    }
    found
}

/// A square of a distance, as the bits of the number: they have the order of the numbers, which are not negative.
fn square([x, y, z]: [f64; 3]) -> u64 {
    (x * x + y * y + z * z).to_bits()
}

/// The mean distance to the others, of the squares of the distances to a point itself and its nearest others, ascending.
fn mean(nearest: &[u64]) -> f64 {
    let sum: f64 = nearest.iter().map(|&square| f64::from_bits(square).sqrt()).sum();
    sum / (nearest.len() - 1) as f64
}

/// About the distance to the `k`-th neighbour [m].
fn width(points: &[Vec3], k: usize) -> f64 {
    let step = points.len().div_ceil(SAMPLE);
    let rows: Vec<usize> = (0..points.len()).step_by(step).collect();
    let farthest = |&row: &usize| f64::from_bits(nearest(points, &points[row], k)[k]).sqrt();
    let mut distances: Vec<f64> = rows.par_iter().map(farthest).collect();
    distances.sort_by(f64::total_cmp);
    distances[(SHARE * (distances.len() - 1) as f64) as usize]
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

    /// Adds the means that are missing (NaN), where no nearest point may be farther away than [`RINGS`].
    fn add(&self, means: &mut [f64], k: usize) {
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
                    found.extend(order[from..to].iter().map(|&i| known[i as usize]));
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
            let count = candidates.x.len();
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

/// Points near a cell.
struct Candidates<'a> {
    sorted: &'a Sorted,
    /// The cells that hold points, by their numbers in the grid, and where the points of each begin.
    keys: &'a [u64],
    starts: &'a [u32],
    /// For each ring and row of cells in it, where the last search ended: cells are asked for in the order of their numbers.
    ends: [Vec<Option<usize>>; RINGS.len()],
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    /// See [`square`].
    squares: Vec<u64>,
}

impl<'a> Candidates<'a> {
    fn new(sorted: &'a Sorted, keys: &'a [u64], starts: &'a [u32]) -> Candidates<'a> {
        let ends = RINGS.map(|ring| vec![None; ((2 * ring + 1) * (2 * ring + 1)) as usize]);
        Candidates { sorted, keys, starts, ends, x: vec![], y: vec![], z: vec![], squares: vec![] }
    }

    /// Takes the points of the cells around one; of each ring, cells come in the order of their numbers.
    fn gather(&mut self, [x, y, z]: [i64; 3], level: usize) {
        self.x.clear();
        self.y.clear();
        self.z.clear();
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
            for p in &self.sorted.points[self.starts[at] as usize..self.starts[at + count] as usize] {
                self.x.push(p.x);
                self.y.push(p.y);
                self.z.push(p.z);
            }
        }
    }

    /// As [`nearest`], if so many candidates are within `reach` [m].
    fn nearest(&mut self, p: &Vec3, k: usize, reach: f64) -> Option<&[u64]> {
        let most = if reach > 0.0 { (reach * reach).to_bits() } else { return None };
        let places = self.x.iter().zip(&self.y).zip(&self.z);
        let squares = places.map(|((x, y), z)| square([p.x - x, p.y - y, p.z - z]));
        // Without a branch: each is written, and only what is near stays.
        self.squares.resize(self.x.len() + 1, 0);
        let mut count = 0;
        for square in squares {
            self.squares[count] = square;
            count += usize::from(square <= most);
        }
        if count <= k {
            return None;
        }
        let near = &mut self.squares[..count];
        near.select_nth_unstable(k);
        let found = &mut near[..=k];
        found.sort_unstable();
        Some(found)
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
