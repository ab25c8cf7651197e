//! Poisson-disk subsampling: no two kept points nearer than the spacing r, no other point farther than r from a kept one.
//!
//! ```text
//! deg(i) = number of input points nearer than r to point i       (counted up to 48)
//! keep i when no point nearer than r has been kept; in the order of (deg(i), hash(seed, i))
//! ```
//!
//! Loneliest first, chance among equals. On a cloud that is hardly denser than the sample, plain chance
//! (Cook 1986, doi:10.1145/8927.8928; Corsini et al. 2012, doi:10.1109/TVCG.2012.34) wastes room: taking points with few
//! rivals first (the minimum-degree rule for independent sets; Halldórsson & Radhakrishnan 1997, doi:10.1007/BF02523693)
//! needs a larger r for the same count and leaves more even distances. Where the input is
//! dense the count is capped, and the order is chance alone.
//!
//! Parallel with the same result for any number of threads: the points lie in blocks 16 r wide, blocks have
//! eight colours, and blocks of one colour are too far apart to meet. Colours are served in
//! turn, the blocks of a colour at the same time.

use crate::cells::Cells;
use geom::Grid;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

/// More rivals than this are not told apart: the cost stays linear in the number of points.
const RIVALS: u32 = 48;
/// Width of a block in spacings; must be more than 2.
const BLOCK: f64 = 16.0;

const OPEN: u8 = 0;
const KEPT: u8 = 1;
const COVERED: u8 = 2;

/// Indices of the kept points, ascending. `spacing` [m] is at most the cell width; `forced` points (by index) are all kept.
pub(crate) fn poisson(cells: &Cells, spacing: f64, seed: u64, forced: Option<&[bool]>) -> Vec<u32> {
    let state: Vec<AtomicU8> = (0..cells.len()).map(|_| AtomicU8::new(OPEN)).collect();
    if let Some(forced) = forced {
        keep_forced(cells, spacing, forced, &state);
    }
    let rank = cells.map(|place| rank(cells, place, spacing, seed));
    let blocks = Grid::new(&cells.points, BLOCK * spacing);
    for colour in colours(&blocks) {
        colour.into_par_iter().for_each(|run| {
            let mut block = blocks.order()[run].to_vec();
            block.sort_unstable_by_key(|&place| (rank[place as usize], place));
            throw(cells, spacing, &block, &state);
        });
    }
    let is_kept = |place: &usize| state[*place].load(Relaxed) == KEPT;
    let mut kept: Vec<u32> = (0..cells.len()).filter(is_kept).map(|place| cells.order()[place]).collect();
    kept.par_sort_unstable();
    kept
}

/// Few rivals first, then by chance.
fn rank(cells: &Cells, place: u32, spacing: f64, seed: u64) -> u64 {
    let rivals = cells.count_near(place, spacing, RIVALS).min(RIVALS);
    (rivals as u64) << 56 | chance(seed, cells.order()[place as usize] as u64) >> 8
}

/// A number that depends on the seed and the point's index only (two rounds of splitmix64, Steele et al. 2014).
pub(crate) fn chance(seed: u64, index: u64) -> u64 {
    let mix = |x: u64| {
        let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    };
    mix(mix(seed.wrapping_add(0x9e37_79b9_7f4a_7c15)).wrapping_add(index.wrapping_mul(0x9e37_79b9_7f4a_7c15)))
}

fn keep_forced(cells: &Cells, spacing: f64, forced: &[bool], state: &[AtomicU8]) {
    (0..cells.len() as u32).into_par_iter().filter(|&p| forced[cells.order()[p as usize] as usize]).for_each(
        |place| {
            cells.each_near(place, spacing, |other, _| {
                if !forced[cells.order()[other as usize] as usize] {
                    state[other as usize].store(COVERED, Relaxed);
                }
            });
            state[place as usize].store(KEPT, Relaxed);
        },
    );
}

/// Keeps each point of the block that is still open, in the given order, and covers its neighbours.
fn throw(cells: &Cells, spacing: f64, block: &[u32], state: &[AtomicU8]) {
    for &place in block {
        if state[place as usize].load(Relaxed) != OPEN {
            continue;
        }
        cells.each_near(place, spacing, |other, _| state[other as usize].store(COVERED, Relaxed));
        state[place as usize].store(KEPT, Relaxed);
    }
}

/// Runs of the blocks' order, by colour.
fn colours(blocks: &Grid) -> [Vec<Range<usize>>; 8] {
    let mut colours: [Vec<Range<usize>>; 8] = Default::default();
    let ([nx, ny, _], (keys, starts)) = (blocks.dims().map(|n| n as u64), blocks.filled());
    for (key, run) in keys.into_iter().zip(starts.windows(2)) {
        let [x, y, z] = [key % nx, key / nx % ny, key / nx / ny];
        let colour = (x & 1) | (y & 1) << 1 | (z & 1) << 2;
        colours[colour as usize].push(run[0] as usize..run[1] as usize);
    }
    colours
}
