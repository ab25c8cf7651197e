//! The strength of one bond: drawn from the ids of its two particles, so that neither order nor threads change it.

use crate::setup::{BondStrength, Spread};
use geom::random::{generator, normal, unit};
use rand_pcg::Pcg64Mcg;
use std::f64::consts::PI;

/// Spreads seeds over all bits: 2⁶⁴ over the golden ratio.
const ODD: u64 = 0x9e37_79b9_7f4a_7c15;

/// σ_c, τ_c [Pa] and tan φ of a bond of a radius [m] between two particles, the lower id first.
pub fn strength(law: &BondStrength, [a, b]: [u32; 2], radius: f64) -> [f64; 3] {
    let mut random = generator(law.seed.wrapping_mul(ODD), u64::from(a) | u64::from(b) << 32, 0);
    let factor = law.spread.draw(&mut random, radius);
    let per = if law.forces { factor / (PI * radius * radius) } else { factor };
    [law.tension * per, law.shear * per, law.friction]
}

impl Spread {
    /// The factor of one bond on the strengths of its law.
    fn draw(self, random: &mut Pcg64Mcg, radius: f64) -> f64 {
        match self {
            Spread::None => 1.0,
            Spread::Normal { deviation } => loop {
                let factor = 1.0 + deviation * normal(random);
                if factor > 0.0 {
                    return factor;
                }
            },
            Spread::Weibull { modulus, reference_radius } => {
                let volume = reference_radius.map_or(1.0, |r| (radius / r).powi(3));
                libm::pow(-libm::log(1.0 - unit(random)) / volume, 1.0 / modulus)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(spread: Spread, radius: f64) -> Vec<f64> {
        let law = BondStrength { spread, seed: 7, ..BondStrength::of(2e6, 5e6) };
        (0..10_000).map(|k| strength(&law, [k, k + 1 + k % 5], radius)[0] / 2e6).collect()
    }

    fn mean_and_deviation(all: &[f64]) -> [f64; 2] {
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        let square = all.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
        [mean, (square / (all.len() - 1) as f64).sqrt()]
    }

    #[test]
    fn ten_thousand_normal_strengths_have_their_mean_and_deviation() {
        let [mean, deviation] = mean_and_deviation(&drawn(Spread::Normal { deviation: 0.25 }, 1.0));
        assert!((mean - 1.0).abs() < 0.01, "{mean}");
        assert!((deviation / 0.25 - 1.0).abs() < 0.03, "{deviation}");
    }

    /// Maximum likelihood: 1/m = Σ x^m ln x/Σ x^m − mean of ln x, found by bisection.
    fn weibull_modulus(all: &[f64]) -> f64 {
        let mean_log = all.iter().map(|x| x.ln()).sum::<f64>() / all.len() as f64;
        let off = |m: f64| {
            let (a, b) = all.iter().fold((0.0, 0.0), |(a, b), x| (a + x.powf(m) * x.ln(), b + x.powf(m)));
            a / b - mean_log - 1.0 / m
        };
        let (mut low, mut high) = (0.1, 100.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if off(middle) < 0.0 { low = middle } else { high = middle }
        }
        low
    }

    #[test]
    fn ten_thousand_weibull_strengths_have_their_modulus_and_fall_with_size() {
        for m in [2.0, 8.0] {
            let with = |radius| drawn(Spread::Weibull { modulus: m, reference_radius: Some(1e-3) }, radius);
            let (small, large) = (with(1e-3), with(3e-3));
            for all in [&small, &large] {
                let found = weibull_modulus(all);
                assert!((found / m - 1.0).abs() < 0.05, "{found} {m}");
            }
            // The same draws: (r/r_0)^(−3/m).
            let ratio = large[3] / small[3];
            assert!((ratio / 3f64.powf(-3.0 / m) - 1.0).abs() < 1e-12, "{ratio}");
            // 63.2 % break below the scale.
            let below = small.iter().filter(|x| **x < 1.0).count();
            assert!((6170..=6470).contains(&below), "{below}");
        }
    }

    #[test]
    fn a_wide_normal_spread_has_no_strength_below_zero() {
        assert!(drawn(Spread::Normal { deviation: 1.0 }, 1.0).iter().all(|x| *x > 0.0));
    }
}
