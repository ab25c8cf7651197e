//! Ten scenes on `dem-run` and on `dem-lammps`: a table for docs/how-to/lammps.md.
//!
//! usage: lammps_study FOLDER PAGE.md [SEEDS]   (the tools beside it; LAMMPS on the path)

mod chaotic;
mod impacts;

use std::path::Path;
use std::{env, fs, process::ExitCode};

/// Where the tables stand in the page.
const MARKS: [&str; 2] = ["<!-- printed by make agree -->", "<!-- until here -->"];

fn main() -> ExitCode {
    let words: Vec<String> = env::args().skip(1).collect();
    let [out, page, rest @ ..] = &words[..] else {
        eprintln!("usage: lammps_study FOLDER PAGE.md [SEEDS]");
        return ExitCode::from(2);
    };
    let seeds = rest.first().and_then(|word| word.parse().ok()).unwrap_or(4);
    let (impacts, impacts_agree) = impacts::table();
    let (chaotic, chaotic_agree) = chaotic::table(Path::new(out), seeds);
    let tables = format!("{impacts}\n{chaotic}");
    println!("{tables}");
    if let Err(error) = put(Path::new(page), &tables) {
        eprintln!("{page}: {error}");
        return ExitCode::FAILURE;
    }
    if impacts_agree && chaotic_agree { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Puts the tables between the marks of a page.
fn put(page: &Path, tables: &str) -> Result<(), String> {
    let text = fs::read_to_string(page).map_err(|e| e.to_string())?;
    let (before, rest) = text.split_once(MARKS[0]).ok_or("the mark of the tables is missing")?;
    let (_, after) = rest.split_once(MARKS[1]).ok_or("the end mark of the tables is missing")?;
    let new = format!("{before}{}\n{tables}{}{after}", MARKS[0], MARKS[1]);
    fs::write(page, new).map_err(|e| e.to_string())
}
