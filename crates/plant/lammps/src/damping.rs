//! The dashpot of `damping tsuji`, which LAMMPS computes from a restitution by a polynomial.
//!
//! ```text
//! c = P(x) √(m* k)      Hooke: k = k_n; Hertz, JKR: k = 4/3 E* a, a = √(R* δ)
//! P(x) = 1.2728 − 4.2783 x + 11.087 x² − 22.348 x³ + 27.467 x⁴ − 18.022 x⁵ + 4.8218 x⁶
//! ```
//!
//! P fits Tsuji, Tanaka & Ishida (1992), Powder Technology 71, doi:10.1016/0032-5910(92)88030-L. For x = e it is exact neither for Hooke nor for Hertz, so x is
//! chosen such that P(x) is the damping of our law. It falls from 1.2728 at 0 to 0 slightly above 1 and rises again without bound:
//! a dashpot above 1.2728 (e below 0.08 or 0.12) takes x from that branch.

const P: [f64; 7] = [1.2728, -4.2783, 11.087, -22.348, 27.467, -18.022, 4.8218];

/// P(x).
fn polynomial(x: f64) -> f64 {
    P.iter().rev().fold(0.0, |sum, p| sum * x + p)
}

/// x of a damping ratio c/√(m* k) above 0 and at most 3 [–].
pub fn tsuji(ratio: f64) -> f64 {
    let falls = ratio <= P[0];
    // At 1.001 P is below 0, at 1.2 as well, at 2.1 above 40.
    let (mut above, mut below) = if falls { (0.0, 1.001) } else { (2.1, 1.2) };
    for _ in 0..200 {
        let middle = 0.5 * (above + below);
        if polynomial(middle) > ratio { above = middle } else { below = middle }
    }
    0.5 * (above + below)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_gives_every_damping_back() {
        for k in 1..300 {
            let ratio = 0.01 * f64::from(k);
            let x = tsuji(ratio);
            assert!((polynomial(x) - ratio).abs() < 1e-13, "{ratio}: x = {x}");
            assert!((0.0..2.1).contains(&x));
        }
        assert!((polynomial(tsuji(1e-6)) - 1e-6).abs() < 1e-14);
    }
}
