//! Steps in which an emulator learns: outputs along their principal directions, and the process of each.

use super::crossed::crossed;
use super::refined::Refined;
use super::trend::Trend;
use super::{Gp, Lessons};
use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;

/// Most components of a curve.
const MOST: usize = 10;
/// Deviation of a component over all trials, in deviations of the data, below which it tells nothing.
const LEAST: f64 = 0.05;
/// Trials a parameter, below which lengths are fitted again where points are left out.
const FEW: usize = 10;
/// Least factor on the variances.
const LEAST_FACTOR: f64 = 1e-3;

/// Outputs and data in units of their deviations, along the principal directions of the outputs.
pub(super) struct Outputs {
    /// Cholesky factor of the covariance of the data: it makes them white.
    pub factor: DMatrix<f64>,
    /// Mean of the white outputs.
    pub mean: DVector<f64>,
    /// Principal directions.
    pub basis: DMatrix<f64>,
    /// White outputs, less their mean, along these: a column for each trial.
    pub scores: DMatrix<f64>,
    /// The data likewise.
    pub target: DVector<f64>,
    /// Square of the distance from the data to the space of these directions.
    pub beside: f64,
}

impl Outputs {
    pub fn of(lessons: &Lessons) -> Option<Outputs> {
        let factor = Cholesky::new(lessons.covariance.clone())?.unpack();
        let mut off = factor.solve_lower_triangular(&lessons.outputs.transpose())?;
        let mean = off.column_mean();
        off.column_iter_mut().for_each(|mut c| c -= &mean);
        let basis = principal(&off, off.ncols() as f64)?;
        let target_white = factor.solve_lower_triangular(&lessons.data)? - &mean;
        let target = basis.tr_mul(&target_white);
        let beside = (target_white.norm_squared() - target.norm_squared()).max(0.0);
        let scores = basis.tr_mul(&off);
        Some(Outputs { factor, mean, basis, scores, target, beside })
    }
}

/// What the process of each component learns from: the parameters, and what the emulator that is refined says.
pub(super) struct Features {
    inputs: Vec<DMatrix<f64>>,
    trends: Vec<Trend>,
}

impl Features {
    pub fn of(lessons: &Lessons, refined: Option<&Refined>, components: usize) -> Features {
        let trial = |i: usize| lessons.inputs.row(i).iter().copied().collect::<Vec<_>>();
        let said: Option<Vec<DVector<f64>>> =
            refined.map(|r| (0..lessons.inputs.nrows()).map(|i| r.at(&trial(i))).collect());
        // Where the other emulator says one thing of all trials, there is no line to follow.
        let line = |k: usize| {
            let said = said.as_ref()?;
            let line = DVector::from_fn(said.len(), |i, _| said[i][k]);
            (line.variance() > LEAST * LEAST).then_some(line)
        };
        let plain = &lessons.inputs;
        let with = |line: DVector<f64>| {
            let mut wide = plain.clone().insert_column(plain.ncols(), 0.0);
            wide.set_column(plain.ncols(), &line);
            wide
        };
        let lines: Vec<Option<DVector<f64>>> = (0..components).map(line).collect();
        let trend = |line: &Option<DVector<f64>>| match (refined, line) {
            (None, _) => Trend::of(plain.nrows(), plain.ncols()),
            (Some(_), Some(_)) => Trend::Other,
            (Some(_), None) => Trend::Constant,
        };
        let trends = lines.iter().map(trend).collect();
        let inputs = lines.into_iter().map(|line| line.map_or_else(|| plain.clone(), with)).collect();
        Features { inputs, trends }
    }

    /// The process of each component.
    pub fn processes(&self, lessons: &Lessons, scores: &DMatrix<f64>) -> Option<Vec<Gp>> {
        let same = lessons.before.len() == scores.nrows();
        let fit = |k: usize| {
            let start = if same { lessons.before.get(k) } else { None };
            Gp::fit(&self.inputs[k], &scores.row(k).transpose(), (lessons.scatter(), start), self.trends[k])
        };
        (0..scores.nrows()).into_par_iter().map(fit).collect()
    }

    /// Errors of each component at each trial that is left out, over their deviations; of few trials by fitting again without it.
    pub fn left_out(
        &self,
        lessons: &Lessons,
        scores: &DMatrix<f64>,
        components: &[Gp],
    ) -> Option<Vec<Vec<f64>>> {
        let few = lessons.inputs.nrows() < FEW * lessons.inputs.ncols();
        let left_out = |(k, gp): (usize, &Gp)| match few {
            true => crossed(gp, &self.inputs[k], &scores.row(k).transpose(), lessons.scatter())
                .or_else(|| gp.left_out()),
            false => gp.left_out(),
        };
        components.par_iter().enumerate().map(left_out).collect()
    }
}

/// Makes the deviations of each component as wide as its errors at the trials `near` the data say; the errors over that.
pub(super) fn rescale(components: &mut [Gp], left_out: &[Vec<f64>], near: &[usize]) -> DMatrix<f64> {
    let mut off = DMatrix::zeros(near.len(), components.len());
    for (k, (gp, all)) in components.iter_mut().zip(left_out).enumerate() {
        let mean = near.iter().map(|&i| all[i] * all[i]).sum::<f64>() / near.len() as f64;
        gp.rescale(mean.max(LEAST_FACTOR));
        off.column_mut(k).iter_mut().zip(near).for_each(|(o, &i)| *o = all[i] / mean.max(1e-300).sqrt());
    }
    off
}

/// Principal directions of the columns, those that tell something.
fn principal(off: &DMatrix<f64>, n: f64) -> Option<DMatrix<f64>> {
    let square = (off * off.transpose()) / n;
    let eigen = square.symmetric_eigen();
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let largest = eigen.eigenvalues[*order.first()?];
    let tells = |k: &&usize| eigen.eigenvalues[**k] > (LEAST * LEAST).max(1e-12 * largest);
    let mut kept: Vec<usize> = order.iter().filter(tells).take(MOST).copied().collect();
    if kept.is_empty() {
        kept.push(order[0]);
    }
    let mut basis = eigen.eigenvectors.select_columns(&kept);
    // The sign of a direction is free: the largest entry is positive, so that fits follow on from each other.
    for mut column in basis.column_iter_mut() {
        let largest = column.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(1.0);
        if largest < 0.0 {
            column.neg_mut();
        }
    }
    Some(basis)
}
