//! One tile of points of even distances on a square whose opposite edges meet.
//!
//! Random points, thinned by weighted sample elimination (Yuksel 2015, doi:10.1111/cgf.12538, with his exponent of 8; `eliminate` has its own weight) with
//! distances around the torus. Made on first use, the same each time.

use crate::poisson::chance;

/// Points of the tile.
const POINTS: usize = 400;
/// Random points for each that is left.
const CROWD: usize = 6;
/// Squares along an edge in which points are looked up: about one point each.
const SQUARES: usize = 20;

/// Points on the unit torus.
pub(crate) struct Tile {
    /// Places in [0, 1)².
    points: Vec<[f64; 2]>,
    /// Points of each square of a lattice.
    squares: Vec<Vec<u32>>,
    /// Least distance of two points, around the torus, for a tile 1 wide.
    pub nearest: f64,
}

impl Tile {
    /// Makes the tile: random points, thinned to even distances.
    pub(crate) fn new() -> Tile {
        let points = thinned(random(POINTS * CROWD), POINTS);
        let mut squares = vec![Vec::new(); SQUARES * SQUARES];
        for (k, p) in (0..).zip(&points) {
            squares[square(p.map(|c| (c * SQUARES as f64) as i64))].push(k);
        }
        let pairs = (0..points.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let nearest = pairs.map(|(i, j)| apart(points[i], points[j])).fold(f64::INFINITY, f64::min).sqrt();
        Tile { points, squares, nearest }
    }

    /// The point of the endless pattern nearest to `at` (in tile widths), and its squared distance; `None` where none is nearer
    /// than the width of a square.
    pub(crate) fn nearest_to(&self, at: [f64; 2]) -> Option<(TilePoint, f64)> {
        let home = at.map(|c| (c * SQUARES as f64).floor() as i64);
        let around = (-1..2).flat_map(|v| (-1..2).map(move |u| [home[0] + u, home[1] + v]));
        let all = around.flat_map(|cell| {
            let copy = cell.map(|c| c.div_euclid(SQUARES as i64));
            self.squares[square(cell)].iter().map(move |&k| {
                let p = self.points[k as usize];
                let d = [0, 1].map(|a| p[a] + copy[a] as f64 - at[a]);
                (TilePoint { number: k, copy }, d[0] * d[0] + d[1] * d[1])
            })
        });
        all.min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)))
    }
}

/// A point of the endless pattern, which repeats a tile.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct TilePoint {
    number: u32,
    /// Which copy of the tile, along each axis.
    copy: [i64; 2],
}

fn square(cell: [i64; 2]) -> usize {
    let [u, v] = cell.map(|c| c.rem_euclid(SQUARES as i64) as usize);
    v * SQUARES + u
}

/// Squared distance around the torus.
fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    let d = [0, 1].map(|k| {
        let d = (a[k] - b[k]).abs();
        d.min(1.0 - d)
    });
    d[0] * d[0] + d[1] * d[1]
}

fn random(count: usize) -> Vec<[f64; 2]> {
    let share = |n: u64| (chance(0, n) >> 11) as f64 / (1u64 << 53) as f64;
    (0..count as u64).map(|k| [share(2 * k), share(2 * k + 1)]).collect()
}

fn thinned(crowd: Vec<[f64; 2]>, count: usize) -> Vec<[f64; 2]> {
    let reach = 2.0 * (1.0 / (2.0 * 3f64.sqrt() * count as f64)).sqrt();
    let least = reach * 0.65 * (1.0 - libm::pow(count as f64 / crowd.len() as f64, 1.5));
    let weight = |i: usize, j: usize| {
        let w = (1.0 - apart(crowd[i], crowd[j]).sqrt().max(least) / reach).max(0.0);
        let w2 = w * w;
        w2 * w2 * w2 * w2
    };
    let others = |i: usize| (0..crowd.len()).filter(move |&j| j != i);
    let mut weights: Vec<f64> = (0..crowd.len()).map(|i| others(i).map(|j| weight(i, j)).sum()).collect();
    let mut left: Vec<usize> = (0..crowd.len()).collect();
    while left.len() > count {
        let heavier = |a: &usize, b: &usize| weights[left[*a]].total_cmp(&weights[left[*b]]).then(b.cmp(a));
        let Some(worst) = (0..left.len()).max_by(heavier) else { break };
        let gone = left.remove(worst);
        left.iter().for_each(|&i| weights[i] -= weight(i, gone));
    }
    left.into_iter().map(|i| crowd[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_distances_are_those_of_a_full_poisson_disk() {
        let tile = Tile::new();
        assert_eq!(tile.points.len(), POINTS);
        let even = tile.nearest * (POINTS as f64).sqrt();
        assert!((0.72..1.0).contains(&even), "least distance {even} mean spacings");
    }

    #[test]
    fn the_nearest_point_is_that_of_brute_force_also_across_edges() {
        let tile = Tile::new();
        for k in 0..200 {
            let at = [0.37 * f64::from(k) - 31.0, 0.011 * f64::from(k * k % 97) - 0.5];
            let best =
                tile.points.iter().map(|p| apart(*p, at.map(|c| c.rem_euclid(1.0)))).fold(9.0, f64::min);
            // It looks into the squares around only, each 1/20 wide.
            assert!(best.sqrt() < 1.0 / SQUARES as f64, "{at:?}: no point near");
            let (_, square) = tile.nearest_to(at).expect("there is one in the squares around");
            assert!((square - best).abs() < 1e-9, "{at:?}: {square} {best}");
        }
    }
}
