//! Lloyd's relaxation on the points of the cloud: each kept point moves to the input point nearest to the middle of its share.
//!
//! Starts from a Poisson-disk sample. Shares are sets of input points nearest to the same kept point; each counts by
//! 1/(number of points nearer than the spacing), so that crowded places do not pull. Lloyd (1982), doi:10.1109/TIT.1982.1056489;
//! snapping keeps every result an input point, and a move that would bring two nearer than the spacing is not made. Eight rounds: more bring out a lattice, and blue noise is lost.

use crate::cells::Cells;
use crate::nearest::owners;
use crate::sheets::others;
use crate::{Sample, SampleError, SampleSettings, amount};
use geom::Vec3;
use rayon::prelude::*;

const ROUNDS: usize = 8;

pub(crate) fn relax(
    points: &[Vec3],
    forced: Option<&[bool]>,
    settings: &SampleSettings,
) -> Result<Sample, SampleError> {
    let mut sample = amount::sample_of(points, forced, settings)?;
    let cells = Cells::new(points, sample.spacing);
    let mut weight = vec![0.0; points.len()];
    let counts = cells.map(|slot| cells.count_near(slot, sample.spacing, u32::MAX / 2));
    for (slot, count) in counts.into_iter().enumerate() {
        weight[cells.order()[slot] as usize] = 1.0 / f64::from(count);
    }
    let mut slot_of = vec![0; points.len()];
    for (slot, &i) in cells.order().iter().enumerate() {
        slot_of[i as usize] = slot as u32;
    }
    let still = still(points.len(), forced, &sample, &cells, &slot_of);
    let forced = still.as_deref();
    for _ in 0..ROUNDS {
        let owner = owners(points, &sample.kept, sample.spacing);
        let middles = middles(points, &weight, &owner, sample.kept.len());
        let wanted = wanted(points, &owner, &middles, &sample.kept, forced);
        if !snap(&cells, &slot_of, &wanted, &mut sample.kept, sample.spacing) {
            break;
        }
    }
    sample.kept.sort_unstable();
    Ok(sample)
}

/// Points that stay where they are: forced ones, and kept ones that have another sheet nearer than the spacing, whose shares would mix.
fn still(
    count: usize,
    forced: Option<&[bool]>,
    sample: &Sample,
    cells: &Cells,
    slot_of: &[u32],
) -> Option<Vec<bool>> {
    if sample.beside == 0 {
        return forced.map(<[bool]>::to_vec);
    }
    let mut still = forced.map_or_else(|| vec![false; count], <[bool]>::to_vec);
    let is_beside = |i: &&u32| !others(cells, slot_of[**i as usize], sample.spacing).is_empty();
    let beside: Vec<u32> = sample.kept.par_iter().filter(is_beside).copied().collect();
    beside.into_iter().for_each(|i| still[i as usize] = true);
    Some(still)
}

fn middles(points: &[Vec3], weight: &[f64], owner: &[u32], count: usize) -> Vec<Vec3> {
    let mut sums = vec![(Vec3::zeros(), 0.0); count];
    for ((p, &w), &k) in points.iter().zip(weight).zip(owner) {
        sums[k as usize].0 += p * w;
        sums[k as usize].1 += w;
    }
    sums.into_iter().map(|(sum, w)| if w > 0.0 { sum / w } else { sum }).collect()
}

/// The point of each share that is nearest to its middle; a forced point stays, and so does one whose
/// move would bring two kept points nearer than the spacing. One after the other, so that every move sees the ones before.
fn snap(cells: &Cells, slot_of: &[u32], wanted: &[(f64, u32)], kept: &mut [u32], spacing: f64) -> bool {
    let mut taken = vec![false; slot_of.len()];
    for &i in kept.iter() {
        taken[slot_of[i as usize] as usize] = true;
    }
    let mut moved = false;
    for (now, &(_, to)) in kept.iter_mut().zip(wanted) {
        let (from, slot) = (slot_of[*now as usize], slot_of[to as usize]);
        let mut free = from != slot;
        if free {
            cells.each_near(slot, spacing, |other, _| free &= other == from || !taken[other as usize]);
        }
        if free {
            (taken[from as usize], taken[slot as usize]) = (false, true);
            (*now, moved) = (to, true);
        }
    }
    moved
}

/// For each kept point, the point of its share nearest to the middle of the share.
fn wanted(
    points: &[Vec3],
    owner: &[u32],
    middles: &[Vec3],
    kept: &[u32],
    forced: Option<&[bool]>,
) -> Vec<(f64, u32)> {
    let mut best: Vec<(f64, u32)> = kept.iter().map(|&i| (f64::INFINITY, i)).collect();
    for (i, (p, &k)) in points.iter().zip(owner).enumerate() {
        let (k, off) = (k as usize, (p - middles[k as usize]).norm_squared());
        if off < best[k].0 && !forced.is_some_and(|f| f[kept[k] as usize] || f[i]) {
            best[k] = (off, i as u32);
        }
    }
    best
}
