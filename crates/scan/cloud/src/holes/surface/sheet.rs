//! The surface at a coarse scale: one position per cell, its normal, and where the surface ends.

use super::surrounded::surrounded;
use geom::{Cells, Vec3};
use nalgebra::{Matrix3, SymmetricEigen};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// Neighbourhood of a position, in cells.
pub(crate) const REACH: f64 = 2.5;
/// A position whose neighbours leave a gap this wide is at an end of the surface [rad].
const GAP: f64 = 100.0 * PI / 180.0;
/// Spread across the surface, as a share of that along it, above which noise hides where the surface ends, so that cells must be wider [–].
const THICK: f64 = 0.2;
/// Factor by which cells grow then [–].
const WIDER: f64 = 1.5;
/// How often they grow at most.
const MOST_WIDER: usize = 8;
/// Positions whose flatness is measured.
const SOME: usize = 1000;
/// Fewest neighbours of a position that counts.
const FEWEST: usize = 12;
/// Cells along an axis that a key can tell apart.
const SPAN: f64 = (1u64 << 21) as f64;

/// A coarse picture of a cloud.
pub(crate) struct Sheet {
    /// Width of a cell [m].
    pub cell: f64,
    /// Mean of the points of each cell [m].
    pub positions: Vec<Vec3>,
    /// Rows of the points by cell, and where those of each cell are among them; points too far from the rest to belong to any surface
    /// are in none.
    rows: Vec<u32>,
    runs: Vec<Range<u32>>,
    /// A position in the middle of most points [m].
    pub middle: Vec3,
    /// The positions sorted into cells of `REACH * cell`.
    pub cells: Cells,
}

/// A position where the surface ends.
#[derive(Clone, Copy)]
pub(crate) struct End {
    /// Index of its position.
    pub index: u32,
    /// Unit normal, of either sign.
    pub normal: Vec3,
    /// Unit vector in the surface, towards where there is none.
    pub free: Vec3,
}

impl Sheet {
    pub fn new(points: &[Vec3], cell: f64) -> Sheet {
        let middle = middle(points);
        let (mut rows, starts) = by_cell(points, cell, &middle);
        // Cells are numbered as the rows meet them.
        let runs = starts.par_windows(2).map(|run| run[0]..run[1]);
        let mut runs: Vec<(u32, Range<u32>)> = runs.map(|run| (rows[run.start as usize], run)).collect();
        runs.par_sort_unstable_by_key(|(first, _)| *first);
        let runs: Vec<Range<u32>> = runs.into_iter().map(|(_, run)| run).collect();
        let mean = |run: &Range<u32>| {
            let rows = &rows[run.start as usize..run.end as usize];
            middle + rows.iter().map(|&row| points[row as usize] - middle).sum::<Vec3>() / rows.len() as f64
        };
        let positions: Vec<Vec3> = runs.par_iter().map(mean).collect();
        rows.shrink_to_fit();
        let cells = Cells::new(&positions, REACH * cell);
        Sheet { cell, positions, rows, runs, middle, cells }
    }

    /// A coarse picture of cells at least `cell` [m] wide, and wider where the noise of the points makes the surface thicker than that: there
    /// neighbours lie all around a position, and nothing has an end.
    pub fn of_surface(points: &[Vec3], cell: f64) -> Sheet {
        let mut sheet = Sheet::new(points, cell);
        for _ in 0..MOST_WIDER {
            if sheet.flatness().is_none_or(|flatness| flatness < THICK) {
                break;
            }
            sheet = Sheet::new(points, sheet.cell * WIDER);
        }
        sheet
    }

    /// Median of the least of the three spreads of a position's neighbours, as a share of the second: 0 of a plane, 1 of a ball. None for a few positions.
    fn flatness(&self) -> Option<f64> {
        let some: Vec<u32> =
            (0..self.positions.len() as u32).step_by(self.positions.len().div_ceil(SOME).max(1)).collect();
        let share = |&index: &u32| {
            let offsets = self.offsets(index);
            let [least, second, _] = spreads(&offsets)?.0;
            (offsets.len() >= FEWEST && second > 0.0).then(|| least.max(0.0) / second)
        };
        let mut shares: Vec<f64> = some.par_iter().filter_map(share).collect();
        let middle = shares.len() / 2;
        (shares.len() >= SOME / 10).then(|| *shares.select_nth_unstable_by(middle, f64::total_cmp).1)
    }

    /// From a position to those near by [m].
    fn offsets(&self, index: u32) -> Vec<Vec3> {
        let centre = self.positions[index as usize];
        let near = self.cells.grid.within(&self.positions, centre, REACH * self.cell).filter(|&j| j != index);
        near.map(|j| self.positions[j as usize] - centre).collect()
    }

    /// Rows of the points of a cell, ascending.
    pub fn rows(&self, index: u32) -> &[u32] {
        let Range { start, end } = self.runs[index as usize];
        &self.rows[start as usize..end as usize]
    }

    /// The positions where the surface ends, in order.
    pub fn ends(&self) -> Vec<End> {
        let surrounded = surrounded(&self.cells, REACH * self.cell);
        let others = self.cells.order().iter().zip(surrounded).filter(|(_, surrounded)| !surrounded);
        let mut others: Vec<u32> = others.map(|(&i, _)| i).collect();
        others.sort_unstable();
        others.into_par_iter().filter_map(|i| self.end(i)).collect()
    }

    fn end(&self, index: u32) -> Option<End> {
        let offsets = self.offsets(index);
        if offsets.len() < 3 {
            return None;
        }
        let normal = normal(&offsets)?;
        let (gap, free) = widest_gap(&offsets, &normal)?;
        (gap >= GAP).then_some(End { index, normal, free })
    }
}

/// The widest angle around an axis without any of the vectors [rad], and the direction of its middle; none for no vectors.
pub(crate) fn widest_gap(offsets: &[Vec3], axis: &Vec3) -> Option<(f64, Vec3)> {
    let u = axis.cross(&Vec3::ith(axis.iamin(), 1.0)).normalize();
    let v = axis.cross(&u);
    let mut angles: Vec<f64> = offsets.iter().map(|o| libm::atan2(o.dot(&v), o.dot(&u))).collect();
    angles.sort_by(f64::total_cmp);
    let mut gap = angles.first()? + TAU - angles.last()?;
    let mut middle = angles[0] - gap / 2.0;
    for pair in angles.windows(2) {
        if pair[1] - pair[0] > gap {
            gap = pair[1] - pair[0];
            middle = pair[0] + gap / 2.0;
        }
    }
    Some((gap, u * libm::cos(middle) + v * libm::sin(middle)))
}

/// Direction of least spread of vectors around their mean; none when they spread along one line only.
pub(crate) fn normal(offsets: &[Vec3]) -> Option<Vec3> {
    let ([least, second, most], axis) = spreads(offsets)?;
    let is_flat = second > 1e-3 * most && least.is_finite();
    is_flat.then(|| axis.normalize())
}

/// Spreads of vectors, and of zero, around their mean, ascending [m²], and the direction of the least; none for no vectors.
fn spreads(offsets: &[Vec3]) -> Option<([f64; 3], Vec3)> {
    let mean = offsets.iter().sum::<Vec3>() / (offsets.len() + 1) as f64;
    let mut spread: Matrix3<f64> = mean * mean.transpose();
    for o in offsets {
        spread += (o - mean) * (o - mean).transpose();
    }
    let eigen = SymmetricEigen::new(spread);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let values = order.map(|i| eigen.eigenvalues[i]);
    (!offsets.is_empty()).then(|| (values, eigen.eigenvectors.column(order[0]).into()))
}

/// A position in the middle of most points: the median of a few hundred along each axis.
fn middle(points: &[Vec3]) -> Vec3 {
    let step = points.len().div_ceil(501).max(1);
    Vec3::from([0, 1, 2].map(|a| {
        let mut some: Vec<f64> = points.iter().step_by(step).map(|p| p[a]).collect();
        some.sort_by(f64::total_cmp);
        some.get(some.len() / 2).copied().unwrap_or(0.0)
    }))
}

/// Rows sorted by the cell that they lie in, within a cell as they come, and the first row of each cell and one more.
fn by_cell(points: &[Vec3], width: f64, middle: &Vec3) -> (Vec<u32>, Vec<u32>) {
    let cell = |p: &Vec3| {
        // From zero on, to cut the fraction off is to round down.
        let shifted = (p - middle) / width + Vec3::repeat(SPAN / 2.0);
        shifted
            .iter()
            .all(|c| (0.0..SPAN).contains(c))
            .then(|| [shifted.x as u64, shifted.y as u64, shifted.z as u64])
    };
    let none = ([u64::MAX; 3], [0; 3]);
    let both = |a: ([u64; 3], [u64; 3]), b: ([u64; 3], [u64; 3])| {
        ([0, 1, 2].map(|k| a.0[k].min(b.0[k])), [0, 1, 2].map(|k| a.1[k].max(b.1[k])))
    };
    let (lo, hi) =
        points.par_iter().filter_map(cell).fold(|| none, |all, c| both(all, (c, c))).reduce(|| none, both);
    let dims = [0, 1, 2].map(|k| (hi[k] + 1).saturating_sub(lo[k]));
    let cells = dims[0] as u128 * dims[1] as u128 * dims[2] as u128;
    // A position that is nowhere comes last.
    let key = |p: &Vec3| {
        let number = |[x, y, z]: [u64; 3]| ((z - lo[2]) * dims[1] + y - lo[1]) * dims[0] + x - lo[0];
        cell(p).map_or(cells as u64, number)
    };
    if cells < u128::from(u32::MAX) {
        let items = points.par_iter().enumerate().map(|(row, p)| key(p) << 32 | row as u64).collect();
        let sorted = geom::grid::sorted(items, cells as u64);
        return runs(&sorted, |&both| (both >> 32, both as u32), cells as u64);
    }
    let mut items: Vec<(u64, u32)> =
        points.par_iter().enumerate().map(|(row, p)| (key(p), row as u32)).collect();
    items.par_sort_unstable();
    runs(&items, |&both| both, cells as u64)
}

/// Rows, and the first row of each cell and one more, from what is sorted; `split` gives the key and the row.
fn runs<T: Sync>(
    sorted: &[T],
    split: impl Fn(&T) -> (u64, u32) + Sync,
    nowhere: u64,
) -> (Vec<u32>, Vec<u32>) {
    let count = sorted.partition_point(|both| split(both).0 < nowhere);
    let mut starts: Vec<u32> = (0..count as u32)
        .into_par_iter()
        .filter(|&k| k == 0 || split(&sorted[k as usize]).0 != split(&sorted[k as usize - 1]).0)
        .collect();
    starts.push(count as u32);
    (sorted[..count].par_iter().map(|both| split(both).1).collect(), starts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_ends_at_its_rim_and_looks_outwards() {
        let points: Vec<Vec3> =
            (0..10_000).map(|i| Vec3::new((i % 100) as f64, (i / 100) as f64, 0.0) / 100.0).collect();
        let sheet = Sheet::new(&points, 0.02);
        let ends = sheet.ends();
        assert!(ends.len() > 100 && ends.len() < 400, "{}", ends.len());
        for end in &ends {
            let p = sheet.positions[end.index as usize] - Vec3::new(0.5, 0.5, 0.0);
            assert!(p.amax() > 0.45 && p.dot(&end.free) > 0.0 && end.normal.z.abs() > 0.99);
        }
    }

    /// Noise of half a cell: cells as wide as asked for lie in layers, and nothing ends; wider ones show the rim, and it alone.
    #[test]
    fn a_thick_sheet_is_looked_at_by_wider_cells() {
        let chance = |i: u32| {
            f64::from(i.wrapping_mul(2654435769) ^ (i >> 3).wrapping_mul(2246822519)) / f64::from(u32::MAX)
        };
        let noise = |i: u32| 0.012 * ((0..6).map(|k| chance(6 * i + k)).sum::<f64>() - 3.0);
        let position = |i: u32| Vec3::new(f64::from(i % 400) / 400.0, f64::from(i / 400) / 400.0, noise(i));
        let points: Vec<Vec3> = (0..160_000).map(position).collect();
        let asked = Sheet::new(&points, 0.012);
        assert!(asked.flatness().unwrap() > THICK, "{:?}", asked.flatness());
        let sheet = Sheet::of_surface(&points, 0.012);
        assert!(sheet.cell > 0.012 && sheet.flatness().unwrap() < THICK);
        let ends = sheet.ends();
        let at_rim = |end: &&End| {
            let p = sheet.positions[end.index as usize] - Vec3::new(0.5, 0.5, 0.0);
            p.xy().amax() > 0.4
        };
        assert!(
            ends.len() > 50 && ends.iter().filter(at_rim).count() * 10 > ends.len() * 9,
            "{}",
            ends.len()
        );
    }

    #[test]
    fn a_line_has_no_surface() {
        let points: Vec<Vec3> = (0..1000).map(|i| Vec3::new(i as f64, 0.0, 0.0)).collect();
        assert!(Sheet::new(&points, 4.0).ends().is_empty());
    }
}
