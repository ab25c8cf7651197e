//! A cloud at several scales: each level is a coarse picture of the part of the cloud whose spacing suits its cells.
//!
//! ```text
//! cells     c = 1.8 s √2ⁿ, s the median spacing
//! level n   the blocks of 16 c that hold a position of the spacing field with c/s within a factor ⁴√2 of 1.8, and two blocks around
//! judged    ends of the surface whose own c/s is within a factor 2^¾ of 1.8: the levels beside overlap, so that no loop is cut
//! ```
//!
//! A level's points are copied unless they are most of the cloud: up to 28 bytes a point, one level at a time.

use super::sheet::{End, Sheet};
use crate::neighbours::spacing::LocalSpacing;
use geom::Vec3;
use rayon::prelude::*;
use std::borrow::Cow;
use std::collections::{BTreeMap, HashSet};

/// Cells of a level, in spacings: of its middle.
pub(crate) const CELL: f64 = 1.8;
/// From level to level, as a power of two.
const STEP: f64 = 0.5;
/// Ends are judged so many levels beside their own.
const JUDGED: f64 = 1.5;
/// Width of a block, in cells.
const BLOCK: f64 = 16.0;
/// Blocks around.
const AROUND: i64 = 2;
/// Levels of fewer points hold no hole.
const FEWEST: f64 = 150.0;
/// Most levels; those with the most points count.
const MOST: usize = 24;
/// Share of the cloud above which a level takes it all.
const NEARLY_ALL: f64 = 0.8;
/// Scale at which a hole is examined, in spacings.
pub(crate) const EXAMINED: f64 = 2.0;

/// What is searched at one scale.
pub(crate) struct Level<'a> {
    /// Points [m].
    pub points: Cow<'a, [Vec3]>,
    /// Their rows in the cloud; all when there is none.
    rows: Option<Vec<u32>>,
    pub sheet: Sheet,
    /// Where the surface ends.
    pub ends: Vec<End>,
    /// How many times wider its cells are because of noise.
    pub wider: f64,
}

/// Number and cell width of the levels [m] that a cloud needs, finest first.
pub(crate) fn scales(field: &LocalSpacing) -> BTreeMap<i64, f64> {
    let mut spacings: Vec<f64> = field.all().map(|(_, s)| s).collect();
    let middle = spacings.len() / 2;
    let median = *spacings.select_nth_unstable_by(middle, f64::total_cmp).1;
    let mut counts: BTreeMap<i64, f64> = BTreeMap::new();
    for spacing in &spacings {
        *counts.entry((libm::log2(spacing / median) / STEP).round() as i64).or_default() += field.share;
    }
    let mut by_count: Vec<(i64, f64)> = counts.into_iter().filter(|(_, count)| *count >= FEWEST).collect();
    by_count.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    by_count.truncate(MOST);
    by_count.into_iter().map(|(n, _)| (n, CELL * median * libm::exp2(STEP * n as f64))).collect()
}

impl<'a> Level<'a> {
    /// All points, at one scale [m].
    pub fn whole(points: &'a [Vec3], cell: f64) -> Level<'a> {
        Level::of(Cow::Borrowed(points), None, cell, |_| true)
    }

    /// The points around the positions of `field` that suit `cell` [m].
    pub fn suited(points: &'a [Vec3], field: &LocalSpacing, cell: f64) -> Level<'a> {
        let levels_off = |spacing: f64| (libm::log2(CELL * spacing / cell) / STEP).abs();
        let width = BLOCK * cell;
        let block = |p: &Vec3| [0, 1, 2].map(|a| (p[a] / width).floor() as i64);
        let own: HashSet<[i64; 3]> =
            field.all().filter(|(_, s)| levels_off(*s) <= 0.5).map(|(p, _)| block(&p)).collect();
        let steps = || -AROUND..=AROUND;
        let mut blocks: HashSet<[i64; 3]> = HashSet::new();
        for [x, y, z] in own {
            let near =
                steps().flat_map(|i| steps().flat_map(move |j| steps().map(move |k| [x + i, y + j, z + k])));
            blocks.extend(near);
        }
        let rows: Vec<u32> = (0..points.len() as u32)
            .into_par_iter()
            .filter(|&row| blocks.contains(&block(&points[row as usize])))
            .collect();
        let is_judged = |p: &Vec3| levels_off(field.at(p)) <= JUDGED;
        if rows.len() as f64 >= NEARLY_ALL * points.len() as f64 {
            return Level::of(Cow::Borrowed(points), None, cell, is_judged);
        }
        let part = rows.par_iter().map(|&row| points[row as usize]).collect();
        Level::of(Cow::Owned(part), Some(rows), cell, is_judged)
    }

    fn of(
        points: Cow<'a, [Vec3]>,
        rows: Option<Vec<u32>>,
        cell: f64,
        is_judged: impl Fn(&Vec3) -> bool + Sync,
    ) -> Level<'a> {
        let sheet = Sheet::of_surface(&points, cell);
        let mut ends = sheet.ends();
        ends.retain(|end| is_judged(&sheet.positions[end.index as usize]));
        let wider = sheet.cell / cell;
        Level { points, rows, sheet, ends, wider }
    }

    /// Row of the cloud of one of the points.
    pub fn row(&self, own: u32) -> u32 {
        self.rows.as_ref().map_or(own, |rows| rows[own as usize])
    }
}
