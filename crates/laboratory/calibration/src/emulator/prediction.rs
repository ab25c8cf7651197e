//! What an emulator says of a point: its components, its curve, and the likelihood of the data there.

use super::gp::{Gp, Logs, Prediction};
use nalgebra::{Cholesky, DMatrix, DVector};

/// What is expected of the square of a misfit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Expected {
    pub mean: f64,
    pub variance: f64,
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
    /// Variance of runs from one seed to the next in each component; 0 where the same point gives the same run.
    pub chance: Vec<f64>,
    /// Components that change with the parameters.
    pub active: Vec<usize>,
    /// Covariance of specimens in the components.
    pub(super) specimens: DMatrix<f64>,
    /// Square of the data beside all components.
    pub beside: f64,
    /// Points of the data.
    pub points: usize,
    /// By how much trials that are left out are missed, beside chance, over how much all trials spread.
    pub unseen: f64,
    pub(super) factor: DMatrix<f64>,
    pub(super) mean: DVector<f64>,
    pub(super) basis: DMatrix<f64>,
    pub(super) refined: Option<Refined>,
}

impl Emulator {
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

    /// What is expected of the square of the misfit of a run at a point, over the deviations of the data alone.
    pub fn expected(&self, z: &[f64]) -> Expected {
        let (inputs, mut all) = (self.inputs(z), Expected { mean: self.beside, variance: 0.0 });
        for ((gp, input), target) in self.components.iter().zip(&inputs).zip(&self.target) {
            let Prediction { mean, variance } = gp.predict(input);
            let (square, own) = ((mean - target) * (mean - target), variance + gp.noise);
            all.mean += square + own;
            all.variance += 4.0 * own * square + 2.0 * own * own;
        }
        all
    }

    /// Variance of the emulator over that of data and specimens at a point, of each component that tells something.
    pub fn shares(&self, z: &[f64], inflation: f64) -> Vec<f64> {
        let inputs = self.inputs(z);
        let of = |&k: &usize| self.components[k].predict(&inputs[k]).variance / (inflation + self.noise[k]);
        self.active.iter().map(of).collect()
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

/// An emulator that another one refines, in the components of that one.
#[derive(Clone)]
pub(super) struct Refined {
    emulator: Box<Emulator>,
    /// From its components to the others: m = turn · scores + offset.
    turn: DMatrix<f64>,
    offset: DVector<f64>,
}

impl Refined {
    /// Of the components of a basis, from a mean on.
    pub fn new(emulator: &Emulator, basis: &DMatrix<f64>, mean: &DVector<f64>) -> Refined {
        let turn = basis.tr_mul(&emulator.basis);
        let offset = basis.tr_mul(&(&emulator.mean - mean));
        Refined { emulator: Box::new(emulator.clone()), turn, offset }
    }

    /// What it says of each component at a point.
    pub fn at(&self, z: &[f64]) -> DVector<f64> {
        &self.turn * DVector::from_vec(self.emulator.scores(z)) + &self.offset
    }
}

/// Square of the white distance of a curve from the data.
pub(crate) fn distance(covariance: &DMatrix<f64>, off: &DVector<f64>) -> f64 {
    let white = Cholesky::new(covariance.clone()).and_then(|c| c.l_dirty().solve_lower_triangular(off));
    white.map_or(f64::INFINITY, |w| w.norm_squared())
}
