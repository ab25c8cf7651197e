//! A setting, its measurements and its error.

use measure::statistics::median;

/// One run of a setting.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredRun {
    /// What was measured: one number, or one for each place of a profile.
    pub value: Vec<f64>,
    /// What it cost, in the unit of the sweep.
    pub work: f64,
    /// Seed of its random numbers; samples of two settings with the same seed are a pair.
    pub seed: u64,
}

/// How far the mean of a setting is from the truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Error {
    /// Its size, not below zero.
    pub size: f64,
    /// Half width of its 95 % interval (Student's t over the seeds, and the uncertainty of the truth); NaN for one run.
    pub interval: f64,
    /// Whether it is a share of the truth, which then is not zero, or in the unit of the measure.
    pub relative: bool,
}

impl Error {
    /// Upper end of the interval; the error itself where chance is not known.
    pub fn upper(&self) -> f64 {
        self.size + if self.interval.is_nan() { 0.0 } else { self.interval }
    }

    /// Whether chance alone could have made it.
    pub fn within_chance(&self) -> bool {
        self.interval >= self.size && self.size > 0.0
    }
}

/// A setting with all its runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Key and value of what was varied, as written.
    pub setting: Vec<(String, String)>,
    /// Its runs; none when it cannot be run.
    pub samples: Vec<MeasuredRun>,
    /// Why it cannot be run.
    pub failed: Option<String>,
}

impl Point {
    /// Median over its runs of what one costs; NaN for none.
    pub fn work(&self) -> f64 {
        median(&mut self.samples.iter().map(|s| s.work).collect::<Vec<f64>>())
    }

    /// `safety 0.5, precision mixed`
    pub fn name(&self) -> String {
        let parts: Vec<String> = self.setting.iter().map(|(k, v)| format!("{k} {v}")).collect();
        parts.join(", ")
    }
}
