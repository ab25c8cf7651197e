//! Trials: a point of the parameters, its runs, and what came out.
//!
//! ```text
//! DIR/trials/0007/trial.json            the parameters
//! DIR/trials/0007/shear-14.job          the command of a run: test "shear", seed 14
//! DIR/trials/0007/shear-14/             its folder: command.sh, stdout, stderr, result.json, and what the command writes
//! DIR/trials/0007/shear-14.lock         the process that runs it now
//! DIR/best/1/                           the best point of step 1, likewise
//! ```
//!
//! A run works in a folder `shear-14.part-HOST-PID`, which is renamed when the run has ended: what is there is whole.

pub mod lock;
pub mod output;
pub mod pool;
pub mod run;

use crate::error::{CalibrateError, Result, file};
use crate::recipe::{Recipe, filled, shown};
use run::TrialJob;
use std::path::{Path, PathBuf};

/// What a trial is made for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrialOf {
    /// To learn from.
    Search,
    /// To see whether the best point of its step is what the emulator says.
    Best,
}

/// A point of the parameters that is tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// Number, from 1.
    pub number: usize,
    /// Index of the step that asked for it.
    pub step: usize,
    /// Batch of the step, from 0.
    pub batch: usize,
    /// Coordinates of all parameters.
    pub z: Vec<f64>,
    pub of: TrialOf,
}

impl Trial {
    /// Its folder.
    pub fn folder(&self, dir: &Path) -> PathBuf {
        match self.of {
            TrialOf::Search => folder(dir, self.number),
            TrialOf::Best => dir.join("best").join((self.step + 1).to_string()),
        }
    }
}

/// A run and where it lies.
#[derive(Debug, Clone)]
pub struct TrialRun {
    /// Index of the test.
    pub test: usize,
    /// The file of its job.
    pub file: PathBuf,
    pub job: TrialJob,
}

/// The folder of a trial.
pub fn folder(dir: &Path, number: usize) -> PathBuf {
    dir.join("trials").join(format!("{number:04}"))
}

/// The runs of a trial for one test: one a seed. Tests with the same command share them.
pub fn runs(recipe: &Recipe, dir: &Path, trial: &Trial, test: usize) -> Vec<TrialRun> {
    let (of, seeds) = (&recipe.tests[recipe.first_with_command_of(test)], recipe.settings.seeds);
    let count = if of.is_random() { seeds } else { 1 };
    let values: Vec<String> =
        recipe.parameters.iter().zip(&trial.z).map(|(p, z)| shown(p.value(*z))).collect();
    let make = |k: u64| {
        // Seeds of trials are different: equal ones would fit the parameters to one packing.
        let seed = recipe.settings.seed + (trial.number as u64 - 1) * seeds + k;
        let mut blanks: Vec<(&str, String)> =
            recipe.parameters.iter().map(|p| p.name.as_str()).zip(values.iter().cloned()).collect();
        blanks.push(("seed", seed.to_string()));
        blanks
            .extend(recipe.steps[trial.step].with.iter().map(|(name, value)| (name.as_str(), value.clone())));
        let movable = filled(&of.command, &blanks);
        let command = filled(&movable, &[("here", stream::quoted(&recipe.here.display().to_string()))]);
        let name = if of.is_random() { format!("{}-{seed}", slug(&of.name)) } else { slug(&of.name) };
        let stamp = run::stamp(&movable, &command);
        let (timeout, here) = (recipe.settings.timeout, recipe.here.clone());
        let job = TrialJob { test: of.name.clone(), command, stamp, timeout, here };
        TrialRun { test, file: trial.folder(dir).join(format!("{name}.job")), job }
    };
    (0..count).map(make).collect()
}

/// A name as part of a file name; different names stay different.
fn slug(name: &str) -> String {
    let safe = |c: char| if c.is_ascii_alphanumeric() || "=.,+-_".contains(c) { c } else { '_' };
    let plain: String = name.chars().map(safe).collect();
    if plain == name { plain } else { format!("{plain}-{:.6}", stream::sha256(name.as_bytes())) }
}

/// Writes the parameters of a trial and the jobs of its runs.
///
/// # Errors
/// A folder that cannot be written to.
pub fn write(recipe: &Recipe, dir: &Path, trial: &Trial, runs: &[TrialRun]) -> Result<()> {
    let folder = trial.folder(dir);
    std::fs::create_dir_all(&folder).map_err(file(&folder, "cannot create the folder"))?;
    jobs::clear_parts(&folder);
    let values: serde_json::Map<String, serde_json::Value> =
        recipe.parameters.iter().zip(&trial.z).map(|(p, z)| (p.name.clone(), p.value(*z).into())).collect();
    let about = serde_json::json!({ "trial": trial.number, "step": recipe.steps[trial.step].name, "batch": trial.batch, "parameters": values, "with": recipe.steps[trial.step].with });
    replace(&folder.join("trial.json"), pretty(&about).as_bytes())?;
    for run in runs {
        let job = serde_json::to_value(&run.job).map_err(|e| CalibrateError::Failed(e.to_string()))?;
        replace(&run.file, pretty(&job).as_bytes())?;
    }
    Ok(())
}

fn pretty(value: &serde_json::Value) -> String {
    format!("{value:#}\n")
}

/// Writes a file that appears when it is whole.
///
/// # Errors
/// A full disk, a folder that cannot be written to.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> Result<()> {
    jobs::replace(path, bytes).map_err(file(path, "cannot write (is the disk full?)"))
}
