//! What the mean of a Gaussian process follows far from all points.

use super::likelihood::row;
use nalgebra::DMatrix;

/// What the mean follows far from all points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Trend {
    /// h = 1: where there are few points.
    Constant,
    /// h = (1, z).
    Linear,
    /// h = (1, m): inputs have a last entry m, what another emulator says, which has no length.
    Other,
}

impl Trend {
    /// The one that so many points of so many parameters allow.
    pub fn of(points: usize, parameters: usize) -> Trend {
        if points >= 2 * parameters + 4 { Trend::Linear } else { Trend::Constant }
    }

    /// Parameters of inputs with so many entries.
    pub fn parameters(self, entries: usize) -> usize {
        if self == Trend::Other { entries - 1 } else { entries }
    }

    /// The row h of a point.
    pub fn row(self, z: &[f64]) -> Vec<f64> {
        let rest = match self {
            Trend::Constant => &z[z.len()..],
            Trend::Linear => z,
            Trend::Other => &z[z.len() - 1..],
        };
        [&[1.0], rest].concat()
    }
}

/// Rows h.
pub(super) fn basis(inputs: &DMatrix<f64>, trend: Trend) -> DMatrix<f64> {
    let rows: Vec<Vec<f64>> =
        (0..inputs.nrows()).map(|i| trend.row(&row(inputs, i).collect::<Vec<_>>())).collect();
    DMatrix::from_fn(rows.len(), rows.first().map_or(1, Vec::len), |i, j| rows[i][j])
}
