//! Poisson-disk subsampling: no two kept points nearer than the spacing r, no other point farther than r from a kept one.
//!
//! ```text
//! deg(i) = number of open points nearer than r to point i        (counted up to 48)
//! keep open points in the order of (deg(i), hash(seed, i)); a kept point covers those nearer than r: they are open no longer
//! ```
//!
//! Points with few rivals come first, in random order among equals. On a cloud that is hardly denser than the sample, purely random order
//! (Cook 1986, doi:10.1145/7529.8927; Corsini et al. 2012, doi:10.1109/TVCG.2012.34) wastes space. Taking points with few rivals first (the
//! minimum-degree rule for independent sets; Halldórsson & Radhakrishnan 1997, doi:10.1007/BF02523693) needs a larger r for the same count
//! and leaves more even distances, above all if the rivals that are left are counted again and again: the next point is then taken beside
//! those that are kept, as close as it may be. Where very many are open the count is capped, and the order is purely random.
//!
//! The result is the same for any number of threads. The points lie in blocks 16 cells wide (a cell is r or somewhat
//! more). Blocks have eight colours, and blocks of one colour are too far apart to affect each other. The colours are processed one after
//! another, the blocks of a colour at the same time. Of the points of a block the first sixteenth in the order is thrown, then rivals are
//! counted again and the first sixteenth of those still open is thrown, and so on.

use crate::cells::{Cells, apart};
use multiversion::multiversion;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

/// More rivals than this are not told apart: the cost stays linear in the number of points.
const RIVALS: u64 = 48;
/// Bits that these take.
const RANKED: u32 = 8;
/// Width of a block in cells; must be more than 2.
const BLOCK: i64 = 16;
/// One part of so many of the open points is thrown before their rivals are counted again.
const PARTS: usize = 16;
/// At least so many are thrown at once.
const FEW: usize = 32;
/// Points that are compared at once.
const LANES: usize = 8;
/// Stands for no point.
const NO_POINT: f64 = 1e150;

const OPEN: u8 = 0;
const KEPT: u8 = 1;
const COVERED: u8 = 2;

/// Indices of the kept points, ascending. `spacing` [m] is at most the cell width; `forced` points (by index) are all kept.
pub(crate) fn poisson(cells: &Cells, spacing: f64, seed: u64, forced: Option<&[bool]>) -> Vec<u32> {
    let state: Vec<AtomicU8> = (0..cells.len()).map(|_| AtomicU8::new(OPEN)).collect();
    if let Some(forced) = forced {
        keep_forced(cells, spacing, forced, &state);
    }
    for colour in colours(cells) {
        colour.into_par_iter().for_each(|block| throw(cells, spacing, seed, &block, &state));
    }
    kept(cells, &state)
}

/// Indices of the kept points, ascending.
fn kept(cells: &Cells, state: &[AtomicU8]) -> Vec<u32> {
    let mut is_kept = vec![false; cells.len()];
    for (&index, state) in cells.order().iter().zip(state) {
        is_kept[index as usize] = state.load(Relaxed) == KEPT;
    }
    (0..).zip(is_kept).filter(|(_, is_kept)| *is_kept).map(|(index, _)| index).collect()
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
        |slot| {
            cells.each_near(slot, spacing, |other, _| {
                if !forced[cells.order()[other as usize] as usize] {
                    state[other as usize].store(COVERED, Relaxed);
                }
            });
            state[slot as usize].store(KEPT, Relaxed);
        },
    );
}

/// A point that is neither kept nor covered.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Open {
    /// Rivals in the highest byte, then chance.
    rank: u64,
    slot: u32,
}

/// Keeps each point of the block that is still open, points with few rivals first, then in random order, and covers its neighbours.
fn throw(cells: &Cells, spacing: f64, seed: u64, block: &[Range<usize>], state: &[AtomicU8]) {
    let is_open = |slot: u32| state[slot as usize].load(Relaxed) == OPEN;
    let slots = block.iter().cloned().flatten().map(|slot| slot as u32).filter(|&slot| is_open(slot));
    let chance = |slot: u32| chance(seed, cells.order()[slot as usize].into()) >> RANKED;
    let mut open: Vec<Open> = slots.map(|slot| Open { rank: chance(slot), slot }).collect();
    let mut next = Vec::new();
    while !open.is_empty() {
        count_rivals(cells, spacing, state, &mut open);
        next.clone_from(&open);
        let first = (open.len() / PARTS).max(FEW);
        if first < next.len() {
            next.select_nth_unstable(first);
            next.truncate(first);
        }
        next.sort_unstable();
        keep_open(cells, spacing, state, &next);
        open.retain(|point| is_open(point.slot));
    }
}

/// Keeps those of some points, in their order, that are still open.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn keep_open(cells: &Cells, spacing: f64, state: &[AtomicU8], points: &[Open]) {
    for &Open { slot, .. } in points {
        if state[slot as usize].load(Relaxed) == OPEN {
            cover(cells, slot, spacing, state);
            state[slot as usize].store(KEPT, Relaxed);
        }
    }
}

/// Counts the open points nearer than `spacing` [m] to each of some, sorted by slot; itself counts, too. Those around a cell are laid side
/// by side once for all points of the cell.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn count_rivals(cells: &Cells, spacing: f64, state: &[AtomicU8], points: &mut [Open]) {
    let [mut xs, mut ys, mut zs]: [Vec<f64>; 3] = Default::default();
    let (mut around, mut whole) = (u32::MAX, 0);
    for Open { rank, slot } in points {
        let slot = *slot;
        if cells.cell(slot) != around {
            around = cells.cell(slot);
            let mine = |run: &Range<usize>| run.contains(&(slot as usize));
            // Its own row first: it has most of the near ones.
            let runs = || cells.runs(slot).filter(mine).chain(cells.runs(slot).filter(|run| !mine(run)));
            let most = runs().map(|run| run.len()).sum::<usize>() + LANES;
            [&mut xs, &mut ys, &mut zs]
                .into_iter()
                .for_each(|column| column.resize(most.max(column.len()), NO_POINT));
            let mut count = 0;
            for run in runs() {
                for (p, state) in cells.points[run.clone()].iter().zip(&state[run]) {
                    // Without a branch: which points are open cannot be predicted.
                    (xs[count], ys[count], zs[count]) = (p.x, p.y, p.z);
                    count += usize::from(state.load(Relaxed) == OPEN);
                }
            }
            whole = count.next_multiple_of(LANES);
            [&mut xs, &mut ys, &mut zs].into_iter().for_each(|column| column[count..whole].fill(NO_POINT));
        }
        let p = cells.points[slot as usize];
        let mut count = [0u64; LANES];
        let rows = xs[..whole]
            .chunks_exact(LANES)
            .zip(ys[..whole].chunks_exact(LANES))
            .zip(zs[..whole].chunks_exact(LANES));
        for (row, ((xs, ys), zs)) in rows.enumerate() {
            for k in 0..LANES {
                let (x, y, z) = (xs[k] - p.x, ys[k] - p.y, zs[k] - p.z);
                count[k] += (x * x + y * y + z * z < spacing * spacing) as u64;
            }
            if row % 8 == 7 && count.iter().sum::<u64>() >= RIVALS {
                break;
            }
        }
        let rivals = count.iter().sum::<u64>().min(RIVALS);
        *rank = rivals << (64 - RANKED) | *rank & (u64::MAX >> RANKED);
    }
}

/// Covers what is nearer than `spacing` [m].
#[inline(always)]
fn cover(cells: &Cells, slot: u32, spacing: f64, state: &[AtomicU8]) {
    let centre = cells.points[slot as usize];
    for run in cells.runs(slot) {
        // Without a branch: which points are near cannot be predicted. No other thread writes here while this block is processed.
        for (state, point) in state[run.clone()].iter().zip(&cells.points[run]) {
            let is_near = apart(point, &centre) < spacing * spacing;
            let before = state.load(Relaxed);
            state.store(if is_near { COVERED } else { before }, Relaxed);
        }
    }
}

/// Runs of the blocks' slots, by colour.
fn colours(cells: &Cells) -> [Vec<Vec<Range<usize>>>; 8] {
    let mut colours: [Vec<Vec<Range<usize>>>; 8] = Default::default();
    for ([x, y, z], runs) in cells.cubes(BLOCK) {
        let colour = (x & 1) | (y & 1) << 1 | (z & 1) << 2;
        colours[colour as usize].push(runs);
    }
    colours
}
