//! What a study asks for: a scene, what is varied, what is measured, how it is judged.

use crate::Norm;
use std::path::PathBuf;
use thiserror::Error;

/// Phases of the step at which a scene without random numbers runs.
pub const PHASES: u64 = 8;

#[derive(Debug, Clone)]
pub struct Study {
    /// The scene's file; may have blanks `{KEY}`.
    pub scene: String,
    /// Walls and inlets of every point; may have blanks.
    pub inputs: Vec<String>,
    /// `KEY=A,B,C`: what is varied.
    pub vary: Vec<String>,
    /// `KEY=VALUE`: changes of the scene in every point.
    pub set: Vec<String>,
    /// The shell line that makes one more input of each point.
    pub each: Option<String>,
    /// `KEY=V`: the setting that errors are measured from.
    pub reference: Vec<String>,
    /// `KEY=V`: the setting in use, of keys that the scene does not have.
    pub in_use: Vec<String>,
    /// The truth, when it is known.
    pub truth: Option<TrueValue>,
    /// The error that is good enough, when it was asked for.
    pub wanted: Option<Wanted>,
    /// How a profile becomes one number.
    pub norm: Norm,
    /// Seeds of each point.
    pub repeat: u64,
    /// Phases of the step at which each point runs; absent: [`PHASES`] where nothing depends on a seed, else one.
    pub phases: Option<u64>,
    /// How often everything is run.
    pub rounds: u64,
    /// What a run costs.
    pub work: Work,
    /// Folder of the points.
    pub folder: PathBuf,
    /// Threads of each run, unless they are varied.
    pub threads: usize,
}

/// A known value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrueValue {
    /// In the unit of the measure.
    pub value: f64,
    /// Half width of its 95 % interval; 0 of an exact answer.
    pub half_width: f64,
}

/// What a run costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Work {
    /// Wall time for each simulated second.
    Seconds,
    /// Processor time for each simulated second.
    Cpu,
    /// Steps for each simulated second.
    Steps,
    /// Instructions of the program for each simulated second.
    Instructions,
}

impl Work {
    /// Its name in sentences.
    pub fn name(self) -> &'static str {
        match self {
            Work::Seconds => "time",
            Work::Cpu => "processor time",
            Work::Steps => "steps",
            Work::Instructions => "instructions",
        }
    }
}

/// An error that is good enough.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wanted {
    /// A share of the truth [–].
    Share(f64),
    /// In the unit of the measure.
    Absolute(f64),
}

/// Why a study failed.
#[derive(Debug, Error)]
pub enum CurveError {
    /// The study asks for something that cannot be.
    #[error("{0}")]
    Usage(String),
    #[error("{0}")]
    Failed(String),
    /// A signal has asked to stop; what is finished stays.
    #[error("{0}")]
    Signal(String),
    #[error("{what}")]
    Io { what: String, source: std::io::Error },
    #[error(transparent)]
    Scene(#[from] scene::SceneError),
    #[error("{what}")]
    At { what: String, source: Box<CurveError> },
}

impl CurveError {
    pub(crate) fn io(what: impl Into<String>) -> impl FnOnce(std::io::Error) -> CurveError {
        let what = what.into();
        move |source| CurveError::Io { what, source }
    }

    pub(crate) fn at(self, what: impl Into<String>) -> CurveError {
        CurveError::At { what: what.into(), source: Box::new(self) }
    }
}
