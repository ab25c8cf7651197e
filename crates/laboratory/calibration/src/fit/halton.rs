//! Points that fill a cube evenly: Halton's sequence with random digits.
//!
//! Owen (2017), A randomized Halton algorithm in R, arXiv:1706.02808: each digit is permuted at random, so that the sequence keeps its evenness
//! in many dimensions.

use geom::random::{generator, unit};

const PRIMES: [u64; 40] = [
    2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61, 67, 71, 73, 79, 83, 89, 97, 101, 103,
    107, 109, 113, 127, 131, 137, 139, 149, 151, 157, 163, 167, 173,
];

/// Stream of the digits' permutations.
const DIGITS: u64 = 0x68_61_6c;

/// A sequence.
pub(crate) struct Halton {
    /// For each dimension: base, and a permutation for each digit.
    dimensions: Vec<(u64, Vec<Vec<u64>>)>,
}

impl Halton {
    /// A sequence in `d` ≤ 40 dimensions.
    pub fn new(d: usize, seed: u64) -> Halton {
        let dimension = |(k, &base): (usize, &u64)| {
            let digits = (40.0 * std::f64::consts::LN_2 / libm::log(base as f64)).ceil() as u64;
            let permutation = |digit: u64| {
                let mut random = generator(seed, DIGITS, (k as u64) << 8 | digit);
                let mut list: Vec<u64> = (0..base).collect();
                for i in (1..list.len()).rev() {
                    list.swap(i, (unit(&mut random) * (i + 1) as f64) as usize);
                }
                list
            };
            (base, (0..digits).map(permutation).collect())
        };
        Halton { dimensions: PRIMES.iter().take(d).enumerate().map(dimension).collect() }
    }

    /// The k-th point.
    pub fn point(&self, k: u64) -> Vec<f64> {
        let coordinate = |(base, digits): &(u64, Vec<Vec<u64>>)| {
            let (mut rest, mut share, mut sum) = (k, 1.0 / *base as f64, 0.0);
            for permutation in digits {
                sum += share * permutation[(rest % base) as usize] as f64;
                rest /= base;
                share /= *base as f64;
            }
            sum.min(1.0 - 1e-12)
        };
        self.dimensions.iter().map(coordinate).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_dimension_is_filled_evenly() {
        let sequence = Halton::new(20, 3);
        let points: Vec<Vec<f64>> = (0..60).map(|k| sequence.point(k)).collect();
        for d in 0..20 {
            let mut values: Vec<f64> = points.iter().map(|p| p[d]).collect();
            values.sort_by(f64::total_cmp);
            let gap = values.windows(2).map(|w| w[1] - w[0]).fold(values[0].max(1.0 - values[59]), f64::max);
            assert!(gap < 0.12, "dimension {d}: a gap of {gap}");
        }
        // In two dimensions, 60 points leave no box of a ninth of the area empty.
        let count = |a: f64, b: f64| {
            points.iter().filter(|p| (p[0] - a).abs() < 1.0 / 6.0 && (p[1] - b).abs() < 1.0 / 6.0).count()
        };
        for a in 0..3 {
            for b in 0..3 {
                assert!(count((f64::from(a) + 0.5) / 3.0, (f64::from(b) + 0.5) / 3.0) >= 3, "{a} {b}");
            }
        }
    }
}
