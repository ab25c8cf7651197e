//! Holes cut out of clouds, and found again: `holes_study CLOUDS` prints a table; CLOUDS is the folder of the scans.
//!
//! Every third set of cuts is kept out of tuning: it is used with `held-out` only.

mod bodies;
mod cuts;

use bodies::{BODIES, Body};
use cuts::{Outcome, Score};
use geom::Vec3;
use std::path::Path;
use std::process::ExitCode;

/// Sizes of holes in local spacings, by column of the table.
const COLUMNS: [f64; 6] = [3.0, 6.0, 8.0, 12.0, 25.0, 61.0];
/// Sets of cuts for each body, and holes of each.
const SETS: (u64, usize) = (3, 14);

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (folder, held_out, only) = match words.as_slice() {
        [folder] => (folder, false, ""),
        [folder, word] if word == "held-out" => (folder, true, ""),
        [folder, word] => (folder, false, word.as_str()),
        _ => {
            eprintln!("holes_study: usage: holes_study CLOUDS [held-out]");
            return ExitCode::from(2);
        }
    };
    match study(Path::new(folder), held_out, only) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("holes_study: {why}");
            ExitCode::FAILURE
        }
    }
}

fn study(folder: &Path, held_out: bool, only: &str) -> Result<(), String> {
    println!(
        "| body | found of 3–6 | 6–8 | 8–12 | 12–25 | 25–60 | ≥ 8 | false per 10⁵ points | own | RMS | s |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    let mut all = Vec::new();
    for (name, body) in BODIES.into_iter().filter(|(name, _)| name.contains(only)) {
        let (outcomes, own) = of(body, folder, held_out)?;
        row(name, &outcomes, own);
        all.extend(outcomes);
    }
    row("all", &all, 0);
    Ok(())
}

fn of(body: Body, folder: &Path, held_out: bool) -> Result<(Vec<Outcome>, usize), String> {
    let mut outcomes = Vec::new();
    let mut own: Vec<(Vec3, f64)> = Vec::new();
    for set in (0..2 * SETS.0).filter(|set| (set % 3 == 2) == held_out) {
        let points = body.points(set + 1, folder)?;
        if matches!(body, Body::Scan(_)) && own.is_empty() {
            own =
                cuts::fill(points.clone())?.report.holes.iter().map(|h| (h.centre.into(), h.width)).collect();
        }
        let (points, cuts) = cuts::cut(&points, SETS.1, set);
        outcomes.push(cuts::outcome(body, points, &cuts, &own)?);
    }
    Ok((outcomes, own.len()))
}

fn row(name: &str, outcomes: &[Outcome], own: usize) {
    let scores = || outcomes.iter().flat_map(|o| &o.scores);
    let share = |of: &dyn Fn(&&Score) -> bool| {
        let of: Vec<&Score> = scores().filter(of).collect();
        format!("{} of {}", of.iter().filter(|s| s.found).count(), of.len())
    };
    let columns: Vec<String> =
        COLUMNS.windows(2).map(|c| share(&|s| s.size >= c[0] && s.size < c[1])).collect();
    let large: Vec<&Score> = scores().filter(|s| s.size >= 8.0).collect();
    let found = large.iter().filter(|s| s.found).count() as f64 / large.len().max(1) as f64;
    let points: usize = outcomes.iter().map(|o| o.points).sum();
    let false_finds: usize = outcomes.iter().map(|o| o.false_finds).sum();
    let (squares, added) =
        scores().filter(|s| s.found).fold((0.0, 0), |a, s| (a.0 + s.squares.0, a.1 + s.squares.1));
    println!(
        "| {name} | {} | {:.1} % | {:.2} | {own} | {:.2} | {:.1} |",
        columns.join(" | "),
        100.0 * found,
        1e5 * false_finds as f64 / points as f64,
        (squares / added.max(1) as f64).sqrt(),
        outcomes.iter().map(|o| o.seconds).sum::<f64>()
    );
}
