//! Ends of a surface as loops, each of which may surround a hole.

use super::levels::Level;
use super::sheet::{End, REACH, Sheet};
use geom::Parts;
use geom::{Grid, Shape, Vec3};
use std::collections::BTreeMap;

/// Ends in loops no wider than a hole of width `widest` [m] has, by the number of their first position; and what hangs together farther,
/// in boxes.
pub(crate) fn loops(level: &Level, widest: f64) -> (Vec<Vec<End>>, Vec<Vec<End>>) {
    let Level { sheet, ends, .. } = level;
    let positions: Vec<Vec3> = ends.iter().map(|e| sheet.positions[e.index as usize]).collect();
    let reach = REACH * sheet.cell;
    let grid = Grid::new(&positions, reach);
    let mut parts = Parts::new(ends.len());
    for (i, end) in ends.iter().enumerate() {
        for j in grid.within(&positions, positions[i], reach).filter(|&j| j > i as u32) {
            if end.free.dot(&ends[j as usize].free) > 0.2 {
                parts.join(i as u32, j);
            }
        }
    }
    let mut by_root: Vec<(u32, End)> = (0u32..).zip(ends).map(|(i, e)| (parts.root(i), *e)).collect();
    by_root.sort_by_key(|(root, _)| *root);
    let groups =
        by_root.chunk_by(|a, b| a.0 == b.0).map(|group| group.iter().map(|g| g.1).collect::<Vec<End>>());
    let narrow = |group: &Vec<End>| {
        let positions: Vec<Vec3> = group.iter().map(|e| sheet.positions[e.index as usize]).collect();
        let (lo, hi) = geom::grid::bounds(&positions);
        (hi - lo).norm() <= 2.0 * (widest + reach)
    };
    let (loops, wide): (Vec<_>, Vec<_>) = groups.partition(narrow);
    (loops, wide.into_iter().flat_map(|group| boxes(sheet, group, 2.0 * (widest + 2.0 * reach))).collect())
}

/// Ends in overlapping boxes of width `side` [m]: whatever is half as wide lies whole in one of them.
fn boxes(sheet: &Sheet, group: Vec<End>, side: f64) -> Vec<Vec<End>> {
    let mut boxes: BTreeMap<[i64; 4], Vec<End>> = BTreeMap::new();
    for end in group {
        for shift in 0..8i64 {
            let half = |a: usize| 0.5 * (shift >> a & 1) as f64;
            let position = sheet.positions[end.index as usize];
            let [x, y, z] = [0, 1, 2].map(|a| (position[a] / side + half(a)).floor() as i64);
            boxes.entry([shift, x, y, z]).or_default().push(end);
        }
    }
    let mut all: Vec<Vec<End>> = boxes.into_values().collect();
    // A flat surface is cut in the same way by shifts across it.
    all.sort_by_key(|ends| ends.iter().map(|e| e.index).collect::<Vec<u32>>());
    all.dedup_by(|a, b| a.len() == b.len() && a.iter().zip(b.iter()).all(|(a, b)| a.index == b.index));
    all
}

/// Ends in a shape, or looking into it.
pub(crate) fn ends_of(level: &Level, shape: &Shape) -> Vec<End> {
    let Level { sheet, ends, .. } = level;
    let looks_in = |end: &&End| {
        let position = sheet.positions[end.index as usize];
        (0..8).any(|step| shape.contains(&(position + end.free * (0.5 * f64::from(step) * sheet.cell))))
    };
    ends.iter().filter(looks_in).copied().collect()
}
