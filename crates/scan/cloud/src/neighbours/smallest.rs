//! The smallest of some squares of distances, in ascending order, by ranks: every number is compared with every other, without a branch, which for
//! some dozens of numbers takes less time than sorting.

use geom::Vec3;
use multiversion::multiversion;

/// Numbers that are compared with each other; of more, the smallest are chosen first.
const FEW: usize = 48;

/// Numbers and their ranks.
pub(crate) struct Smallest {
    squares: [f64; FEW],
    ranks: [u64; FEW],
    sorted: [f64; FEW],
}

impl Smallest {
    pub(crate) fn new() -> Smallest {
        Smallest { squares: [0.0; FEW], ranks: [0; FEW], sorted: [0.0; FEW] }
    }

    /// The `count` smallest of `squares`, which are not fewer and not negative, ascending; their order is lost.
    pub(crate) fn of<'a>(&'a mut self, squares: &'a mut [f64], count: usize) -> &'a [f64] {
        if squares.len() > FEW {
            squares.select_nth_unstable_by(count - 1, f64::total_cmp);
            let smallest = &mut squares[..count];
            smallest.sort_unstable_by(f64::total_cmp);
            return smallest;
        }
        self.squares[..squares.len()].copy_from_slice(squares);
        // Behind them none is smaller: whole vectors are compared.
        let lanes = squares.len().next_multiple_of(8);
        self.squares[squares.len()..lanes].fill(f64::INFINITY);
        rank(&self.squares[..lanes], &mut self.ranks[..lanes]);
        self.sorted[..squares.len()].fill(-1.0);
        for (square, rank) in squares.iter().zip(&self.ranks) {
            self.sorted[*rank as usize] = *square;
        }
        // Equal numbers have one rank, that of the first.
        for place in 1..count {
            if self.sorted[place] < 0.0 {
                self.sorted[place] = self.sorted[place - 1];
            }
        }
        &self.sorted[..count]
    }
}

/// How many of the squares are smaller than each.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn rank(squares: &[f64], ranks: &mut [u64]) {
    ranks.fill(0);
    for other in squares {
        for (rank, square) in ranks.iter_mut().zip(squares) {
            *rank += u64::from(other < square);
        }
    }
}

/// Squares of the distances from `p` to points [m].
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
pub(crate) fn squares(p: &Vec3, points: &[Vec3], squares: &mut [f64]) {
    for (square, q) in squares.iter_mut().zip(points) {
        let (x, y, z) = (p.x - q.x, p.y - q.y, p.z - q.z);
        *square = x * x + y * y + z * z;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn are_the_first_of_the_sorted() {
        let mut smallest = Smallest::new();
        for count in [1, 7, 8, 30, FEW, FEW + 1, 200] {
            let value = |i: usize| ((i * 7919) % 23) as f64 * 0.25;
            let mut given: Vec<f64> = (0..count).map(value).collect();
            let mut sorted = given.clone();
            sorted.sort_by(f64::total_cmp);
            let wanted = count.div_ceil(2);
            assert_eq!(smallest.of(&mut given, wanted), &sorted[..wanted], "{count}");
        }
    }
}
