//! What became of the specimens of a test.

use crate::recipes::{Loading, Value};
use crate::series::Curve;
use record::StopCause;

/// What became of one specimen.
#[derive(Debug, Clone)]
pub enum SpecimenOutcome {
    /// Its curve and what that comes to.
    Tested {
        curve: Curve,
        /// Values of the curve.
        values: Vec<Value>,
        /// What the user should know.
        warnings: Vec<String>,
    },
    /// A guard has stopped one of its runs.
    Stopped {
        /// Which run, when and why.
        why: String,
        /// Which guard.
        cause: StopCause,
    },
}

/// All specimens, in the order of stresses, then seeds.
#[derive(Debug, Clone)]
pub struct Specimens {
    /// Each with what became of it.
    pub list: Vec<(Loading, SpecimenOutcome)>,
}

impl Specimens {
    /// What stopped the first of those that a guard has stopped.
    pub fn stop(&self) -> Option<StopCause> {
        self.list.iter().find_map(|(_, outcome)| match outcome {
            SpecimenOutcome::Stopped { cause, .. } => Some(*cause),
            SpecimenOutcome::Tested { .. } => None,
        })
    }
}
