//! The largest part of a cloud whose points are connected by steps of at most a radius.
//!
//! Cells of a width of radius/√3 hold only connected points, so parts are found by joining cells.

use geom::{Grid, Parts, Vec3};
use std::borrow::Cow;

/// Rows of the finite `points` [m] that belong to the part with the most points, in order; of two equal
/// parts, the one with the lower first row. `radius` [m] is positive.
pub fn largest(points: &[Vec3], radius: f64) -> Vec<u32> {
    if points.is_empty() || !(radius > 0.0 && radius.is_finite()) {
        return Vec::new();
    }
    most_common(&parts(points, radius))
}

/// For each of the finite `points` [m] the number of its part, below that of the points; a radius [m] that is not positive leaves
/// each point alone.
pub fn parts(points: &[Vec3], radius: f64) -> Vec<u32> {
    if points.is_empty() || !(radius > 0.0 && radius.is_finite()) {
        return (0..points.len() as u32).collect();
    }
    // A little less, so that rounding cannot part the corners of a cell.
    let grid = Grid::new(points, radius / 3f64.sqrt() * (1.0 - 1e-9));
    let whole_cells = grid.cell() <= radius / 3f64.sqrt();
    let mut sorted_parts;
    if whole_cells {
        let cells = Cells::new(points, &grid);
        let mut parts = Parts::new(cells.count());
        cells.join(radius, &mut parts);
        sorted_parts = vec![0; points.len()];
        for (cell, run) in cells.starts.windows(2).enumerate() {
            sorted_parts[run[0] as usize..run[1] as usize].fill(parts.root(cell as u32));
        }
    } else {
        // Cells were widened because the cloud is vast: join point by point.
        let mut parts = Parts::new(points.len());
        for (i, p) in points.iter().enumerate() {
            grid.within(points, *p, radius).for_each(|j| parts.join(i as u32, j));
        }
        sorted_parts = grid.order().iter().map(|&i| parts.root(i)).collect();
    }
    let mut part_of = vec![0u32; points.len()];
    grid.order().iter().zip(&sorted_parts).for_each(|(&i, &part)| part_of[i as usize] = part);
    part_of
}

/// Rows that hold the most common value.
fn most_common(part_of: &[u32]) -> Vec<u32> {
    let mut count = vec![0u32; part_of.len()];
    part_of.iter().for_each(|&part| count[part as usize] += 1);
    let most = count.iter().copied().max().unwrap_or(0);
    let Some(&winner) = part_of.iter().find(|&&part| count[part as usize] == most) else { return Vec::new() };
    (0u32..).zip(part_of).filter(|&(_, &part)| part == winner).map(|(i, _)| i).collect()
}

/// The occupied cells of a grid, and the points in its order.
struct Cells<'a> {
    /// Number of each cell in the grid, ascending.
    keys: Cow<'a, [u64]>,
    /// Cell `c` holds the sorted slots `starts[c]..starts[c + 1]`.
    starts: Cow<'a, [u32]>,
    points: Vec<Vec3>,
    dims: [u64; 3],
}

impl<'a> Cells<'a> {
    fn new(points: &[Vec3], grid: &'a Grid) -> Cells<'a> {
        let (keys, starts) = grid.filled();
        let points = grid.order().iter().map(|&i| points[i as usize]).collect();
        Cells { keys, starts, points, dims: grid.dims().map(|d| d as u64) }
    }

    fn count(&self) -> usize {
        self.keys.len()
    }

    /// Joins cells that have two points within `radius`: these are at most two cells apart along each axis.
    fn join(&self, radius: f64, parts: &mut Parts) {
        let [nx, ny, nz] = self.dims;
        // Of two cells the later one is found: in this row or one behind it. In each of these rows the search goes on from where it ended.
        let rows: Vec<[i64; 2]> = (0..=2)
            .flat_map(|dz| (-2..=2).map(move |dy| [dy, dz]))
            .filter(|&[dy, dz]| dz > 0 || dy >= 0)
            .collect();
        let mut first = vec![0; rows.len()];
        for (cell, &key) in self.keys.iter().enumerate() {
            let (x, y, z) = (key % nx, key / nx % ny, key / nx / ny);
            for (&[dy, dz], from) in rows.iter().zip(&mut first) {
                let (Some(y), z) = (y.checked_add_signed(dy), z + dz as u64) else { continue };
                if y >= ny || z >= nz {
                    continue;
                }
                let row = (z * ny + y) * nx;
                let (low, high) = (row + x.saturating_sub(2), row + (x + 2).min(nx - 1));
                while self.keys.get(*from).is_some_and(|&key| key < low) {
                    *from += 1;
                }
                for other in (*from).max(cell + 1)..self.count() {
                    if self.keys[other] > high {
                        break;
                    }
                    if parts.root(cell as u32) != parts.root(other as u32)
                        && self.touch([cell, other], radius)
                    {
                        parts.join(cell as u32, other as u32);
                    }
                }
            }
        }
    }

    fn touch(&self, cells: [usize; 2], radius: f64) -> bool {
        let [a, b] = cells.map(|c| &self.points[self.starts[c] as usize..self.starts[c + 1] as usize]);
        let near = |p: &Vec3, q: &Vec3| (p - q).norm_squared() <= radius * radius;
        a.iter().any(|p| b.iter().any(|q| near(p, q)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn brute(points: &[Vec3], radius: f64) -> Vec<u32> {
        let mut parts = Parts::new(points.len());
        for i in 0..points.len() {
            for j in 0..i {
                if (points[i] - points[j]).norm_squared() <= radius * radius {
                    parts.join(i as u32, j as u32);
                }
            }
        }
        most_common(&(0..points.len() as u32).map(|i| parts.root(i)).collect::<Vec<_>>())
    }

    #[test]
    fn is_the_part_that_brute_force_finds() {
        let point = |i: u32| {
            let v = |s: u32| f64::from(i.wrapping_mul(2654435761).rotate_left(s) % 1000) / 100.0;
            Vec3::new(v(1), v(9), v(17))
        };
        let points: Vec<Vec3> = (0..600).map(point).collect();
        for radius in [0.3, 0.6, 0.8, 1.0, 1.5, 20.0] {
            assert_eq!(largest(&points, radius), brute(&points, radius), "{radius}");
        }
    }

    #[test]
    fn a_point_very_far_away_does_not_join() {
        let mut points: Vec<Vec3> = (0..50).map(|i| Vec3::new(0.1 * i as f64, 0.0, 0.0)).collect();
        points.push(Vec3::new(1e9, 0.0, 0.0));
        assert_eq!(largest(&points, 0.11).len(), 50);
        assert!(largest(&[], 1.0).is_empty() && parts(&[], 1.0).is_empty());
        assert_eq!(parts(&points[..3], 0.0), [0, 1, 2]);
        assert_eq!(largest(&[Vec3::zeros(); 9], 1.0).len(), 9);
    }
}
