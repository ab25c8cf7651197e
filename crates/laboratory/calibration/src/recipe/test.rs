//! One command whose result is compared with data, and the numbers for all trials.

use super::Pick;
use crate::measured::data::Target;
use crate::measured::target::Units;
use std::collections::BTreeMap;

/// Numbers for all trials.
#[derive(Debug, Clone)]
pub struct CalibrationSettings {
    /// Runs of each trial with different seeds.
    pub seeds: u64,
    /// Seed of the proposals, and the first of the runs.
    pub seed: u64,
    /// Content of the intervals.
    pub interval: f64,
    /// Largest share of failed trials.
    pub failures: f64,
    /// Longest time of a run [s].
    pub timeout: Option<f64>,
    /// A trial is abandoned when its log likelihood is this much below the best.
    pub abandon: f64,
}

/// A command that prints a curve or a number.
#[derive(Debug, Clone)]
pub struct Test {
    pub name: String,
    /// The shell line, with blanks.
    pub command: String,
    /// The file that is read, relative to the folder of the run; absent: stdout.
    pub read: Option<String>,
    /// Column of x; absent: the result is a number.
    pub x: Option<String>,
    /// Column of y.
    pub y: Option<String>,
    /// Only rows with these values.
    pub rows: BTreeMap<String, f64>,
    /// Which row is the number.
    pub pick: Pick,
    /// Data; absent: a test that `--design` may propose.
    pub target: Option<Target>,
    /// Deviation of a measurement that is not there yet, as share or in the unit of y.
    pub deviation: Option<f64>,
    /// Whether [`Test::deviation`] is a share.
    pub share: bool,
    /// Units of x and y.
    pub(crate) units: Units,
}

impl Test {
    /// Unit of y, for messages.
    pub fn unit(&self) -> &str {
        self.units.y.as_deref().unwrap_or_default()
    }

    /// Whether the seed changes it.
    pub fn is_random(&self) -> bool {
        self.command.contains("{seed}")
    }
}

/// Data for a test without, or instead of, those of the recipe: `NAME=FILE`, or `FILE` for the only test or the next one without data.
pub type GivenData = Vec<String>;
