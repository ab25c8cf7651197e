//! The error of each setting against the truth.
//!
//! ```text
//! d = mean over seeds of (v − v₀)          v₀ is the truth, or what the reference measured with the same seed
//! error = ‖d‖ / ‖mean v₀‖                  ‖d‖ where the truth is zero
//! interval = t s/√n of v − v₀, and the uncertainty of a value from a laboratory, as the root of the squares
//! ```
//!
//! Where runs differ by the phase of the step at which contacts begin and not by a seed, one run of the user has one phase, which is
//! not known: the worst counts, and what is uncertain is the reference.
//!
//! ```text
//! error = max over phases ‖v − mean v₀‖ / ‖mean v₀‖        interval = max over phases ‖v₀ − mean v₀‖ / ‖mean v₀‖
//! ```
//!
//! ‖·‖ is over the points of a profile: the root mean square, or the largest value. For a single number it is its size.
//! Differences are taken seed by seed, so scatter that both runs share does not count. Where
//! runs of one seed diverge by chaos, the interval is that of two independent means.

use crate::point::{Error, MeasuredRun, Point};
use measure::statistics::Mean;

/// What a setting is compared with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Truth {
    /// A number and its uncertainty (half width of its 95 % interval, 0 for an analytic answer).
    Value(f64, f64),
    /// The point of this index.
    Point(usize),
}

/// How the runs of one setting differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Repeats {
    /// By the seed of their random numbers.
    Seeds,
    /// By the phase of the step at which contacts begin.
    Phases,
}

/// How a profile becomes one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Norm {
    /// Root of the mean of the squares.
    #[default]
    Rms,
    /// The largest.
    Max,
}

impl Norm {
    fn of(self, values: &[f64]) -> f64 {
        match self {
            Norm::Rms => (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt(),
            Norm::Max => values.iter().fold(0.0, |most, v| v.abs().max(most)),
        }
    }
}

/// The error of every point; `None` where there is nothing to compare: a point that failed, or whose seeds the reference
/// does not have, or profiles of different lengths.
pub fn errors(points: &[Point], truth: Truth, norm: Norm, repeats: Repeats) -> Vec<Option<Error>> {
    let one = |p: &Point| match repeats {
        Repeats::Seeds => error(&p.samples, points, truth, norm),
        Repeats::Phases => worst(&p.samples, points, truth, norm),
    };
    points.iter().map(one).collect()
}

/// The worst of several phases; `None` as in [`errors`].
fn worst(samples: &[MeasuredRun], points: &[Point], truth: Truth, norm: Norm) -> Option<Error> {
    let places = samples.first()?.value.len();
    let right: Vec<&[f64]> = match truth {
        Truth::Value(..) => Vec::new(),
        Truth::Point(at) => points.get(at)?.samples.iter().map(|s| s.value.as_slice()).collect(),
    };
    if places == 0
        || samples.iter().map(|s| s.value.len()).chain(right.iter().map(|r| r.len())).any(|n| n != places)
    {
        return None;
    }
    let (mean, known) = match truth {
        Truth::Value(value, uncertainty) => (vec![value; places], uncertainty),
        Truth::Point(_) => {
            let at = |k: usize| right.iter().map(|r| r[k]).sum::<f64>() / right.len() as f64;
            ((0..places).map(at).collect::<Vec<f64>>(), 0.0)
        }
    };
    let off = |value: &[f64]| norm.of(&value.iter().zip(&mean).map(|(v, m)| v - m).collect::<Vec<f64>>());
    let scatter = right.iter().map(|r| off(r)).fold(0.0, f64::max);
    let size = samples.iter().map(|s| off(&s.value)).fold(0.0, f64::max);
    let scale = norm.of(&mean);
    let relative = scale > 0.0;
    let unit = if relative { scale } else { 1.0 };
    (size.is_finite() && scatter.is_finite()).then_some(Error {
        size: size / unit,
        interval: scatter.hypot(known) / unit,
        relative,
    })
}

fn error(samples: &[MeasuredRun], points: &[Point], truth: Truth, norm: Norm) -> Option<Error> {
    let mut pairs: Vec<(&[f64], Vec<f64>)> = Vec::new();
    // Runs that were only repeated for their time say nothing new.
    let mut seeds: Vec<u64> = Vec::new();
    for sample in samples {
        if seeds.contains(&sample.seed) {
            continue;
        }
        let right = match truth {
            Truth::Value(value, _) => vec![value; sample.value.len()],
            Truth::Point(at) => points.get(at)?.samples.iter().find(|s| s.seed == sample.seed)?.value.clone(),
        };
        if right.len() != sample.value.len() || right.is_empty() {
            return None;
        }
        seeds.push(sample.seed);
        pairs.push((&sample.value, right));
    }
    let places = pairs.first()?.1.len();
    if pairs.iter().any(|(_, right)| right.len() != places) {
        return None;
    }
    let at = |k: usize| Mean::of(&pairs.iter().map(|(v, right)| v[k] - right[k]).collect::<Vec<f64>>());
    let differences: Vec<Mean> = (0..places).map(at).collect();
    let right = |k: usize| pairs.iter().map(|(_, right)| right[k]).sum::<f64>() / pairs.len() as f64;
    let scale = norm.of(&(0..places).map(right).collect::<Vec<f64>>());
    let relative = scale > 0.0;
    let unit = if relative { scale } else { 1.0 };
    let chance = norm.of(&differences.iter().map(|d| d.interval).collect::<Vec<f64>>());
    let known = match truth {
        Truth::Value(_, uncertainty) => uncertainty,
        Truth::Point(_) => 0.0,
    };
    // One run has no scatter; the uncertainty of the truth is known.
    let chance = if pairs.len() < 2 { if known > 0.0 { 0.0 } else { f64::NAN } } else { chance };
    let size = norm.of(&differences.iter().map(|d| d.mean).collect::<Vec<f64>>()) / unit;
    let interval = chance.hypot(known) / unit;
    size.is_finite().then_some(Error { size, interval, relative })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(values: &[f64]) -> Point {
        let sample = |(k, v): (usize, &f64)| MeasuredRun { value: vec![*v], work: 1.0, seed: k as u64 };
        Point { setting: Vec::new(), samples: values.iter().enumerate().map(sample).collect(), failed: None }
    }

    #[test]
    fn error_and_interval_of_repeats_are_those_of_the_tables() {
        // Differences from 10: 1, 2, 3; mean 2, s = 1, t(2) = 4.303.
        let found = errors(&[point(&[11.0, 12.0, 13.0])], Truth::Value(10.0, 0.0), Norm::Rms, Repeats::Seeds)
            [0]
        .unwrap();
        assert!((found.size - 0.2).abs() < 1e-12 && found.relative, "{found:?}");
        assert!((found.interval - 0.1 * 4.3027 / 3f64.sqrt()).abs() < 1e-4, "{found:?}");
    }

    #[test]
    fn of_phases_the_worst_counts_and_the_scatter_of_the_reference_is_the_interval() {
        let found = errors(&[point(&[10.1, 9.7, 10.2])], Truth::Value(10.0, 0.0), Norm::Rms, Repeats::Phases)
            [0]
        .unwrap();
        assert!((found.size - 0.03).abs() < 1e-12 && found.interval == 0.0, "{found:?}");
        let points = [point(&[10.0, 10.2]), point(&[10.4, 10.1])];
        let found = errors(&points, Truth::Point(0), Norm::Rms, Repeats::Phases)[1].unwrap();
        assert!(
            (found.size - 0.3 / 10.1).abs() < 1e-12 && (found.interval - 0.1 / 10.1).abs() < 1e-12,
            "{found:?}"
        );
    }

    #[test]
    fn what_chance_does_to_both_alike_is_no_chance() {
        let points = [point(&[5.0, 9.0, 14.0]), point(&[5.5, 9.5, 14.5])];
        let found = errors(&points, Truth::Point(0), Norm::Rms, Repeats::Seeds)[1].unwrap();
        assert!(found.interval < 1e-12 && (found.size - 0.5 / (28.0 / 3.0)).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn a_zero_truth_gives_errors_in_the_unit_and_a_laboratory_widens_the_interval() {
        let found = errors(&[point(&[0.3])], Truth::Value(0.0, 0.0), Norm::Rms, Repeats::Seeds)[0].unwrap();
        assert!(!found.relative && found.size == 0.3 && found.interval.is_nan() && found.upper() == 0.3);
        let found = errors(&[point(&[36.0])], Truth::Value(35.0, 0.7), Norm::Rms, Repeats::Seeds)[0].unwrap();
        assert!((found.interval - 0.02).abs() < 1e-12 && (found.upper() - 1.7 / 35.0).abs() < 1e-12);
    }

    #[test]
    fn profiles_are_compared_place_by_place() {
        let profile = |value: &[f64]| Point {
            samples: vec![MeasuredRun { value: value.to_vec(), work: 1.0, seed: 0 }],
            ..point(&[])
        };
        let points = [profile(&[3.0, 4.0]), profile(&[3.0, 5.0]), profile(&[1.0])];
        let rms = errors(&points, Truth::Point(0), Norm::Rms, Repeats::Seeds);
        assert!((rms[1].unwrap().size - 0.2).abs() < 1e-12, "{rms:?}");
        assert_eq!(rms[2], None);
        assert!(
            (errors(&points, Truth::Point(0), Norm::Max, Repeats::Seeds)[1].unwrap().size - 0.25).abs()
                < 1e-12
        );
    }
}
