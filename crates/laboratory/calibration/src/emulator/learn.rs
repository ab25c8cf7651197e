//! How an emulator learns: outputs along their principal directions, the process of each, and how specimens scatter.

use super::crossed::crossed;
use super::gp::{Gp, LeftOut, Logs};
use super::likelihood::Scatter;
use super::prediction::{Emulator, Refined};
use super::trend::Trend;
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

/// Deviation of a process over the trials, in deviations of data and specimens, below which it only scatters.
const FLAT: f64 = 0.1;
/// Trials near the data, at least.
const NEAR: usize = 60;
/// Share by which the correlations of specimens are lowered: those of few trials are never exact.
const SHRINK: f64 = 0.05;
/// Most trials that an emulator learns from.
pub(crate) const MOST_TRIALS: usize = 400;

/// What an emulator learns from.
pub(crate) struct Lessons<'a> {
    /// Coordinates of the trials, a row each.
    pub inputs: DMatrix<f64>,
    /// Curves, a row each.
    pub outputs: DMatrix<f64>,
    pub data: DVector<f64>,
    /// Covariance of the data.
    pub covariance: DMatrix<f64>,
    /// Runs that each curve is the mean of, and specimens that the data are the mean of.
    pub seeds: f64,
    pub specimens: f64,
    /// Whether runs differ by their seeds.
    pub random: bool,
    /// Lengths of an earlier fit.
    pub before: &'a [Logs],
    /// What it refines: an emulator of the same parameters and data.
    pub refined: Option<&'a Emulator>,
}

impl Lessons<'_> {
    /// That of a component. Several specimens of the data tell it: their mean has a variance of 1, and runs are expected to scatter as they do.
    fn scatter(&self) -> Scatter {
        match self.random {
            false => Scatter::None,
            true if self.specimens > 1.0 => Scatter::About(self.specimens / self.seeds),
            true => Scatter::Unknown,
        }
    }
}

impl Emulator {
    /// Learns; `None` if the numbers do not allow it.
    pub fn learn(lessons: &Lessons) -> Option<Emulator> {
        let Outputs { factor, mean, basis, scores, target, beside } = Outputs::of(lessons)?;
        let refined = lessons.refined.map(|other| Refined::new(other, &basis, &mean));
        let features = Features::of(lessons, refined.as_ref(), scores.nrows());
        let mut components = features.processes(lessons, &scores)?;
        let left_out = features.left_out(lessons, &scores, &components)?;
        let near = nearest(&scores, &target, lessons.inputs.ncols());
        let off = rescale(&mut components, &left_out, &near);
        let noise: Vec<f64> =
            components.iter().map(|gp| gp.noise * lessons.seeds / lessons.specimens).collect();
        let chance: Vec<f64> =
            components.iter().map(|gp| if lessons.random { gp.noise } else { 0.0 }).collect();
        let unseen = unseen(&left_out, &chance, &scores);
        let alike = off.tr_mul(&off) / near.len() as f64;
        let wider = hartlap(near.len(), components.len());
        let specimens = DMatrix::from_fn(noise.len(), noise.len(), |k, l| {
            let share = if k == l { 1.0 } else { (1.0 - SHRINK) * alike[(k, l)] };
            wider * share * (noise[k] * noise[l]).sqrt()
        });
        let changes = |k: &usize| components[*k].deviation() > FLAT * (1.0 + noise[*k]).sqrt();
        let active: Vec<usize> = (0..components.len()).filter(changes).collect();
        let (target, points) = (target.iter().copied().collect(), lessons.data.len());
        Some(Emulator {
            components,
            target,
            noise,
            chance,
            active,
            specimens,
            beside,
            points,
            unseen,
            factor,
            mean,
            basis,
            refined,
        })
    }
}

/// By how much trials that are left out are missed, beside chance, over how much all trials spread (root mean squares over trials and components).
fn unseen(left_out: &[Vec<LeftOut>], chance: &[f64], scores: &DMatrix<f64>) -> f64 {
    let n = scores.ncols() as f64;
    let error = |(all, chance): (&Vec<LeftOut>, &f64)| {
        (all.iter().map(|o| o.error * o.error).sum::<f64>() / n - chance).max(0.0)
    };
    let missed: f64 = left_out.iter().zip(chance).map(error).sum();
    // Scores have no mean.
    let spread = (scores.norm_squared() / n - chance.iter().sum::<f64>()).max(1e-300);
    (missed / spread).sqrt()
}

/// The inverse of a covariance of few samples is too large on average: the covariance is widened by this factor. Hartlap, Simon & Schneider
/// (2007), doi:10.1051/0004-6361:20066170.
fn hartlap(samples: usize, components: usize) -> f64 {
    let (n, p) = (samples as f64, components as f64);
    (n - 1.0) / (n - p - 2.0).max(0.25 * n)
}

/// The trials whose curves are nearest to the data. Specimens scatter more where curves are large: the variances of emulator and specimens are
/// those that predict these trials, each left out, rightly.
fn nearest(scores: &DMatrix<f64>, target: &DVector<f64>, d: usize) -> Vec<usize> {
    let far = |i: &usize| (scores.column(*i) - target).norm_squared();
    let mut order: Vec<usize> = (0..scores.ncols()).collect();
    order.sort_by(|a, b| far(a).total_cmp(&far(b)));
    order.truncate(NEAR.max(5 * d).min((order.len() / 2).max(20)));
    order
}

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
    ) -> Option<Vec<Vec<LeftOut>>> {
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
pub(super) fn rescale(components: &mut [Gp], left_out: &[Vec<LeftOut>], near: &[usize]) -> DMatrix<f64> {
    let mut off = DMatrix::zeros(near.len(), components.len());
    for (k, (gp, all)) in components.iter_mut().zip(left_out).enumerate() {
        let mean = near.iter().map(|&i| all[i].scaled().powi(2)).sum::<f64>() / near.len() as f64;
        gp.rescale(mean.max(LEAST_FACTOR));
        off.column_mut(k)
            .iter_mut()
            .zip(near)
            .for_each(|(o, &i)| *o = all[i].scaled() / mean.max(1e-300).sqrt());
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

#[cfg(test)]
mod tests {
    use super::*;
    use geom::random::{generator, unit};

    /// Two outputs that a specimen shifts together by a deviation of 0.3; the data are known to 0.01.
    #[test]
    fn a_specimen_counts_once_however_many_points_show_it() {
        let mut random = generator(1, 2, 3);
        let z: Vec<f64> = (0..120).map(|_| unit(&mut random)).collect();
        let noise: Vec<f64> =
            z.iter().map(|_| 0.3 * ((0..12).map(|_| unit(&mut random)).sum::<f64>() - 6.0)).collect();
        let emulator = Emulator::learn(&Lessons {
            inputs: DMatrix::from_column_slice(120, 1, &z),
            // The second output bends, so that both components tell something.
            outputs: DMatrix::from_fn(120, 2, |i, j| {
                if j == 0 { 2.0 * z[i] + noise[i] } else { z[i] * z[i] + noise[i] }
            }),
            data: DVector::from_column_slice(&[1.0, 0.25]),
            covariance: DMatrix::identity(2, 2) * 1e-4,
            seeds: 1.0,
            specimens: 1.0,
            random: false,
            before: &[],
            refined: None,
        })
        .unwrap();
        // 2 z − z² is free of the specimen; along it z = 0.5 is known to about 0.01, and the likelihood falls from there.
        let fall = |dz: f64| emulator.log_likelihood(&[0.5], 1.0) - emulator.log_likelihood(&[0.5 + dz], 1.0);
        assert!(emulator.active.len() == 2 && fall(0.2) > 2.0, "{} {}", emulator.active.len(), fall(0.2));
        // Four specimens at once would have half the deviation.
        let k = emulator.specimens.clone();
        let common = (k[(0, 0)] + k[(1, 1)]) * 1e-4;
        assert!((common - 2.0 * 0.09).abs() < 0.08, "variance of a specimen over both outputs: {common}");
    }
}
