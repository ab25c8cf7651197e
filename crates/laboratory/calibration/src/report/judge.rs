//! What the data tell, and what they cannot: intervals, pairs, sensitivities.

use crate::fit::sensitivity::{Sensitivity, sensitivity};
use crate::recipe::{Recipe, Step};
use crate::report::fitness::{StepFit, step_fit};
use crate::session::{StepEnd, Tried};
use serde::Serialize;

/// Share of its bounds at either end in which a best value is at the bound.
const AT_BOUND: f64 = 0.01;
/// Posterior width over prior width above which the data tell nothing of a parameter.
const DETERMINED: f64 = 0.85;
/// Rank correlation from which the data do not separate two parameters, if an interval of them is this wide, over that of the prior.
const TRADED: f64 = 0.8;
const WIDE: f64 = 0.15;
/// Ratio R̂ of chains from which their samples are not trusted.
const MIXED: f64 = 1.1;

/// What is known of one parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// Its name.
    pub parameter: String,
    /// Its unit; "" for none.
    pub unit: String,
    /// Median of the posterior.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Value at the best point: the least misfit that is expected, or, where a run of it is worse, the nearest trial.
    pub best: f64,
    /// Whether that is an end of its bounds.
    pub at_bound: bool,
    /// Interval before the tests.
    pub prior: [f64; 2],
    /// Width of the interval over that of the prior, on the parameter's scale.
    pub width: f64,
    /// Whether the data tell something of it.
    pub determined: bool,
    /// Largest total sensitivity of a part to it.
    pub influence: f64,
    /// The step that found it.
    pub step: String,
}

/// Two parameters that the data do not separate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Pair {
    /// Names.
    pub parameters: [String; 2],
    /// Rank correlation.
    pub correlation: f64,
    /// Two points that fit alike: (first, second) at one end, and at the other.
    pub ends: [[f64; 2]; 2],
}

/// Sensitivities of a part of a test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PartSensitivity {
    pub step: String,
    pub test: String,
    /// Names of the parameters.
    pub parameters: Vec<String>,
    /// Sobol indices alone.
    pub alone: Vec<f64>,
    /// Sobol indices with all others.
    pub total: Vec<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Judged {
    /// Content of the intervals.
    pub interval: f64,
    /// Each parameter.
    pub findings: Vec<Finding>,
    /// Pairs that the data do not separate.
    pub pairs: Vec<Pair>,
    pub sensitivities: Vec<PartSensitivity>,
    pub steps: Vec<StepFit>,
    /// Time of all runs [s].
    pub seconds: f64,
    /// Trials: done, stopped by a guard, failed, abandoned.
    pub trials: [usize; 4],
    /// How many trials use runs that were stopped, and what stopped the first.
    pub cut: (usize, Option<String>),
}

/// Judges what came out.
pub fn judge(recipe: &Recipe, tried: &[Tried], ends: &[StepEnd]) -> Judged {
    use crate::session::Status::{Abandoned, Done, Failed, Stopped};
    let sensitivities: Vec<PartSensitivity> = ends.iter().flat_map(|e| sensitivities(recipe, e)).collect();
    let finding = |k: usize| {
        let last = ends.iter().rev().find_map(|e| Some((e, e.fitted.step.fit.iter().position(|f| *f == k)?)));
        last.map(|(end, at)| finding(recipe, end, (k, at), &sensitivities))
    };
    let runs = ends.iter().filter_map(|end| end.best.run.as_ref());
    let cut = || tried.iter().filter_map(|t| t.cut.clone());
    Judged {
        cut: (cut().count(), cut().next()),
        interval: recipe.settings.interval,
        findings: (0..recipe.parameters.len()).filter_map(finding).collect(),
        pairs: ends.last().map_or(Vec::new(), |e| pairs(recipe, e)),
        sensitivities,
        steps: ends.iter().map(|end| step_fit(recipe, end)).collect(),
        seconds: tried.iter().chain(runs).map(|t| t.seconds).sum(),
        trials: [Done, Stopped, Failed, Abandoned].map(|s| tried.iter().filter(|t| t.status == s).count()),
    }
}

/// The value below which a share of sorted values lies.
pub(crate) fn quantile(sorted: &[f64], share: f64) -> f64 {
    let at = share * (sorted.len() - 1) as f64;
    let (k, rest) = (at.floor() as usize, at.fract());
    sorted[k] + rest * (sorted[(k + 1).min(sorted.len() - 1)] - sorted[k])
}

fn finding(recipe: &Recipe, end: &StepEnd, of: (usize, usize), sensitivities: &[PartSensitivity]) -> Finding {
    let (k, at) = of;
    let p = &recipe.parameters[k];
    let tail = 0.5 * (1.0 - recipe.settings.interval);
    let (values, best) = (end.samples.sorted(at), end.best_point()[at]);
    let ends = [tail, 1.0 - tail].map(|s| quantile(&values, s));
    let prior = [tail, 1.0 - tail].map(|s| p.prior_quantile(s));
    let width = (ends[1] - ends[0]) / (prior[1] - prior[0]);
    let influence =
        |s: &PartSensitivity| s.parameters.iter().position(|n| *n == p.name).map_or(0.0, |i| s.total[i]);
    Finding {
        parameter: p.name.clone(),
        unit: p.unit.clone(),
        value: p.value(quantile(&values, 0.5)),
        low: p.value(ends[0]),
        high: p.value(ends[1]),
        best: p.value(best),
        at_bound: !(AT_BOUND..=1.0 - AT_BOUND).contains(&best),
        prior: prior.map(|z| p.value(z)),
        width,
        determined: width < DETERMINED,
        influence: sensitivities
            .iter()
            .filter(|s| s.step == end.fitted.step.name)
            .map(influence)
            .fold(0.0, f64::max),
        step: end.fitted.step.name.clone(),
    }
}

fn sensitivities(recipe: &Recipe, end: &StepEnd) -> Vec<PartSensitivity> {
    let step: &Step = end.fitted.step;
    let of = |(part, emulator): (&crate::recipe::Part, &crate::emulator::Emulator)| {
        let Sensitivity { alone, total } = sensitivity(emulator, step.fit.len(), recipe.settings.seed);
        let parameters = step.fit.iter().map(|&k| recipe.parameters[k].name.clone()).collect();
        let test = &recipe.tests[part.test].name;
        PartSensitivity { step: step.name.clone(), test: test.clone(), parameters, alone, total }
    };
    step.to.iter().zip(&end.fitted.emulators).map(of).collect()
}

/// Ranks of values, from 0; equal ones have the mean of theirs. A chain stays where it is when a step is refused, so that its values come several times.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let (mut ranks, mut first) = (vec![0.0; values.len()], 0);
    for equal in order.chunk_by(|a, b| values[*a] == values[*b]) {
        let mean = first as f64 + 0.5 * (equal.len() - 1) as f64;
        equal.iter().for_each(|&k| ranks[k] = mean);
        first += equal.len();
    }
    ranks
}

/// Rank correlation: Spearman (1904), doi:10.2307/1412159; 0 where all values of one are equal.
pub(crate) fn rank_correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = 0.5 * (a.len() as f64 - 1.0);
    let [a, b] = [a, b].map(|values| ranks(values).into_iter().map(|rank| rank - mean).collect::<Vec<f64>>());
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let scale = (product(&a, &a) * product(&b, &b)).sqrt();
    if scale > 0.0 { product(&a, &b) / scale } else { 0.0 }
}

fn pairs(recipe: &Recipe, end: &StepEnd) -> Vec<Pair> {
    let fit = &end.fitted.step.fit;
    let tail = 0.5 * (1.0 - recipe.settings.interval);
    let column = |at: usize| -> Vec<f64> { end.samples.list.iter().map(|s| s.z[at]).collect() };
    let width = |at: usize| {
        let (values, p) = (end.samples.sorted(at), &recipe.parameters[fit[at]]);
        (quantile(&values, 1.0 - tail) - quantile(&values, tail))
            / (p.prior_quantile(1.0 - tail) - p.prior_quantile(tail))
    };
    let mut found = Vec::new();
    for i in 0..fit.len() {
        for j in 0..i {
            let (a, b) = (column(j), column(i));
            let correlation = rank_correlation(&a, &b);
            if correlation.abs() < TRADED || width(i).max(width(j)) < WIDE {
                continue;
            }
            let (p, q) = (&recipe.parameters[fit[j]], &recipe.parameters[fit[i]]);
            let sorted_a = end.samples.sorted(j);
            // The second where the first is in its lowest, and in its highest tenth.
            let near = |keep: &dyn Fn(f64) -> bool| {
                let mut some: Vec<(f64, f64)> =
                    a.iter().zip(&b).filter(|(a, _)| keep(**a)).map(|(a, b)| (*a, *b)).collect();
                some.sort_by(|x, y| x.1.total_cmp(&y.1));
                let (mean_a, middle) =
                    (some.iter().map(|s| s.0).sum::<f64>() / some.len() as f64, some[some.len() / 2].1);
                [p.value(mean_a), q.value(middle)]
            };
            let (low, high) = (quantile(&sorted_a, 0.1), quantile(&sorted_a, 0.9));
            let ends = [near(&|v| v <= low), near(&|v| v >= high)];
            found.push(Pair { parameters: [p.name.clone(), q.name.clone()], correlation, ends });
        }
    }
    found.sort_by(|a, b| b.correlation.abs().total_cmp(&a.correlation.abs()));
    found
}

impl Judged {
    /// Fits whose chains did not mix.
    pub fn unmixed(&self) -> impl Iterator<Item = &StepFit> {
        self.steps.iter().filter(|s| s.chains > MIXED)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_and_quantiles() {
        assert_eq!(quantile(&[0.0, 1.0, 2.0, 3.0], 0.5), 1.5);
        let (a, b) = ([1.0, 2.0, 3.0, 4.0], [1.0, 8.0, 27.0, 64.0]);
        assert!((rank_correlation(&a, &b) - 1.0).abs() < 1e-12);
        let b: Vec<f64> = b.iter().map(|v| -v).collect();
        assert!((rank_correlation(&a, &b) + 1.0).abs() < 1e-12);
        // Ties, as SciPy's `spearmanr` has them.
        let (a, b) = ([1.0, 2.0, 2.0, 3.0, 5.0, 5.0, 5.0], [2.0, 1.0, 1.0, 4.0, 4.0, 6.0, 7.0]);
        assert!((rank_correlation(&a, &b) - 0.8193821290142088).abs() < 1e-12);
        assert_eq!(rank_correlation(&[1.0, 1.0, 1.0], &[1.0, 2.0, 3.0]), 0.0);
    }
}
