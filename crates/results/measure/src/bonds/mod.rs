//! Bonds over time: how many are whole, how many broke and how, and the fragments that they leave.
//!
//! ```text
//! a bond breaks when σ > σ_t (tension) or τ > τ_s (shear)
//! ```
//!
//! A run records σ and τ of each bond; those of a broken one are the values at the break. It says which of them broke it; a run of an older
//! version does not.

mod crack;
mod cracks;
mod fragments;
mod grading;
mod observe;
pub mod pieces;

pub use crack::Crack;
pub use cracks::CrackList;
pub use fragments::Fragments;
pub use grading::{FragmentList, Grading, breakage};
pub use observe::BondNumbers;

use crate::MeasureError;
use crate::reading::table::Columns;
use geom::Vec3;
use record::column::{BROKEN, BROKEN_AT, FIRST, FORCE, MODE, SECOND, SHEAR, TENSION};
use record::topic::BONDS;
use stream::Table;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bond {
    /// Ids of both grains.
    pub grains: [u64; 2],
    /// Force on the first [N]; NaN where the run does not tell.
    pub force: Vec3,
    /// Tension σ and shear τ [Pa]; of a broken bond those at the break.
    pub stress: [f64; 2],
    /// When it broke [s]; `None` while it is whole.
    pub broken: Option<f64>,
    /// What broke it, if it did.
    pub by: Break,
}

/// What broke a bond.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Break {
    /// Tension at its rim.
    Tension,
    Shear,
    /// The run does not say.
    Unknown,
}

/// What broke a bond, by the number in a column.
fn break_of(mode: u64) -> Break {
    match mode {
        1 => Break::Tension,
        2 => Break::Shear,
        _ => Break::Unknown,
    }
}

/// A run without bonds.
const NO_BONDS: MeasureError = MeasureError::Channel {
    topic: BONDS,
    what: "bonds",
    cure: "give a run whose scene has a [[bond]] that joins grains",
};

/// All bonds at one time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Bonds {
    /// Time [s].
    pub time: f64,
    /// The rows, in the order of the message.
    pub rows: Vec<Bond>,
}

impl Bonds {
    /// Bonds from the table of a message: id_i, id_j, tension, shear, broken, broken_at, mode, and fx, fy, fz where it has them.
    ///
    /// # Errors
    /// Columns that are missing, numbers that are not finite.
    pub fn new(time: f64, table: &Table) -> Result<Bonds, MeasureError> {
        let columns = Columns { topic: BONDS, time, table };
        let (i, j) = (columns.whole(FIRST)?, columns.whole(SECOND)?);
        let force = match table.get(FORCE[0]) {
            Some(_) => columns.vectors(FORCE)?,
            None => vec![Vec3::repeat(f64::NAN); i.len()],
        };
        let (tension, shear) = (columns.numbers(TENSION)?, columns.numbers(SHEAR)?);
        let (broken, at) = (columns.whole(BROKEN)?, columns.numbers(BROKEN_AT)?);
        let mode = columns.or_zero(MODE)?;
        let row = |k: usize| Bond {
            grains: [i[k], j[k]],
            force: force[k],
            stress: [tension[k], shear[k]],
            broken: (broken[k] != 0).then_some(at[k]),
            by: break_of(mode[k] as u64),
        };
        Ok(Bonds { time, rows: (0..i.len()).map(row).collect() })
    }
}
