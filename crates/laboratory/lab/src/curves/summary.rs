//! What the curves of all specimens come to: means and intervals over seeds, the envelope over stresses, Weibull's modulus.

use crate::recipes::{Envelope, Value};
use crate::series::line;
use measure::statistics::Mean;
use serde::Serialize;

/// A value over several seeds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figure {
    pub name: String,
    /// Its unit; "" for none.
    pub unit: String,
    /// Mean over the seeds; none where no curve has the value.
    pub mean: Option<f64>,
    /// Half width of the 95 % interval of the mean (Student's t); none for one seed.
    pub interval: Option<f64>,
    /// The value of each seed, in their order.
    pub values: Vec<Option<f64>>,
}

/// The figures at one stress.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Level {
    /// Stress [Pa]; none where the test has none.
    pub stress: Option<f64>,
    pub figures: Vec<Figure>,
}

/// What a test came to.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Summary {
    /// Figures for each stress, in their order.
    pub levels: Vec<Level>,
    /// Friction angles and cohesions of the envelope over several stresses; empty for one.
    pub envelope: Vec<Figure>,
    /// Weibull modulus and scale of the strengths of a single stone; empty for few seeds.
    pub weibull: Vec<Figure>,
}

/// A number that is one.
pub(crate) fn number(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

impl Figure {
    /// Of the values of all seeds; those that are no numbers do not count.
    pub(crate) fn of(name: &str, unit: &str, values: &[f64]) -> Figure {
        let finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        let mean = Mean::of(&finite);
        Figure {
            name: name.to_owned(),
            unit: unit.to_owned(),
            mean: number(mean.mean),
            interval: number(mean.interval),
            values: values.iter().copied().map(number).collect(),
        }
    }
}

/// The figures of specimens of one stress: `values` holds those of each seed, in the same order.
pub(crate) fn level(stress: Option<f64>, values: &[Vec<Value>]) -> Level {
    let names = values.iter().find(|list| !list.is_empty()).cloned().unwrap_or_default();
    let of_seeds = |name: &str| -> Vec<f64> {
        let one = |list: &Vec<Value>| list.iter().find(|v| v.name == name).map_or(f64::NAN, |v| v.value);
        values.iter().map(one).collect()
    };
    Level { stress, figures: names.iter().map(|v| Figure::of(v.name, v.unit, &of_seeds(v.name))).collect() }
}

/// The envelope of each seed over all stresses, and its mean and interval.
///
/// ```text
/// plane:    τ = c + σ tan φ                                by least squares
/// circles:  (σ₁ − σ₃)/2 = c cos φ + (σ₁ + σ₃)/2 sin φ       the line through the tops of Mohr's circles
/// ```
pub(crate) fn envelope(kind: Envelope, levels: &[Level]) -> Vec<Figure> {
    let [normal, shear] = match kind {
        Envelope::Plane => ["normal_stress", "shear_stress"],
        Envelope::Circles => ["lateral_stress", "deviator_stress"],
    };
    let mut list = Vec::new();
    if levels.len() < 2 {
        return list;
    }
    let seeds = levels[0].figures.first().map_or(0, |figure| figure.values.len());
    for state in ["peak", "residual"] {
        let value = |level: &Level, name: &str, seed: usize| {
            let figure = level.figures.iter().find(|f| f.name == format!("{state}_{name}"))?;
            figure.values.get(seed).copied().flatten()
        };
        let of_seed = |seed: usize| -> (f64, f64) {
            let points: Vec<(f64, f64)> = levels
                .iter()
                .filter_map(|l| Some((value(l, normal, seed)?, value(l, shear, seed)?)))
                .collect();
            let (x, y): (Vec<f64>, Vec<f64>) = match kind {
                Envelope::Plane => points.into_iter().unzip(),
                Envelope::Circles => points.into_iter().map(|(s3, q)| (s3 + 0.5 * q, 0.5 * q)).unzip(),
            };
            let (intercept, slope) = line(&x, &y);
            match kind {
                Envelope::Plane => (slope.atan(), intercept),
                Envelope::Circles => (slope.asin(), intercept / slope.asin().cos()),
            }
        };
        let all: Vec<(f64, f64)> = (0..seeds).map(of_seed).collect();
        let angles: Vec<f64> = all.iter().map(|(angle, _)| angle.to_degrees()).collect();
        let cohesions: Vec<f64> = all.iter().map(|(_, cohesion)| *cohesion).collect();
        list.push(Figure::of(&format!("{state}_friction_angle"), "deg", &angles));
        list.push(Figure::of(&format!("{state}_cohesion"), "Pa", &cohesions));
    }
    list
}

/// Fewest strengths that a Weibull line is drawn through.
const FEWEST: usize = 5;

/// Weibull's modulus m [–] and scale σ₀ of strengths above 0, by maximum likelihood:
///
/// ```text
/// P(σ) = 1 − exp(−(σ/σ₀)^m)      1/m = Σ σᵐ ln σ/Σ σᵐ − mean ln σ      σ₀ᵐ = mean σᵐ
/// ```
pub fn weibull(strengths: &[f64]) -> (f64, f64) {
    let n = strengths.len() as f64;
    let mean = strengths.iter().map(|s| s.ln()).sum::<f64>() / n;
    let logs: Vec<f64> = strengths.iter().map(|s| s.ln() - mean).collect();
    let excess = |m: f64| {
        let (over, sum) = logs.iter().fold((0.0, 0.0), |s, l| {
            let weight = (m * l).exp();
            (s.0 + weight * l, s.1 + weight)
        });
        over / sum - 1.0 / m
    };
    let (mut low, mut high): (f64, f64) = (1e-3, 1e3);
    for _ in 0..200 {
        let middle = (low * high).sqrt();
        *(if excess(middle) < 0.0 { &mut low } else { &mut high }) = middle;
    }
    let m = (low * high).sqrt();
    let power = logs.iter().map(|l| (m * l).exp()).sum::<f64>() / n;
    (m, (mean + power.ln() / m).exp())
}

/// Both as figures. Interval of m: that of its asymptotic variance 6 m²/(π² n) (Thoman, Bain & Antle 1969,
/// doi:10.1080/00401706.1969.10490706).
pub(crate) fn weibull_figures(strengths: &[f64]) -> Vec<Figure> {
    let strengths: Vec<f64> = strengths.iter().copied().filter(|s| s.is_finite() && *s > 0.0).collect();
    if strengths.len() < FEWEST {
        return Vec::new();
    }
    let (m, scale) = weibull(&strengths);
    let of = |name: &str, unit: &str, value: f64, interval: Option<f64>| Figure {
        name: name.to_owned(),
        unit: unit.to_owned(),
        mean: number(value),
        interval,
        values: Vec::new(),
    };
    let half = 1.96 * m * (6.0 / strengths.len() as f64).sqrt() / std::f64::consts::PI;
    vec![of("weibull_modulus", "", m, number(half)), of("weibull_scale", "Pa", scale, None)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels(kind: Envelope) -> Vec<Level> {
        let (angle, cohesion) = (30f64.to_radians(), 1000.0);
        let one = |stress: f64| {
            let shear = match kind {
                Envelope::Plane => cohesion + stress * angle.tan(),
                // σ₁ = σ₃ (1 + sin φ)/(1 − sin φ) + 2 c cos φ/(1 − sin φ)
                Envelope::Circles => {
                    (2.0 * stress * angle.sin() + 2.0 * cohesion * angle.cos()) / (1.0 - angle.sin())
                }
            };
            let names = match kind {
                Envelope::Plane => ["normal_stress", "shear_stress"],
                Envelope::Circles => ["lateral_stress", "deviator_stress"],
            };
            let figure = |name: &str, value: f64| Figure::of(&format!("peak_{name}"), "Pa", &[value, value]);
            Level { stress: Some(stress), figures: vec![figure(names[0], stress), figure(names[1], shear)] }
        };
        vec![one(1e4), one(2e4), one(5e4)]
    }

    #[test]
    fn both_envelopes_find_angle_and_cohesion() {
        for kind in [Envelope::Plane, Envelope::Circles] {
            let list = envelope(kind, &levels(kind));
            assert!((list[0].mean.unwrap() - 30.0).abs() < 1e-9, "{kind:?}: {list:?}");
            assert!((list[1].mean.unwrap() - 1000.0).abs() < 1e-6, "{kind:?}: {list:?}");
            assert!(envelope(kind, &levels(kind)[..1]).is_empty());
        }
    }

    #[test]
    fn the_weibull_line_of_exact_quantiles() {
        let strengths: Vec<f64> =
            (0..400).map(|k| 2e6 * (-(1.0 - (k as f64 + 0.5) / 400.0).ln()).powf(1.0 / 4.0)).collect();
        let found = weibull_figures(&strengths);
        assert!(
            (found[0].mean.unwrap() - 4.0).abs() < 0.05 && (found[1].mean.unwrap() / 2e6 - 1.0).abs() < 2e-3,
            "{found:?}"
        );
        assert!(weibull_figures(&strengths[..4]).is_empty());
    }
}
