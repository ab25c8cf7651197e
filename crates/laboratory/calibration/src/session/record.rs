//! What became of trials, and their log.

use crate::recipe::{Recipe, shown};
use crate::trial::Trial;
use std::fmt::Write as _;

/// How a trial ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// All of its tests have a result.
    Done,
    /// A guard stopped it: it cannot be simulated so.
    Stopped,
    /// A command failed, or printed something else.
    Failed,
    /// Hopeless after its first tests: the others were not run.
    Abandoned,
}

impl Status {
    /// Its word in the log.
    pub fn word(self) -> &'static str {
        match self {
            Status::Done => "done",
            Status::Stopped => "stopped",
            Status::Failed => "failed",
            Status::Abandoned => "abandoned",
        }
    }
}

/// A trial that was made.
#[derive(Debug, Clone)]
pub struct Tried {
    pub trial: Trial,
    /// For each test the mean over the seeds, on the points of its data.
    pub outputs: Vec<Option<Vec<f64>>>,
    /// For each test the whole curves of its seeds, for plots and for tests without data.
    pub curves: Vec<Vec<Vec<(f64, f64)>>>,
    /// How it ended.
    pub status: Status,
    /// Why it did not end well.
    pub why: Option<String>,
    /// What stopped a run whose output is used all the same: its command does not end with the exit code of the run.
    pub cut: Option<String>,
    /// Time of all runs [s].
    pub seconds: f64,
    /// Square of the misfit, of the tests of its step.
    pub misfit: Option<f64>,
}

/// Where the best point of a step comes from, and what a run of it showed.
pub(crate) struct Best {
    /// Coordinates of the fitted parameters where the emulator expects the least misfit.
    pub predicted: Vec<f64>,
    /// The run there; `None`: it was left out.
    pub run: Option<Tried>,
    /// A trial that is nearer to the data than the run, which is not what was predicted.
    pub nearer: Option<Tried>,
}

impl Best {
    /// A point that no run has verified.
    pub fn unverified(predicted: Vec<f64>) -> Best {
        Best { predicted, run: None, nearer: None }
    }

    /// The run that shows how the best point fits.
    pub fn shown(&self) -> Option<&Tried> {
        self.nearer.as_ref().or(self.run.as_ref())
    }
}

/// The log of all trials: CSV.
pub fn table(recipe: &Recipe, tried: &[Tried]) -> String {
    let mut text = "trial,step,batch,status,misfit,seconds".to_owned();
    for p in &recipe.parameters {
        let unit = if p.unit.is_empty() { String::new() } else { format!(" [{}]", p.unit) };
        let _ = write!(text, ",{}{unit}", p.name);
    }
    text += ",why\n";
    for t in tried {
        let misfit = t.misfit.map_or(String::new(), |m| geom::Shown(m).to_string());
        let step = &recipe.steps[t.trial.step].name;
        let _ = write!(
            text,
            "{},{},{},{},{misfit},{:.3}",
            t.trial.number,
            cell(step),
            t.trial.batch,
            t.status.word(),
            t.seconds
        );
        for (p, z) in recipe.parameters.iter().zip(&t.trial.z) {
            let _ = write!(text, ",{}", shown(p.value(*z)));
        }
        let _ = writeln!(text, ",{}", cell(t.why.as_deref().or(t.cut.as_deref()).unwrap_or("")));
    }
    text
}

/// A text as a cell of CSV.
pub(crate) fn cell(text: &str) -> String {
    let text = text.replace(['\n', '\r'], " ");
    if text.contains([',', '"']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text }
}
