//! What a test found, asserted and noted: `docs/evidence/stability.md` is made of the notes.
//!
//! With `GRAINPIPE_FINDINGS=FILE` each finding is appended to the file as one line of JSON; without it tests only assert.

use serde_json::{Value, json};
use std::io::Write;

/// One line of the page: a law or a hard case. What it is tried on (a normal law, a precision, a size) is named by each finding;
/// the page shows the worst.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// Part of the page.
    pub part: &'static str,
    /// What holds, in a few words.
    pub holds: &'static str,
}

/// A line of the page.
pub const fn case(part: &'static str, holds: &'static str) -> Case {
    Case { part, holds }
}

impl Case {
    /// |value| ≤ limit.
    ///
    /// # Panics
    /// Where it is not.
    pub fn within(&self, on: &str, value: f64, unit: &str, limit: f64) {
        self.note(json!({ "on": on, "value": value, "unit": unit, "limit": limit }));
        let holds = self.holds;
        assert!(value.abs() <= limit, "{holds}; {on}: {value:e} {unit}, allowed {limit:e} {unit}");
    }

    /// |value/expected − 1| ≤ tolerance.
    ///
    /// # Panics
    /// Where it is not.
    pub fn equals(&self, on: &str, value: f64, unit: &str, expected: f64, tolerance: f64) {
        let off = value / expected - 1.0;
        self.note(json!({ "on": on, "value": off, "unit": "–", "limit": tolerance,
            "found": value, "expected": expected, "of": unit }));
        let holds = self.holds;
        assert!(
            off.abs() <= tolerance,
            "{holds}; {on}: {value:e} {unit} instead of {expected:e} {unit}, off by {off:.2e}, allowed {tolerance:.0e}"
        );
    }

    /// Refused or stopped, with all these words in the message.
    ///
    /// # Panics
    /// Where one is missing.
    pub fn refused(&self, on: &str, message: &str, words: &[&str]) {
        self.note(json!({ "on": on, "message": message.trim() }));
        let holds = self.holds;
        for word in words {
            assert!(message.contains(word), "{holds}; {on}: '{word}' is not in: {message}");
        }
    }

    /// Errors [–] at steps [s] (or any other measure of size) fall with the order that is expected: the slope of the least-squares
    /// line through log error over log step. Drawn as a curve.
    ///
    /// # Panics
    /// Where the slope is more than `tolerance` below the order.
    pub fn order(&self, on: &str, points: &[(f64, f64)], expected: f64, tolerance: f64) {
        let n = points.len() as f64;
        let logs: Vec<(f64, f64)> = points.iter().map(|&(x, y)| (x.ln(), y.abs().ln())).collect();
        let (mx, my) = (logs.iter().map(|p| p.0).sum::<f64>() / n, logs.iter().map(|p| p.1).sum::<f64>() / n);
        let cross: f64 = logs.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
        let slope = cross / logs.iter().map(|p| (p.0 - mx).powi(2)).sum::<f64>();
        self.note(json!({ "on": on, "order": slope, "expected": expected, "points": points }));
        let holds = self.holds;
        assert!(
            slope >= expected - tolerance,
            "{holds}; {on}: order {slope:.2} instead of {expected}: {points:?}"
        );
    }

    /// A curve for the page; nothing is asserted.
    ///
    /// # Panics
    /// When it cannot be noted.
    pub fn curve(&self, on: &str, x: &str, y: &str, points: &[(f64, f64)]) {
        self.note(json!({ "on": on, "x": x, "y": y, "points": points }));
    }

    fn note(&self, mut finding: Value) {
        let Some(file) = std::env::var_os("GRAINPIPE_FINDINGS") else { return };
        (finding["part"], finding["holds"]) = (self.part.into(), self.holds.into());
        // One write: tests of several threads and processes append to the same file.
        let line = format!("{finding}\n");
        let opened = std::fs::OpenOptions::new().append(true).create(true).open(file);
        opened.and_then(|mut f| f.write_all(line.as_bytes())).expect("findings can be noted");
    }
}
