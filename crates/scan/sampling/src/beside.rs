//! Second pass of a Poisson-disk sample: points that a kept point covers through the air, on another sheet, are opened again.
//!
//! The first pass thins in space. Where its disks reach onto another sheet (see `sheets`), the points there that no disk of
//! their own sheet covers are thrown again, in random order, each against its own sheet. A cloud that is one sheet
//! everywhere keeps the sample of the first pass, bit for bit.

use crate::cells::Cells;
use crate::poisson::chance;
use crate::sheets::others;
use crate::{Distance, Sample};
use rayon::prelude::*;

/// A sample, and how many of its points are nearer than the spacing to one on another sheet.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Thrown {
    /// Indices, ascending.
    pub kept: Vec<u32>,
    /// Points that the second pass added.
    pub beside: usize,
}

impl Thrown {
    /// The sample that it is, found at this spacing [m] after so many tries.
    pub fn into_sample(self, spacing: f64, tries: usize) -> Sample {
        Sample { kept: self.kept, spacing, tries, beside: self.beside }
    }
}

/// Completes a sample `kept` (indices) of the given `spacing` [m], at most the cell width.
pub(crate) fn complete(cells: &Cells, spacing: f64, seed: u64, kept: Vec<u32>, distance: Distance) -> Thrown {
    if distance == Distance::Space {
        return Thrown { kept, beside: 0 };
    }
    let slot_of = cells.slots();
    let lists: Vec<Vec<u32>> =
        kept.par_iter().map(|&i| others(cells, slot_of[i as usize], spacing)).collect();
    let mut open = opened(cells, spacing, &kept, &slot_of, &lists);
    let mut order: Vec<u32> = (0..cells.len() as u32).filter(|&p| open[p as usize]).collect();
    order.sort_unstable_by_key(|&p| (chance(seed, u64::from(cells.order()[p as usize])), p));
    let mut kept = kept;
    let before = kept.len();
    for slot in order {
        if open[slot as usize] {
            let there = others(cells, slot, spacing);
            cells.each_near(slot, spacing, |other, _| {
                open[other as usize] &= there.binary_search(&other).is_ok()
            });
            kept.push(cells.order()[slot as usize]);
        }
    }
    let beside = kept.len() - before;
    kept.sort_unstable();
    Thrown { kept, beside }
}

/// By slot, whether all disks that cover a point are those of another sheet.
fn opened(cells: &Cells, spacing: f64, kept: &[u32], slot_of: &[u32], lists: &[Vec<u32>]) -> Vec<bool> {
    let mut open = vec![false; cells.len()];
    if lists.iter().all(Vec::is_empty) {
        return open;
    }
    let mut from_others = vec![0u32; cells.len()];
    lists.iter().flatten().for_each(|&slot| from_others[slot as usize] += 1);
    let mut is_kept = vec![false; cells.len()];
    kept.iter().for_each(|&i| is_kept[slot_of[i as usize] as usize] = true);
    let covers = |slot: u32| {
        let mut count = 0;
        cells.each_near(slot, spacing, |other, _| count += u32::from(is_kept[other as usize]));
        count
    };
    let is_open =
        |slot: usize| from_others[slot] > 0 && !is_kept[slot] && covers(slot as u32) == from_others[slot];
    open.par_iter_mut().enumerate().for_each(|(slot, open)| *open = is_open(slot));
    open
}
