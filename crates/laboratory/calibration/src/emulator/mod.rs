//! The emulator: from parameters to curves, learnt from trials.
//!
//! Curves are made white by the covariance of the data, C = L Lᵀ, so that a deviation of the data is 1, and written in their principal
//! components; each component is a Gaussian process of the parameters (Higdon, Gattiker, Williams & Rightley 2008,
//! doi:10.1198/016214507000000888).
//!
//! ```text
//! w = L⁻¹ y − w̄ = Σ_k a_k(z) φ_k        log p(data | z) = −½ [(t − a)ᵀ S⁻¹ (t − a) + ln det S],   S = s² I + V(z) + N
//! ```
//!
//! Where another emulator has learnt from like specimens, such as smaller ones, a component follows what that one says of it, m_k(z), and the process
//! is the difference (Kennedy & O'Hagan 2000, doi:10.1093/biomet/87.1.1, eq. 1):
//!
//! ```text
//! a_k(z) = β_0 + β_1 m_k(z) + f_k(z),   m_k = φ_kᵀ (w_other(z) − w̄)
//! ```
//!
//! t: components of the data; V: variances of the emulator; N: covariance of specimens, which deviate in all components at once, from the trials
//! nearest to the data, each left out; s² ≥ 1: how much the data deviate more than they say.

mod crossed;
mod gp;
mod learn;
mod likelihood;
mod refined;
mod rprop;
mod trend;

pub(crate) use gp::{Gp, Logs, Prediction};
use learn::{Features, Outputs, rescale};
use likelihood::Scatter;
use refined::Refined;

use nalgebra::{Cholesky, DMatrix, DVector};

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
    /// Data.
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

/// The emulator of one part.
#[derive(Clone)]
pub(crate) struct Emulator {
    /// A process for each component.
    pub components: Vec<Gp>,
    /// Components of the data.
    pub target: Vec<f64>,
    /// Variance of a specimen in each component.
    pub noise: Vec<f64>,
    /// Components that change with the parameters.
    pub active: Vec<usize>,
    /// Covariance of specimens in the components.
    specimens: DMatrix<f64>,
    /// Square of the data beside all components.
    pub beside: f64,
    /// Points of the data.
    pub points: usize,
    factor: DMatrix<f64>,
    mean: DVector<f64>,
    basis: DMatrix<f64>,
    refined: Option<Refined>,
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
            active,
            specimens,
            beside,
            points,
            factor,
            mean,
            basis,
            refined,
        })
    }

    /// What each component's process takes for a point.
    pub fn inputs(&self, z: &[f64]) -> Vec<Vec<f64>> {
        match &self.refined {
            None => vec![z.to_vec(); self.components.len()],
            Some(refined) => refined.at(z).iter().map(|m| [z, &[*m]].concat()).collect(),
        }
    }

    /// The components at a point.
    pub fn scores(&self, z: &[f64]) -> Vec<f64> {
        self.inputs(z).iter().zip(&self.components).map(|(z, gp)| gp.mean(z)).collect()
    }

    /// Logarithm of the likelihood, up to a constant.
    pub fn log_likelihood(&self, z: &[f64], inflation: f64) -> f64 {
        match self.square(z, inflation, &self.active) {
            Some((square, log_det)) => -0.5 * (square + log_det),
            None => f64::NEG_INFINITY,
        }
    }

    /// Square of the misfit at a point, over the deviations of data and emulator.
    pub fn misfit(&self, z: &[f64]) -> f64 {
        let all: Vec<usize> = (0..self.components.len()).collect();
        self.beside + self.square(z, 1.0, &all).map_or(f64::INFINITY, |s| s.0)
    }

    /// (t − a)ᵀ S⁻¹ (t − a) and ln det S of some components, S = s² I + V(z) + N.
    fn square(&self, z: &[f64], inflation: f64, of: &[usize]) -> Option<(f64, f64)> {
        let inputs = self.inputs(z);
        let predictions: Vec<Prediction> =
            of.iter().map(|&k| self.components[k].predict(&inputs[k])).collect();
        let s = DMatrix::from_fn(of.len(), of.len(), |i, j| {
            let own = if i == j { inflation + predictions[i].variance } else { 0.0 };
            own + self.specimens[(of[i], of[j])]
        });
        let mut off = DVector::from_fn(of.len(), |i, _| self.target[of[i]] - predictions[i].mean);
        let chol = Cholesky::new(s)?;
        chol.l_dirty().solve_lower_triangular_mut(&mut off);
        let log_det = chol.l_dirty().diagonal().iter().map(|v| 2.0 * libm::log(*v)).sum();
        Some((off.norm_squared(), log_det))
    }

    /// The components that tell something, at a point.
    pub fn telling(&self, z: &[f64]) -> DVector<f64> {
        let scores = self.scores(z);
        DVector::from_iterator(self.active.len(), self.active.iter().map(|&k| scores[k]))
    }

    /// Covariance of data and specimens in those components.
    pub fn scatter(&self, inflation: f64) -> DMatrix<f64> {
        let n = self.active.len();
        DMatrix::identity(n, n) * inflation
            + DMatrix::from_fn(n, n, |i, j| self.specimens[(self.active[i], self.active[j])])
    }

    /// The mean curve at a point.
    pub fn curve(&self, z: &[f64]) -> Vec<f64> {
        let white = &self.mean + &self.basis * DVector::from_vec(self.scores(z));
        (&self.factor * white).iter().copied().collect()
    }

    /// Lengths, to begin the next fit with.
    pub fn logs(&self) -> Vec<Logs> {
        self.components.iter().map(|gp| gp.logs.clone()).collect()
    }
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

/// Square of the white distance of a curve from the data.
pub(crate) fn distance(covariance: &DMatrix<f64>, off: &DVector<f64>) -> f64 {
    let white = Cholesky::new(covariance.clone()).and_then(|c| c.l_dirty().solve_lower_triangular(off));
    white.map_or(f64::INFINITY, |w| w.norm_squared())
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
