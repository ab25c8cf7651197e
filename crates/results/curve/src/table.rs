//! The curve as CSV: a row for each point.

use crate::judge::Judged;
use crate::{Choice, Point};
use measure::statistics::Mean;
use std::fmt::Write;

/// Mean over the seeds of what was measured; of a profile over its places, too.
fn mean(point: &Point) -> (f64, f64) {
    let mut seeds = Vec::new();
    let mut values = Vec::new();
    for sample in point.samples.iter().filter(|s| !s.value.is_empty()) {
        if !seeds.contains(&sample.seed) {
            seeds.push(sample.seed);
            values.push(sample.value.iter().sum::<f64>() / sample.value.len() as f64);
        }
    }
    let of = Mean::of(&values);
    (of.mean, of.interval)
}

/// The table.
pub fn csv(judged: &Judged) -> String {
    let mut out = String::new();
    let keys: Vec<&str> =
        judged.points.first().map_or(&[][..], |p| &p.setting).iter().map(|(k, _)| k.as_str()).collect();
    let unit = &judged.what.1;
    let relative = judged.errors.iter().flatten().next().is_none_or(|e| e.relative);
    let error = if relative { "1" } else { unit };
    // Writing to a string does not fail.
    let _ = writeln!(
        out,
        "{},state,repeats,value [{unit}],value_interval [{unit}],error [{error}],error_interval [{error}],\
         seconds_per_second [s/s],steps_per_second [1/s],work,prepare [s],front,mark,why",
        keys.iter().map(|k| cell(k)).collect::<Vec<_>>().join(",")
    );
    for (k, point) in judged.points.iter().enumerate() {
        let (value, interval) = mean(point);
        let seeds = point.samples.iter().map(|s| s.seed).collect::<std::collections::BTreeSet<u64>>().len();
        let cost = judged.costs[k];
        let (size, chance) = judged.errors[k].map_or((f64::NAN, f64::NAN), |e| (e.size, e.interval));
        let numbers = [value, interval, size, chance, cost.seconds, cost.steps, point.work(), cost.prepared];
        let mut row: Vec<String> = point.setting.iter().map(|(_, v)| cell(v)).collect();
        row.push(if point.failed.is_some() { "failed" } else { "done" }.to_owned());
        row.push(seeds.to_string());
        row.extend(numbers.iter().map(|v| number(*v)));
        row.push(u8::from(judged.front.contains(&k)).to_string());
        row.push(marks(judged, k));
        row.push(cell(point.failed.as_deref().unwrap_or_default()));
        let _ = writeln!(out, "{}", row.join(","));
    }
    out
}

/// `reference`, `in-use`, `recommended`, with a space between them.
fn marks(judged: &Judged, k: usize) -> String {
    let recommended = matches!(judged.choice, Some(Choice::Point(at)) if at == k);
    let all = [
        (judged.marks.0 == Some(k), "reference"),
        (judged.marks.1 == Some(k), "in-use"),
        (recommended, "recommended"),
    ];
    all.iter().filter(|(is, _)| *is).map(|(_, name)| *name).collect::<Vec<_>>().join(" ")
}

/// A number with nine digits; empty for NaN.
fn number(value: f64) -> String {
    let short: f64 = format!("{value:.8e}").parse().unwrap_or(value);
    if short.is_finite() { short.to_string() } else { String::new() }
}

/// A cell with a comma or a quote stands in quotes.
fn cell(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
