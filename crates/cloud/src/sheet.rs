//! The surface at a coarse scale: one place a cell, its normal, and where the surface ends.

use geom::{Grid, Vec3};
use nalgebra::{Matrix3, SymmetricEigen};
use rayon::prelude::*;
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
use std::hash::{BuildHasherDefault, Hasher};

/// Neighbourhood of a place, in cells.
pub(crate) const REACH: f64 = 2.5;
/// A place whose neighbours leave a gap this wide is at an end of the surface [rad].
const GAP: f64 = 100.0 * PI / 180.0;
/// cos 99°, without its sign [–].
const SURELY: f64 = 0.156;
/// Cells along an axis that a key can tell apart.
const SPAN: f64 = (1u64 << 21) as f64;
/// No cell: the point is too far from the rest to belong to any surface.
pub(crate) const NOWHERE: u32 = u32::MAX;

/// A coarse picture of a cloud.
pub(crate) struct Sheet {
    /// Width of a cell [m].
    pub cell: f64,
    /// Mean of the points of each cell [m].
    pub places: Vec<Vec3>,
    /// The cell of each point, or [`NOWHERE`].
    pub cell_of: Vec<u32>,
    /// Over `places`, with cells of `REACH * cell`.
    pub grid: Grid,
}

/// A place where the surface ends.
#[derive(Clone, Copy)]
pub(crate) struct End {
    /// The place's number.
    pub place: u32,
    /// Unit normal, of either sign.
    pub normal: Vec3,
    /// Unit vector in the surface, towards where there is none.
    pub free: Vec3,
}

impl Sheet {
    pub fn new(points: &[Vec3], cell: f64) -> Sheet {
        let origin = middle(points);
        let mut number: HashMap<u64, u32, BuildHasherDefault<Mix>> = HashMap::default();
        let mut sums: Vec<(Vec3, u32)> = Vec::new();
        let keys: Vec<u64> = points.par_iter().map(|p| key((p - origin) / cell)).collect();
        let assign = |(key, p): (&u64, &Vec3)| {
            if *key == u64::MAX {
                return NOWHERE;
            }
            let n = *number.entry(*key).or_insert_with(|| {
                sums.push((Vec3::zeros(), 0));
                sums.len() as u32 - 1
            });
            let (sum, count) = &mut sums[n as usize];
            *sum += p - origin;
            *count += 1;
            n
        };
        let cell_of = keys.iter().zip(points).map(assign).collect();
        let places: Vec<Vec3> = sums.iter().map(|(sum, count)| origin + sum / f64::from(*count)).collect();
        let grid = Grid::new(&places, REACH * cell);
        Sheet { cell, places, cell_of, grid }
    }

    /// The places where the surface ends, in order.
    pub fn ends(&self) -> Vec<End> {
        (0..self.places.len() as u32).into_par_iter().filter_map(|i| self.end(i)).collect()
    }

    fn end(&self, place: u32) -> Option<End> {
        let centre = self.places[place as usize];
        let near = self.grid.within(&self.places, centre, REACH * self.cell).filter(|&j| j != place);
        let offsets: Vec<Vec3> = near.map(|j| self.places[j as usize] - centre).collect();
        if offsets.len() < 3 {
            return None;
        }
        let normal = normal(&offsets)?;
        let u = normal.cross(&Vec3::ith(normal.iamin(), 1.0)).normalize();
        let v = normal.cross(&u);
        if is_surrounded(offsets.iter().map(|o| [o.dot(&u), o.dot(&v)])) {
            return None;
        }
        let mut angles: Vec<f64> = offsets.iter().map(|o| libm::atan2(o.dot(&v), o.dot(&u))).collect();
        angles.sort_by(f64::total_cmp);
        let (mut gap, mut middle) = (angles[0] + TAU - angles[angles.len() - 1], angles[0]);
        middle -= gap / 2.0;
        for pair in angles.windows(2) {
            if pair[1] - pair[0] > gap {
                gap = pair[1] - pair[0];
                middle = pair[0] + gap / 2.0;
            }
        }
        let free = u * libm::cos(middle) + v * libm::sin(middle);
        (gap >= GAP).then_some(End { place, normal, free })
    }
}

/// Whether directions in the plane surely leave no gap of 100°: most places are inside the surface, and this needs no angles.
fn is_surrounded(directions: impl Iterator<Item = [f64; 2]>) -> bool {
    // x/(|x| + |y|) turns with the angle.
    let turn = |[x, y]: [f64; 2]| {
        let share = x / (x.abs() + y.abs());
        if y >= 0.0 { 1.0 - share } else { 3.0 + share }
    };
    let mut around: Vec<(f64, [f64; 2])> = directions.map(|d| (turn(d), d)).collect();
    around.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    // Half a turn is 2: directions within one leave the other half open.
    let spread = around.last().map_or(0.0, |last| last.0 - around[0].0);
    let narrow = |&[ax, ay]: &[f64; 2], &[bx, by]: &[f64; 2]| {
        let (sine, cosine) = (ax * by - ay * bx, ax * bx + ay * by);
        let lengths = (ax * ax + ay * ay) * (bx * bx + by * by);
        // Somewhat less than 100°, so that rounding decides nothing.
        sine >= 0.0 && (cosine >= 0.0 || cosine * cosine < SURELY * SURELY * lengths)
    };
    let next = around.iter().cycle().skip(1);
    spread > 2.0 && around.iter().zip(next).all(|((turn, a), (_, b))| turn.is_finite() && narrow(a, b))
}

/// Direction of least spread of vectors around their mean; none when they spread along one line only.
pub(crate) fn normal(offsets: &[Vec3]) -> Option<Vec3> {
    let mean = offsets.iter().sum::<Vec3>() / (offsets.len() + 1) as f64;
    let mut spread: Matrix3<f64> = mean * mean.transpose();
    for o in offsets {
        spread += (o - mean) * (o - mean).transpose();
    }
    let eigen = SymmetricEigen::new(spread);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let [least, second, most] = order.map(|i| eigen.eigenvalues[i]);
    let is_flat = second > 1e-3 * most && least.is_finite();
    is_flat.then(|| eigen.eigenvectors.column(order[0]).normalize())
}

/// A place in the middle of most points: the median of a few hundred along each axis.
fn middle(points: &[Vec3]) -> Vec3 {
    let step = points.len().div_ceil(501).max(1);
    Vec3::from([0, 1, 2].map(|a| {
        let mut some: Vec<f64> = points.iter().step_by(step).map(|p| p[a]).collect();
        some.sort_by(f64::total_cmp);
        some.get(some.len() / 2).copied().unwrap_or(0.0)
    }))
}

/// 21 bits an axis; `u64::MAX` for places too far away.
fn key(cells: Vec3) -> u64 {
    // From zero on, to cut the fraction off is to round down.
    let shifted = cells.map(|c| c + SPAN / 2.0);
    if !shifted.iter().all(|c| (0.0..SPAN).contains(c)) {
        return u64::MAX;
    }
    (shifted.z as u64) << 42 | (shifted.y as u64) << 21 | shifted.x as u64
}

/// Mixes a key (Fibonacci hashing); keys here are not chosen by an enemy.
#[derive(Default)]
struct Mix(u64);

impl Hasher for Mix {
    fn finish(&self) -> u64 {
        self.0
    }
    fn write(&mut self, _: &[u8]) {}
    fn write_u64(&mut self, key: u64) {
        let mixed = key.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = mixed ^ (mixed >> 29);
    }
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
            let p = sheet.places[end.place as usize] - Vec3::new(0.5, 0.5, 0.0);
            assert!(p.amax() > 0.45 && p.dot(&end.free) > 0.0 && end.normal.z.abs() > 0.99);
        }
    }

    #[test]
    fn a_line_has_no_surface() {
        let points: Vec<Vec3> = (0..1000).map(|i| Vec3::new(i as f64, 0.0, 0.0)).collect();
        assert!(Sheet::new(&points, 4.0).ends().is_empty());
    }
}
