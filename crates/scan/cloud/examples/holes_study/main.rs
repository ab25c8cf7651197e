//! Holes cut out of clouds, and found again: `holes_study CLOUDS PAGE.md` writes its table into the page and a picture beside it.
//!
//! CLOUDS is the folder of the scans; they are left out where it is not there. Every third set of cuts is kept out of tuning: the table shows
//! these, and the sum of the others. `holes_study CLOUDS` prints the others, body by body; with `--seen` or `--peers` behind it, the other tables.

mod bodies;
mod cuts;
mod looks;
mod page;
mod peers;
#[path = "../../tests/random/mod.rs"]
mod random;
#[path = "../../tests/scanner/mod.rs"]
mod scanner;

use bodies::{BODIES, Body};
use geom::Vec3;
use page::Row;
use std::path::Path;
use std::process::ExitCode;

/// Sets of cuts of each body, of which a third is kept out of tuning, and holes of each.
const SETS: (u64, usize) = (9, 14);

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let outcome = match words.as_slice() {
        [folder] => rows(Path::new(folder), false).map(|rows| print!("{}", page::table(&rows))),
        [_, part] if part == "--seen" => looks::table().map(|table| print!("{table}")),
        [folder, part] if part == "--peers" => {
            peers(Path::new(folder)).map(|table| print!("{}", table.unwrap_or_default()))
        }
        [folder, file] => study(Path::new(folder), Path::new(file)),
        _ => {
            eprintln!("holes_study: usage: holes_study CLOUDS [PAGE.md]");
            return ExitCode::from(2);
        }
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("holes_study: {why}");
            ExitCode::FAILURE
        }
    }
}

fn study(folder: &Path, file: &Path) -> Result<(), String> {
    let held_out = rows(folder, true)?;
    let tuning = rows(folder, false)?;
    let sums = [page::sum("all of these", &held_out), page::sum("the cuts of tuning", &tuning)];
    page::write(file, &held_out, &sums)?;
    page::replace(file, "holes-seen", &looks::table()?)?;
    peers(folder)?.map_or(Ok(()), |table| page::replace(file, "holes-peers", &table))
}

fn peers(folder: &Path) -> Result<Option<String>, String> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../pipelines/peers/cloud-fill-peers.py");
    peers::table(folder, &script, SETS.1)
}

fn rows(folder: &Path, held_out: bool) -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    for (name, body) in BODIES {
        if matches!(body, Body::Scan(_)) && !folder.is_dir() {
            eprintln!("holes_study: {name}: left out, {} is not there", folder.display());
            continue;
        }
        rows.push(row(name, body, folder, held_out)?);
    }
    Ok(rows)
}

fn row(name: &str, body: Body, folder: &Path, held_out: bool) -> Result<Row, String> {
    let mut outcomes = Vec::new();
    let mut own: Vec<(Vec3, f64)> = Vec::new();
    for set in (0..SETS.0).filter(|set| (set % 3 == 2) == held_out) {
        let points = body.points(set + 1, folder)?;
        if matches!(body, Body::Scan(_)) && own.is_empty() {
            let holes = cuts::fill(points.clone())?.report.holes;
            own = holes.iter().map(|h| (h.centre.into(), h.width)).collect();
        }
        let (points, cuts) = cuts::cut(&points, SETS.1, set);
        outcomes.push(cuts::outcome(body, points, &cuts, &own)?);
    }
    Ok(Row { name: name.to_owned(), body: Some(body), outcomes, own: own.len() })
}
