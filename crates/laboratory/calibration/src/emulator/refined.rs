//! An emulator that another one refines.

use super::Emulator;
use nalgebra::{DMatrix, DVector};

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
