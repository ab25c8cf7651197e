//! Bonds over time: how many are whole, how many broke and how, and the fragments that they leave.
//!
//! ```text
//! a bond breaks when σ > σ_t (tension) or τ > τ_s (shear)
//! ```
//!
//! A run records σ and τ of each bond; those of a broken one are the values at the break. Which of them broke it
//! follows from the strengths σ_t, τ_s in the scene of the run: it is the one with the larger ratio. If neither
//! reaches its strength, the bond is one of another scene (of an inlet), and the way it broke is unknown.

mod fragments;
mod observe;

pub use fragments::Fragments;
pub use observe::BondNumbers;

use crate::table::Columns;
use crate::{BondStrength, MeasureError};
use record::column::{BROKEN, BROKEN_AT, FIRST, SECOND, SHEAR, TENSION};
use record::topic::BONDS;
use stream::Table;

/// Rounding of recorded stresses (single precision).
const ROUNDING: f64 = 1e-6;

/// One bond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bond {
    /// Ids of both grains.
    pub grains: [u64; 2],
    /// Tension σ and shear τ [Pa]; of a broken bond those at the break.
    pub stress: [f64; 2],
    /// When it broke [s]; `None` while it is whole.
    pub broken: Option<f64>,
}

/// What broke a bond.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Break {
    /// Tension at its rim.
    Tension,
    /// Shear.
    Shear,
    /// Neither reaches a strength that the scene names.
    Unknown,
}

impl Bond {
    /// What broke it, by the strengths of its materials.
    pub fn break_by(&self, law: Option<&BondStrength>) -> Break {
        let Some(law) = law else { return Break::Unknown };
        let [tension, shear] = [0, 1].map(|k| self.stress[k] / law.strength[k]);
        match tension.max(shear) {
            largest if !(largest >= 1.0 - ROUNDING) => Break::Unknown,
            largest if largest == tension => Break::Tension,
            _ => Break::Shear,
        }
    }
}

/// All bonds at one time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Bonds {
    /// Time [s].
    pub time: f64,
    /// The rows, in the order of the message.
    pub rows: Vec<Bond>,
}

impl Bonds {
    /// Bonds from the table of a message: id_i, id_j, tension, shear, broken, broken_at.
    ///
    /// # Errors
    /// Columns that are missing, numbers that are not finite.
    pub fn new(time: f64, table: &Table) -> Result<Bonds, MeasureError> {
        let columns = Columns { topic: BONDS, time, table };
        let (i, j) = (columns.whole(FIRST)?, columns.whole(SECOND)?);
        let (tension, shear) = (columns.numbers(TENSION)?, columns.numbers(SHEAR)?);
        let (broken, at) = (columns.whole(BROKEN)?, columns.numbers(BROKEN_AT)?);
        let row = |k: usize| Bond {
            grains: [i[k], j[k]],
            stress: [tension[k], shear[k]],
            broken: (broken[k] != 0).then_some(at[k]),
        };
        Ok(Bonds { time, rows: (0..i.len()).map(row).collect() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stress_with_the_larger_share_of_its_strength_broke_a_bond() {
        let law = |strength| BondStrength { between: ["a".into(), "a".into()], strength };
        let bond = |stress| Bond { grains: [0, 1], stress, broken: Some(0.1) };
        let both = law([2.0, 4.0]);
        assert_eq!(bond([2.1, 3.0]).break_by(Some(&both)), Break::Tension);
        assert_eq!(bond([-9.0, 4.1]).break_by(Some(&both)), Break::Shear);
        // Both in one step.
        assert_eq!(bond([3.0, 4.4]).break_by(Some(&both)), Break::Tension);
        // As rounded in a file of single precision.
        assert_eq!(bond([2.0 - 1e-7, 0.0]).break_by(Some(&both)), Break::Tension);
        assert_eq!(bond([1.9, 3.9]).break_by(Some(&both)), Break::Unknown);
        assert_eq!(bond([1e9, 4.1]).break_by(Some(&law([f64::INFINITY, 4.0]))), Break::Shear);
        assert_eq!(bond([1e9, 1e9]).break_by(None), Break::Unknown);
    }
}
