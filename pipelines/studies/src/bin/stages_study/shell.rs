//! Runs lines of shell, as a user would type them, and reads what the tools measured.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// Runs a line of bash in a folder; fails when any part of a pipe does, with the last line that it wrote to stderr.
///
/// # Errors
/// What could not be started, or failed.
pub fn line(folder: &Path, line: &str) -> Result<Vec<u8>, String> {
    let mut bash = Command::new("bash");
    bash.current_dir(folder).args(["-c", &format!("set -o pipefail; {line}")]);
    let done = bash.output().map_err(|why| format!("bash: {why}"))?;
    if done.status.success() {
        return Ok(done.stdout);
    }
    let words = String::from_utf8_lossy(&done.stderr);
    Err(words.lines().rfind(|l| !l.trim().is_empty()).unwrap_or("failed without a word").to_owned())
}

/// What a line took.
#[derive(Debug, Clone, Copy, Default)]
pub struct Took {
    /// On the clock [s].
    pub wall: f64,
    /// Of processors, user and system together [s].
    pub processor: f64,
}

/// Runs a line and tells what it took.
///
/// # Errors
/// As [`line`].
pub fn timed(folder: &Path, what: &str) -> Result<Took, String> {
    let told = "{ tail -n 1 words >&2; exit 1; }";
    let out =
        line(folder, &format!("TIMEFORMAT='%R %U %S'; {{ time {{ {what}; }} 2> words; }} 2>&1 || {told}"))?;
    let text = String::from_utf8_lossy(&out);
    let last = text.lines().last().unwrap_or_default();
    let numbers: Vec<f64> = last.split_whitespace().filter_map(|t| t.parse().ok()).collect();
    let [wall, user, system] = numbers[..] else { return Err(format!("time said '{last}'")) };
    Ok(Took { wall, processor: user + system })
}

/// What dem-measure says of a run, as JSON.
///
/// # Errors
/// As [`line`]; output that is no JSON.
pub fn measure(folder: &Path, run: &str, what: &str) -> Result<Value, String> {
    let out = line(folder, &format!("dem-measure {run} {what} --json -q"))?;
    serde_json::from_slice(&out).map_err(|why| format!("dem-measure {what}: {why}"))
}

/// A value of the summary; NaN where it has none.
pub fn summary(found: &Value, name: &str) -> f64 {
    found["summary"][name]["value"].as_f64().unwrap_or(f64::NAN)
}

/// A column of the rows.
pub fn column(found: &Value, name: &str) -> Vec<f64> {
    let at = found["columns"].as_array().and_then(|all| all.iter().position(|c| c["name"] == name));
    let rows = found["rows"].as_array().map_or(&[][..], Vec::as_slice);
    let Some(at) = at else { return Vec::new() };
    rows.iter().map(|row| row[at].as_f64().unwrap_or(f64::NAN)).collect()
}
