//! What became of the specimens of a test.

use crate::recipes::{Loading, Value};
use crate::series::Curve;
use crate::state::{Moment, Moments};
use record::StopCause;
use serde::Serialize;

/// What became of one specimen.
#[derive(Debug, Clone)]
pub enum SpecimenOutcome {
    /// Its curve and what that comes to.
    Tested {
        curve: Curve,
        /// Values of the curve.
        values: Vec<Value>,
        /// Its state at the start, at the peak and at the end.
        moments: Box<Moments>,
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

impl SpecimenOutcome {
    /// Its state at the moments of its test.
    fn moments(&self) -> Option<&Moments> {
        match self {
            SpecimenOutcome::Tested { moments, .. } => Some(moments),
            SpecimenOutcome::Stopped { .. } => None,
        }
    }
}

/// All specimens, in the order of stresses, then seeds.
#[derive(Debug, Clone)]
pub struct Specimens {
    /// Each with what became of it.
    pub list: Vec<(Loading, SpecimenOutcome)>,
}

/// A specimen at the start, the peak and the end of its test.
#[derive(Debug, Clone, Serialize)]
pub struct SpecimenState<'a> {
    /// Stress [Pa].
    pub stress: f64,
    pub seed: u64,
    #[serde(flatten)]
    pub moments: &'a Moments,
}

impl Specimens {
    /// Those that came to their end.
    pub fn states(&self) -> Vec<SpecimenState<'_>> {
        let of = |(stress, seed, moments): (f64, u64, Option<_>)| {
            Some(SpecimenState { stress, seed, moments: moments? })
        };
        self.list.iter().map(|one| (one.0.stress, one.0.seed, one.1.moments())).filter_map(of).collect()
    }

    /// The first that came to its end, when its test starts.
    pub fn first_start(&self) -> Option<&Moment> {
        self.list.iter().find_map(|(_, outcome)| outcome.moments()?.start.as_ref())
    }

    /// What stopped the first of those that a guard has stopped.
    pub fn stop(&self) -> Option<StopCause> {
        self.list.iter().find_map(|(_, outcome)| match outcome {
            SpecimenOutcome::Stopped { cause, .. } => Some(*cause),
            SpecimenOutcome::Tested { .. } => None,
        })
    }
}
