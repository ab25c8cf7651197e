//! Which particles may touch until one leaves its margin: the Verlet list.
//!
//! Every particle has a margin, a ball around the position where it was listed; two are listed when they could touch without
//! leaving their margins: |x_i − x_j| < R_i + R_j, R = r + margin. A fast particle gets a larger margin ([`laws::space::margins`]), so that a few fast ones
//! do not force a rebuild of the whole list, and slow ones are listed with few partners.
//!
//! Verlet (1967), Phys. Rev. 159; a margin for each particle instead of one skin for all. The list is a function of positions and
//! margins alone. Particles are sorted by blocks of about a tile, so that few partners are of another tile, and in these along the shortest
//! side of their box first.

use crate::threads::{each, nth, share, sort};
use geom::grid::bounds;
use geom::{Grid, Vec3};
use laws::space::cell::ImageOf;
use std::ops::Range;

/// Share of the particles that cells are made for; what reaches farther than half a cell is searched one by one.
const COMMON: f64 = 0.98;

/// Skin at the start over the mean radius [–].
pub const FIRST_SKIN: f64 = 0.05;

/// Smallest and largest skin over the mean radius [–].
const SKINS: [f64; 2] = [0.02, 0.6];

/// Steps that lists should hold: if they hold shorter, the skin grows, and if longer, it shrinks.
const HOLD: Range<u64> = 32..96;

/// The skin [m] after lists have held for so many steps with `skin`, for grains of mean radius `grain` [m].
pub fn next_skin(skin: f64, held: u64, grain: f64) -> f64 {
    let factor = if held < HOLD.start {
        1.3
    } else if held > HOLD.end {
        0.9
    } else {
        1.0
    };
    (skin * factor).clamp(SKINS[0] * grain, SKINS[1] * grain)
}

/// Particles of which one thread seeks images.
const PART: usize = 4096;

/// Wide particles of which one thread seeks pairs.
const WIDE_PART: usize = 64;

/// A pair of particles, i < j.
pub type Pair = (u32, u32);

/// Particles in space order, ready to be searched.
pub struct Search {
    grid: Grid,
    axes: [usize; 3],
    /// In the grid's order, and along its axes.
    positions: Vec<Vec3>,
    reach: Vec<f64>,
    /// `reach` of common particles, −∞ of wide ones: nothing is closer than that.
    common: Vec<f64>,
    wide: Vec<u32>,
}

impl Search {
    /// Sorts `points` [m] that reach so far [m].
    pub fn new(points: &[Vec3], reach: &[f64]) -> Search {
        let axes = shortest_first(bounds(points));
        let along = |p: &Vec3| Vec3::new(p[axes[0]], p[axes[1]], p[axes[2]]);
        let cell = cell_width(common_reach(reach));
        let points = each(points.len(), |k| along(&points[k]));
        let grid = Grid::in_blocks(&points, cell, tile(points.len()));
        let order = grid.order();
        let positions = each(order.len(), |k| points[order[k] as usize]);
        let reach = each(order.len(), |k| reach[order[k] as usize]);
        let is_wide = |r: f64| 2.0 * r > grid.cell();
        let wide = (0u32..).zip(&reach).filter(|&(_, &r)| is_wide(r)).map(|(k, _)| k).collect();
        let common = reach.iter().map(|&r| if is_wide(r) { f64::NEG_INFINITY } else { r }).collect();
        Search { axes, positions, reach, common, wide, grid }
    }

    /// The points in space order.
    pub fn order(&self) -> &[u32] {
        self.grid.order()
    }

    /// Pairs whose first is in `range`, both common, by first and second.
    pub fn common_pairs(&self, range: Range<usize>, found: &mut Vec<Pair>) {
        let mut cell = [-1; 3];
        let mut runs: Vec<Range<usize>> = Vec::new();
        for i in range {
            let (p, reach) = (self.positions[i], self.common[i]);
            let here = self.grid.cell_of(&p);
            if here != cell {
                let [x, y, z] = here;
                let rows = (z - 1..z + 2).flat_map(|z| (y - 1..y + 2).map(move |y| (y, z)));
                runs.clear();
                // Pairs with what comes before are found from there.
                runs.extend(rows.flat_map(|(y, z)| self.grid.row(x - 1..x + 2, y, z)).filter(|r| r.end > i));
                runs.sort_unstable_by_key(|r| r.start);
                cell = here;
            }
            for run in &runs {
                for j in run.start.max(i + 1)..run.end.max(i + 1) {
                    let close = reach + self.common[j];
                    if (self.positions[j] - p).norm_squared() < close * close && close > 0.0 {
                        found.push((i as u32, j as u32));
                    }
                }
            }
        }
    }

    /// Pairs with a wide particle, by first and second.
    pub fn wide_pairs(&self) -> Vec<Pair> {
        let parts = self.wide.chunks(WIDE_PART).collect();
        let found = share(self.wide.len() > WIDE_PART, parts, |wide: &[u32]| {
            let mut found = Vec::new();
            wide.iter().for_each(|&w| self.pairs_of_wide(w, &mut found));
            found
        });
        let mut found = found.concat();
        sort(&mut found);
        found
    }

    /// Pairs of a wide particle with those that reach less far: no partner is farther away than twice its own reach.
    fn pairs_of_wide(&self, w: u32, found: &mut Vec<Pair>) {
        let (p, reach) = (self.positions[w as usize], self.reach[w as usize]);
        for j in self.grid.runs_near(p, 2.0 * reach).flatten() {
            let close = reach + self.reach[j];
            if self.is_behind(j, w as usize) && (self.positions[j] - p).norm_squared() < close * close {
                found.push((w.min(j as u32), w.max(j as u32)));
            }
        }
    }

    /// Whether a particle reaches less far than a wide one, which finds their pair; of two equal ones the later finds it.
    fn is_behind(&self, j: usize, w: usize) -> bool {
        self.common[j] > 0.0 || (self.reach[j], j) < (self.reach[w], w)
    }

    /// Pairs whose second is an image of a particle, shifted by `shift` [m], each once; `room` [m] is how much nearer images may come besides.
    pub fn image_pairs(&self, image: ImageOf, shift: &Vec3, room: f64, found: &mut Vec<ImagePair>) {
        let along = Vec3::from(self.axes.map(|a| shift[a]));
        let (lo, hi) = bounds(&self.positions);
        let outside = |p: &Vec3, far: f64| (0..3).any(|a| p[a] < lo[a] - far || p[a] > hi[a] + far);
        let touches = |i: usize, j: usize| {
            let close = self.reach[i] + room + self.reach[j];
            (self.positions[j] - (self.positions[i] - along)).norm_squared() < close * close
        };
        // What a particle may meet at a place within a distance.
        let near = |p: Vec3, far: f64| {
            let runs = (!outside(&p, far)).then(|| self.grid.runs_near(p, far));
            runs.into_iter().flatten().flatten()
        };
        let half = 0.5 * self.grid.cell();
        let of = |k: usize, found: &mut Vec<ImagePair>| {
            let reach = self.reach[k];
            let first = self.positions[k] - along;
            let mut put = |i: usize, j: usize| {
                if touches(i, j) {
                    found.push(ImagePair { i: i as u32, j: j as u32, image });
                }
            };
            if self.common[k] > 0.0 {
                let common = near(first, reach + room + half).filter(|&j| self.common[j] > 0.0);
                return common.for_each(|j| put(k, j));
            }
            let far = 2.0 * reach + room;
            near(first, far).filter(|&j| j == k || self.is_behind(j, k)).for_each(|j| put(k, j));
            let second = self.positions[k] + along;
            near(second, far).filter(|&i| self.is_behind(i, k)).for_each(|i| put(i, k));
        };
        let count = self.positions.len();
        let parts = share(count >= PART, (0..count.div_ceil(PART)).collect(), |part: usize| {
            let mut found = Vec::new();
            (part * PART..count.min((part + 1) * PART)).for_each(|k| of(k, &mut found));
            found
        });
        found.extend(parts.into_iter().flatten());
    }
}

/// A particle, and the image of another across a periodic face.
#[derive(Debug, Clone, Copy)]
pub struct ImagePair {
    /// The particle.
    pub i: u32,
    /// The other particle.
    pub j: u32,
    /// Which of its images.
    pub image: ImageOf,
}

/// The reach [m] that no more than a few particles surpass.
fn common_reach(reach: &[f64]) -> f64 {
    if reach.is_empty() {
        return 1.0;
    }
    nth(reach, common_place(reach.len()))
}

/// Which of so many reaches it is, if they were sorted.
pub fn common_place(count: usize) -> usize {
    (count.saturating_sub(1) as f64 * COMMON) as usize
}

/// Axes, the shortest side of a box first.
pub fn shortest_first((lo, hi): (Vec3, Vec3)) -> [usize; 3] {
    let mut axes = [0, 1, 2];
    axes.sort_by(|&a, &b| (hi[a] - lo[a]).total_cmp(&(hi[b] - lo[b])).then(a.cmp(&b)));
    axes
}

/// Width of the cells [m] that particles are sorted into, by what is common of their reaches [m].
pub fn cell_width(common: f64) -> f64 {
    (2.0 * common).max(f64::MIN_POSITIVE)
}

/// Pairs whose first is in `range`; `wide` are those of the whole search with wide particles.
pub(crate) fn pairs(search: &Search, wide: &[Pair], range: &Range<usize>) -> Vec<Pair> {
    let mut found = Vec::with_capacity(4 * range.len());
    search.common_pairs(range.clone(), &mut found);
    let at = |k: usize| wide.partition_point(|p| (p.0 as usize) < k);
    let wide = &wide[at(range.start)..at(range.end)];
    if !wide.is_empty() {
        found.extend(wide);
        found.sort_unstable();
    }
    found
}

/// Number of particles of a tile. Wrenches between two tiles are kept until the other tile is summed: the larger the tiles, the fewer are kept. But a tile
/// should still be in the cache when it moves, and each thread needs several tiles. It depends on the number of particles alone, because
/// the order of sums depends on it.
pub fn tile(particles: usize) -> usize {
    (particles / TILES).next_multiple_of(LEAST_TILE).clamp(LEAST_TILE, LARGEST_TILE)
}

const TILES: usize = 24;

const LEAST_TILE: usize = 64;

/// Chosen on the bench pile; smaller ones cost more than larger ones.
const LARGEST_TILE: usize = 2048;

#[cfg(test)]
mod tests {
    use super::*;
    use laws::space::cell::Cell;
    use rand_pcg::rand_core::{Rng, SeedableRng};

    /// Grains of which a few reach up to 25 times as far as the others, and several as far as each other, in a box that is periodic along all axes.
    #[test]
    fn it_finds_what_all_distances_say() {
        let mut random = rand_pcg::Pcg64::seed_from_u64(7);
        let mut number = || random.next_u64() as f64 / u64::MAX as f64;
        for (count, largest) in [(1, 0.2), (2, 0.3), (300, 0.05), (3000, 0.25), (3000, 0.01)] {
            let points: Vec<Vec3> =
                (0..count).map(|_| Vec3::new(number(), number(), 0.7 * number())).collect();
            let reach_of = |k: usize, x: f64| {
                if k % 100 == 3 { largest * (0.5 + 0.5 * (4.0 * x).floor() / 4.0) } else { 0.008 + 0.004 * x }
            };
            let reach: Vec<f64> = (0..count).map(|k| reach_of(k, number())).collect();
            let search = Search::new(&points, &reach);
            let at = |n: usize| search.order()[n] as usize;
            let cell = Cell::at_rest([Some((0.0, 1.0)), Some((0.0, 1.0)), Some((0.0, 0.7))]);
            let (all, room) = (0..count, 0.002);
            let near = |i: usize, j: usize, shift: Vec3, room: f64| {
                let close = reach[at(i)] + room + reach[at(j)];
                (points[at(j)] + shift - points[at(i)]).norm() < close
            };
            let expected: Vec<Pair> = all
                .clone()
                .flat_map(|i| (i + 1..count).map(move |j| (i, j)))
                .filter(|&(i, j)| near(i, j, Vec3::zeros(), 0.0))
                .map(|(i, j)| (i as u32, j as u32))
                .collect();
            let found = pairs(&search, &search.wide_pairs(), &(0..count));
            assert!(found == expected, "{count}, {largest}: {} of {}", found.len(), expected.len());
            for image in cell.half_of_images() {
                let shift = cell.shift(&image);
                let mut found = Vec::new();
                search.image_pairs(image, &shift, room, &mut found);
                let mut found: Vec<Pair> = found.into_iter().map(|f| (f.i, f.j)).collect();
                found.sort_unstable();
                let expected: Vec<Pair> = all
                    .clone()
                    .flat_map(|i| (0..count).map(move |j| (i, j)))
                    .filter(|&(i, j)| near(i, j, shift, room))
                    .map(|(i, j)| (i as u32, j as u32))
                    .collect();
                assert!(
                    found == expected,
                    "{count}, {largest}, {image:?}: {} of {}",
                    found.len(),
                    expected.len()
                );
            }
        }
    }
}
