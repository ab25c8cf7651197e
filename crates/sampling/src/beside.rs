//! Second pass of a Poisson-disk sample: points that a kept point covers through the air, on another sheet, are opened again.
//!
//! The first pass thins in space. Where its disks reach onto another sheet (see `sheets`), the points there that no disk of
//! their own sheet covers are thrown again, in random order, each against its own sheet. A cloud that is one sheet
//! everywhere keeps the sample of the first pass, bit for bit.

use crate::Distance;
use crate::cells::Cells;
use crate::poisson::chance;
use crate::sheets::others;
use rayon::prelude::*;

/// A sample, and how many of its points are nearer than the spacing to one on another sheet.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Thrown {
    /// Indices, ascending.
    pub kept: Vec<u32>,
    /// Points that the second pass added.
    pub beside: usize,
}

/// Completes a sample `kept` (indices) of the given `spacing` [m], at most the cell width.
pub(crate) fn complete(cells: &Cells, spacing: f64, seed: u64, kept: Vec<u32>, distance: Distance) -> Thrown {
    if distance == Distance::Space {
        return Thrown { kept, beside: 0 };
    }
    let place_of = cells.places();
    let lists: Vec<Vec<u32>> =
        kept.par_iter().map(|&i| others(cells, place_of[i as usize], spacing)).collect();
    let mut open = opened(cells, spacing, &kept, &place_of, &lists);
    let mut order: Vec<u32> = (0..cells.len() as u32).filter(|&p| open[p as usize]).collect();
    order.sort_unstable_by_key(|&p| (chance(seed, u64::from(cells.order()[p as usize])), p));
    let mut kept = kept;
    let before = kept.len();
    for place in order {
        if open[place as usize] {
            let there = others(cells, place, spacing);
            cells.each_near(place, spacing, |other, _| {
                open[other as usize] &= there.binary_search(&other).is_ok()
            });
            kept.push(cells.order()[place as usize]);
        }
    }
    let beside = kept.len() - before;
    kept.sort_unstable();
    Thrown { kept, beside }
}

/// By place, whether all disks that cover a point are those of another sheet.
fn opened(cells: &Cells, spacing: f64, kept: &[u32], place_of: &[u32], lists: &[Vec<u32>]) -> Vec<bool> {
    let mut open = vec![false; cells.len()];
    if lists.iter().all(Vec::is_empty) {
        return open;
    }
    let mut from_others = vec![0u32; cells.len()];
    lists.iter().flatten().for_each(|&place| from_others[place as usize] += 1);
    let mut is_kept = vec![false; cells.len()];
    kept.iter().for_each(|&i| is_kept[place_of[i as usize] as usize] = true);
    let covers = |place: u32| {
        let mut count = 0;
        cells.each_near(place, spacing, |other, _| count += u32::from(is_kept[other as usize]));
        count
    };
    let is_open = |place: usize| {
        from_others[place] > 0 && !is_kept[place] && covers(place as u32) == from_others[place]
    };
    open.par_iter_mut().enumerate().for_each(|(place, open)| *open = is_open(place));
    open
}
