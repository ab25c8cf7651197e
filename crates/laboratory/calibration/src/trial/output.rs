//! What a run printed, as a curve on the points of the data, or as a number.

use super::TrialRun;
use super::run::{self, STOPPED};
use crate::error::{CalibrateError, Result};
use crate::measured::data::{at, growing};
use crate::measured::sheet::{Sheet, of_report};
use crate::recipe::{Pick, Test, shown};
use std::fs;

/// What came out of a run.
#[derive(Debug, Clone, PartialEq)]
pub enum TrialOutput {
    /// A curve (x, y), or one point.
    Done(Vec<(f64, f64)>),
    /// A guard stopped it: the parameters cannot be simulated so.
    Stopped(String),
    /// It failed, or printed something else.
    Failed(String),
    /// It has not ended, or what it has read is something else now.
    Missing,
}

/// The outcome of a run that has ended.
pub fn outcome(run: &TrialRun, test: &Test) -> TrialOutput {
    let Some(ended) = run::ended(&run.file, &run.job) else {
        return TrialOutput::Missing;
    };
    let reason = || {
        let words = fs::read_to_string(run::folder(&run.file).join("stderr")).unwrap_or_default();
        let line = words.lines().rev().find(|l| !l.trim().is_empty()).unwrap_or("it gave no reason");
        line.chars().take(300).collect::<String>()
    };
    match ended.exit {
        _ if ended.timed_out => {
            TrialOutput::Failed(format!("took longer than {} s", run.job.timeout.unwrap_or(0.0)))
        }
        _ if ended.signal().is_some() => {
            TrialOutput::Failed(ended.signal().map_or(String::new(), |stop| stop.stopped.clone()))
        }
        0 => match curve(run, test) {
            Ok(curve) => TrialOutput::Done(curve),
            Err(e) => TrialOutput::Failed(e.to_string()),
        },
        STOPPED => TrialOutput::Stopped(reason()),
        code @ 128.. => TrialOutput::Failed(format!("ended by signal {}: {}", code - 128, reason())),
        code => TrialOutput::Failed(format!("exit code {code}: {}", reason())),
    }
}

/// The curve that a run printed.
fn curve(run: &TrialRun, test: &Test) -> Result<Vec<(f64, f64)>> {
    let path = run::folder(&run.file).join(test.read.as_deref().unwrap_or("stdout"));
    let name = path.display().to_string();
    let fail = |message: String| CalibrateError::Test { test: test.name.clone(), message };
    let text = fs::read_to_string(&path)
        .map_err(|e| fail(format!("cannot read what the command wrote: {name}: {e}")))?;
    let Some(y) = &test.y else {
        let last = text.split_whitespace().last().unwrap_or_default();
        let number = last.parse::<f64>().ok().filter(|v| v.is_finite());
        return number
            .map(|v| vec![(0.0, v)])
            .ok_or_else(|| fail(format!("the last word of its output is not a number: '{last:.40}'")));
    };
    if text.trim_start().starts_with('{') && test.x.is_none() {
        return Ok(vec![(0.0, of_report(&name, &text, y)?)]);
    }
    let sheet = Sheet::parse(&name, &text)?;
    let named = test.x.iter().map(|x| (x, &test.units.x)).chain([(y, &test.units.y)]);
    let asked: Vec<(usize, f64)> =
        named.map(|(name, unit)| sheet.in_unit(name, unit.as_deref())).collect::<Result<_>>()?;
    let columns: Vec<usize> = asked.iter().map(|column| column.0).collect();
    let mut rows = sheet.numbers(&columns, &test.rows)?;
    for (_, row) in &mut rows {
        row.iter_mut().zip(&asked).for_each(|(value, (_, factor))| *value *= factor);
    }
    if test.x.is_some() {
        let curve = growing(rows.iter().map(|(_, row)| (row[0], row[1])));
        return if curve.len() >= 2 {
            Ok(curve)
        } else {
            Err(fail("its curve has fewer than two points".to_owned()))
        };
    }
    let values: Vec<f64> = rows.iter().map(|(_, row)| row[0]).collect();
    Ok(vec![(0.0, picked(test.pick, &values))])
}

fn picked(pick: Pick, values: &[f64]) -> f64 {
    match pick {
        Pick::First => values.first().copied().unwrap_or(f64::NAN),
        Pick::Last => values.last().copied().unwrap_or(f64::NAN),
        Pick::Max => values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        Pick::Min => values.iter().copied().fold(f64::INFINITY, f64::min),
        Pick::Mean => values.iter().sum::<f64>() / values.len() as f64,
    }
}

/// The values of a curve on a grid: at each point the mean over its places.
///
/// # Errors
/// A curve that ends before the grid does.
pub fn on_grid(curve: &[(f64, f64)], grid: &[Vec<f64>], is_number: bool) -> Result<Vec<f64>, String> {
    if is_number {
        return Ok(curve.iter().map(|p| p.1).take(1).collect());
    }
    let value = |x: &f64| {
        at(curve, *x).ok_or_else(|| {
            let ends = [curve.first(), curve.last()].map(|p| shown(p.map_or(0.0, |p| p.0)));
            format!(
                "its curve reaches from x = {} to {}, the data have x = {}: simulate farther, set from and until, or check the units",
                ends[0],
                ends[1],
                shown(*x)
            )
        })
    };
    let mean = |places: &Vec<f64>| {
        let sum = places.iter().map(value).sum::<Result<f64, String>>()?;
        Ok(sum / places.len() as f64)
    };
    grid.iter().map(mean).collect()
}
