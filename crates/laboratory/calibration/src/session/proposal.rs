//! Proposals of trials, kept in files.

use super::Tried;
use crate::error::{CalibrateError, Result};
use crate::fit::StepStart;
use crate::recipe::Recipe;
use crate::trial::replace;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Points that are to be tried.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Proposal {
    /// Coordinates of the fitted parameters.
    pub points: Vec<Vec<f64>>,
    /// Whether the emulator is certain already.
    pub certain: bool,
}

#[derive(Serialize, Deserialize)]
struct Kept {
    stamp: String,
    certain: bool,
    points: Vec<Vec<f64>>,
}

/// The file of a batch of a step, both from 0.
pub(super) fn name(step: usize, batch: usize) -> String {
    format!("step-{}-batch-{batch:03}.json", step + 1)
}

/// A coordinate with the digits that a file keeps: 1e-9.
pub(super) fn digits(z: f64) -> f64 {
    (z * 1e9).round() / 1e9
}

impl Proposal {
    /// The proposal in the folder, or a new one, which is kept. The one in the folder counts if it follows from the same recipe and results.
    pub fn kept(
        (dir, recipe): (&Path, &Recipe),
        of: (usize, usize),
        tried: &[Tried],
        place: &StepStart,
        make: impl FnOnce() -> Proposal,
    ) -> Result<Proposal> {
        let path = dir.join("batches").join(name(of.0, of.1));
        let stamp = stamp(recipe, of, tried, place);
        let read = || {
            let text = std::fs::read_to_string(&path).ok()?;
            serde_json::from_str::<Kept>(&text).ok().filter(|k| k.stamp == stamp)
        };
        if let Some(kept) = read() {
            return Ok(Proposal { points: kept.points, certain: kept.certain });
        }
        let mut new = make();
        new.points.iter_mut().flatten().for_each(|z| *z = digits(*z));
        let kept = Kept { stamp, certain: new.certain, points: new.points.clone() };
        let text = serde_json::to_string(&kept).map_err(|e| CalibrateError::Failed(e.to_string()))?;
        replace(&path, (text + "\n").as_bytes())?;
        Ok(new)
    }
}

/// What a proposal follows from.
fn stamp(recipe: &Recipe, of: (usize, usize), tried: &[Tried], place: &StepStart) -> String {
    let step = &recipe.steps[of.0];
    let mut text = format!(
        "{} {of:?} {:?} {:?} {}\n",
        env!("CARGO_PKG_VERSION"),
        step.fit,
        step.to,
        recipe.settings.seed
    );
    text +=
        &format!("{:?} {} {} {}\n", recipe.settings.abandon, step.first, step.batch, recipe.settings.seeds);
    if of.1 > 0 {
        // The first batch depends on nothing else, so that new data use its trials.
        for test in &recipe.tests {
            text +=
                &format!("{:?}\n", test.target.as_ref().map(|t| (&t.points, t.correlation, t.discrepancy)));
        }
        for t in tried {
            text += &format!("{:?} {:?} {:?}\n", t.trial.z, t.outputs, t.status);
        }
    }
    for p in &recipe.parameters {
        text += &format!("{} {} {} {} {:?}\n", p.name, p.low, p.high, p.log, p.prior);
    }
    stream::sha256(format!("{text}{:?}{:?}{:?}", place.held, place.region, step.with).as_bytes())
}
