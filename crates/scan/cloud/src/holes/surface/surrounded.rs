//! Which positions are certainly inside the surface: their neighbours leave no gap of 100° around them.
//!
//! ```text
//! t = 1 − x/(|x| + |y|) above,  3 + x/(|x| + |y|) below       turns with the angle, from 0 to 4; 1 ≤ dφ/dt ≤ 2
//! ```
//!
//! Of 64 sectors of t, each at most ⅛ rad wide, the neighbours' directions fill some; with at most 11 empty ones between two
//! filled ones no gap is wider than 13/8 rad = 93°. Most places are inside the surface, and this needs neither angles nor an order.

use geom::cells::Cells;
use geom::least_axis;
use multiversion::multiversion;
use nalgebra::Matrix3;
use rayon::prelude::*;

/// Sectors of a turn: the bits of a number.
const SECTORS: u32 = 64;
/// Empty sectors side by side that may be a gap.
const EMPTY: u32 = 12;
/// Directions that are computed at once.
const LANES: usize = 8;
/// Places are worked on in parts of this many.
const PART: usize = 1024;

/// By slot in the cells' order, whether the points within `radius` [m], at most the cell width, surely surround it.
pub(crate) fn surrounded(cells: &Cells, radius: f64) -> Vec<bool> {
    let mut surrounded = vec![false; cells.len()];
    let parts = surrounded.par_chunks_mut(PART).enumerate();
    parts.for_each(|(part, found)| look(cells, (part * PART) as u32, radius, found));
    surrounded
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn look(cells: &Cells, first: u32, radius: f64, found: &mut [bool]) {
    let mut near = NeighbourVectors::default();
    for (slot, found) in (first..).zip(found) {
        near.gather(cells, slot, radius);
        *found = near.surround();
    }
}

/// Vectors to the neighbours [m]; memory that is used again.
#[derive(Default)]
struct NeighbourVectors {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    count: usize,
}

impl NeighbourVectors {
    #[inline(always)]
    fn gather(&mut self, cells: &Cells, slot: u32, radius: f64) {
        let centre = cells.points[slot as usize];
        let most = cells.runs(slot).map(|run| run.len()).sum::<usize>().next_multiple_of(LANES) + 1;
        [&mut self.x, &mut self.y, &mut self.z].into_iter().for_each(|column| column.resize(most, 0.0));
        let mut count = 0;
        for run in cells.runs(slot) {
            for (other, p) in (run.start as u32..).zip(&cells.points[run]) {
                let (x, y, z) = (p.x - centre.x, p.y - centre.y, p.z - centre.z);
                // Without a branch: which points are near cannot be predicted.
                (self.x[count], self.y[count], self.z[count]) = (x, y, z);
                count += (x * x + y * y + z * z <= radius * radius && other != slot) as usize;
            }
        }
        self.count = count;
        // What fills the last lanes up adds nothing to sums.
        let whole = count.next_multiple_of(LANES);
        for column in [&mut self.x, &mut self.y, &mut self.z] {
            column[count..whole].fill(0.0);
        }
    }

    #[inline(always)]
    fn surround(&self) -> bool {
        let spread = self.spread();
        if self.count < 3 {
            return false;
        }
        let Some(normal) = least_axis(&spread) else { return false };
        let u = normal.cross(&geom::Vec3::ith(normal.iamin(), 1.0)).normalize();
        let v = normal.cross(&u);
        let mut filled = [0u64; LANES];
        let whole = self.count.next_multiple_of(LANES);
        for first in (0..whole).step_by(LANES) {
            for (k, filled) in filled.iter_mut().enumerate() {
                let (x, y, z) = (self.x[first + k], self.y[first + k], self.z[first + k]);
                let (a, b) = (x * u.x + y * u.y + z * u.z, x * v.x + y * v.y + z * v.z);
                let size = a.abs() + b.abs();
                let share = a / size;
                let turn = if b >= 0.0 { 1.0 - share } else { 3.0 + share };
                // A neighbour right above has no direction; nor have those that fill up.
                let turn = if size > 0.0 { turn } else { -1.0 };
                let sector = (turn * f64::from(SECTORS / 4)) as i32;
                *filled |= if turn >= 0.0 { 1 << (sector & (SECTORS as i32 - 1)) } else { 0 };
            }
        }
        leaves_no_gap(filled.iter().fold(0, |all, some| all | some))
    }

    /// Σ (d − d̄)(d − d̄)ᵀ of the neighbours and the point itself, at zero.
    #[inline(always)]
    fn spread(&self) -> Matrix3<f64> {
        let mut sums = [[0.0; LANES]; 9];
        for first in (0..self.count.next_multiple_of(LANES)).step_by(LANES) {
            (0..LANES).for_each(|k| {
                let (x, y, z) = (self.x[first + k], self.y[first + k], self.z[first + k]);
                let terms = [x, y, z, x * x, x * y, x * z, y * y, y * z, z * z];
                (0..9).for_each(|term| sums[term][k] += terms[term]);
            });
        }
        let [x, y, z, xx, xy, xz, yy, yz, zz] = sums.map(|lanes| lanes.iter().sum::<f64>());
        let count = self.count as f64 + 1.0;
        let entry = |both: f64, a: f64, b: f64| both - a * b / count;
        let (xy, xz, yz) = (entry(xy, x, y), entry(xz, x, z), entry(yz, y, z));
        Matrix3::new(entry(xx, x, x), xy, xz, xy, entry(yy, y, y), yz, xz, yz, entry(zz, z, z))
    }
}

/// Whether fewer than [`EMPTY`] sectors side by side are empty.
fn leaves_no_gap(filled: u64) -> bool {
    // After each step, a bit stands for a run of empty sectors that begins there: of 2, 4, 8 and 12.
    let empty = !filled;
    let two = empty & empty.rotate_right(1);
    let four = two & two.rotate_right(2);
    let eight = four & four.rotate_right(4);
    eight & four.rotate_right(EMPTY - 4) == 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Vec3;

    #[test]
    fn a_run_of_twelve_empty_sectors_is_a_gap_wherever_it_begins() {
        for first in 0..SECTORS {
            for length in [1, 8, 11, 12, 13, 40] {
                let run = ((1u64 << length) - 1).rotate_left(first);
                assert_eq!(leaves_no_gap(!run), length < EMPTY, "{length} from {first}");
            }
        }
        assert!(!leaves_no_gap(0) && leaves_no_gap(u64::MAX));
    }

    /// A disc of positions is surrounded but near its rim, however it lies in space; a gap of 101° in a ring is one.
    #[test]
    fn the_rim_of_a_disc_is_not_surrounded_and_the_rest_is() {
        let normal = Vec3::new(0.3, -0.5, 0.8).normalize();
        let u = normal.cross(&Vec3::x()).normalize();
        let v = normal.cross(&u);
        let positions: Vec<(f64, f64)> =
            (0..3600).map(|i| (f64::from(i % 60) - 29.5, f64::from(i / 60) - 29.5)).collect();
        let disc: Vec<(f64, f64)> = positions.into_iter().filter(|(a, b)| a.hypot(*b) <= 25.0).collect();
        let points: Vec<Vec3> = disc.iter().map(|(a, b)| u * *a + v * *b).collect();
        let cells = Cells::new(&points, 2.5);
        for (slot, found) in surrounded(&cells, 2.5).into_iter().enumerate() {
            let radius = cells.points[slot].norm();
            assert!(found == (radius < 23.9) || (23.4..24.6).contains(&radius), "{radius}: {found}");
        }
    }
}
