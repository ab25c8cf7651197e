//! Random numbers that are the same on every machine: a stream for each thing that is drawn.

use nalgebra::{Quaternion, UnitQuaternion};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::f64::consts::TAU;

/// A generator for one thing: `kind` and `index` keep streams of one seed apart.
pub fn generator(seed: u64, kind: u64, index: u64) -> Pcg64Mcg {
    let mut state = seed ^ kind.rotate_left(32) ^ index.rotate_left(48);
    let mut next = || {
        // SplitMix64 (Steele, Lea & Flood 2014, doi:10.1145/2660193.2660195).
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let a = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let b = (a ^ (a >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        b ^ (b >> 31)
    };
    let (low, high) = (u128::from(next()), u128::from(next()));
    Pcg64Mcg::from_seed((low | high << 64).to_le_bytes())
}

/// A number in [0, 1), from the highest 53 bits: portable, and free of the details of `rand`.
pub fn unit(random: &mut Pcg64Mcg) -> f64 {
    (random.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

/// A standard normal number: Box & Muller (1958), doi:10.1214/aoms/1177706645.
pub fn normal(random: &mut Pcg64Mcg) -> f64 {
    let (a, b) = (unit(random), unit(random));
    (-2.0 * libm::log(1.0 - a)).sqrt() * libm::cos(TAU * b)
}

/// The orientation that three numbers from 0 to 1 stand for; even numbers give orientations that are uniform on SO(3): Shoemake (1992), Graphics
/// Gems III.
pub fn orientation([share, a, b]: [f64; 3]) -> UnitQuaternion<f64> {
    let (p, q, a, b) = ((1.0 - share).sqrt(), share.sqrt(), TAU * a, TAU * b);
    let (i, j) = (p * libm::sin(a), p * libm::cos(a));
    UnitQuaternion::new_normalize(Quaternion::new(q * libm::cos(b), i, j, q * libm::sin(b)))
}

/// The k-th place of a sequence that fills a cube evenly: Kronecker's sequence of the powers of 1/g, g⁴ = g + 1 (Roberts' R₃ sequence).
pub fn even(k: usize) -> [f64; 3] {
    const G: f64 = 1.220_744_084_605_759_5;
    [1, 2, 3].map(|power| (0.5 + (k as f64 + 1.0) / f64::powi(G, power)).fract())
}

/// A random orientation.
pub fn random_orientation(random: &mut Pcg64Mcg) -> UnitQuaternion<f64> {
    orientation([unit(random), unit(random), unit(random)])
}
