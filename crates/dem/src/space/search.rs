//! Which particles may touch until one leaves its margin: the Verlet list.
//!
//! Every particle has a margin, a ball around the position where it was listed; two are listed when they could touch without
//! leaving their margins: |x_i − x_j| < R_i + R_j, R = r + margin. A fast particle gets a larger margin ([`margin`]), so that a few fast ones
//! do not force a rebuild of the whole list, and slow ones are listed with few partners.
//!
//! Verlet (1967), Phys. Rev. 159; a margin for each particle instead of one skin for all. The list is a function of positions and
//! margins alone. Particles are sorted by blocks of about a tile, so that few partners are of another tile, and in these along the shortest
//! side of their box first.

use crate::space::cell::ImageOf;
use crate::threads::{each, nth, share, sort};
use geom::grid::bounds;
use geom::{Grid, Vec3};
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

/// Room of a particle [m]: a share of the skin, and the `way` that it is expected to go, but no more than `most`: beyond, lists that
/// hold longer would cost more than they save.
pub fn margin(skin: f64, way: f64, most: f64) -> f64 {
    0.5 * skin + way.min(most)
}

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
    largest: f64,
}

impl Search {
    /// Sorts `points` [m] that reach so far [m].
    pub fn new(points: &[Vec3], reach: &[f64]) -> Search {
        let (lo, hi) = bounds(points);
        let mut axes = [0, 1, 2];
        axes.sort_by(|&a, &b| (hi[a] - lo[a]).total_cmp(&(hi[b] - lo[b])).then(a.cmp(&b)));
        let along = |p: &Vec3| Vec3::new(p[axes[0]], p[axes[1]], p[axes[2]]);
        let cell = (2.0 * common_reach(reach)).max(f64::MIN_POSITIVE);
        let points = each(points.len(), |k| along(&points[k]));
        let grid = Grid::in_blocks(&points, cell, tile(points.len()));
        let order = grid.order();
        let positions = each(order.len(), |k| points[order[k] as usize]);
        let reach = each(order.len(), |k| reach[order[k] as usize]);
        let is_wide = |r: f64| 2.0 * r > grid.cell();
        let wide = (0u32..).zip(&reach).filter(|&(_, &r)| is_wide(r)).map(|(k, _)| k).collect();
        let common = reach.iter().map(|&r| if is_wide(r) { f64::NEG_INFINITY } else { r }).collect();
        let largest = reach.iter().copied().fold(0.0, f64::max);
        Search { axes, positions, reach, common, wide, largest, grid }
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

    fn pairs_of_wide(&self, w: u32, found: &mut Vec<Pair>) {
        let (p, reach) = (self.positions[w as usize], self.reach[w as usize]);
        for j in self.grid.runs_near(p, reach + self.largest).flatten() {
            let close = reach + self.reach[j];
            let once = j != w as usize && (self.common[j] > 0.0 || j > w as usize);
            if once && (self.positions[j] - p).norm_squared() < close * close {
                found.push((w.min(j as u32), w.max(j as u32)));
            }
        }
    }

    /// Pairs whose second is an image of a particle, shifted by `shift` [m], by first; `room` [m] is how much nearer images may come besides.
    pub fn image_pairs(&self, image: ImageOf, shift: &Vec3, room: f64, found: &mut Vec<ImagePair>) {
        let along = Vec3::from(self.axes.map(|a| shift[a]));
        let (lo, hi) = bounds(&self.positions);
        let count = self.positions.len();
        let parts = share(count >= PART, (0..count.div_ceil(PART)).collect(), |part: usize| {
            let mut found = Vec::new();
            for i in part * PART..count.min((part + 1) * PART) {
                let mine = self.reach[i] + room;
                let (position, far) = (self.positions[i] - along, mine + self.largest);
                if (0..3).any(|a| position[a] < lo[a] - far || position[a] > hi[a] + far) {
                    continue;
                }
                for j in self.grid.runs_near(position, far).flatten() {
                    let close = mine + self.reach[j];
                    if (self.positions[j] - position).norm_squared() < close * close {
                        found.push(ImagePair { i: i as u32, j: j as u32, image });
                    }
                }
            }
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
    nth(reach, ((reach.len() - 1) as f64 * COMMON) as usize)
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
