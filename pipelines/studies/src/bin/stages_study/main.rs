//! Stages, studied: `stages_study FOLDER PAGE.md` runs a small plant undivided and cut, in FOLDER, and writes what it found into the page, between
//! the marks of its parts, and the plots beside it. The tools must be on the path; SEEDS=… gives the number of runs of each setting, QUICK=1 leaves out
//! all but each cut and motion once, and a third word chooses one part.
//! What was measured of a run is kept in FOLDER, so that a study that was stopped goes on.
//!
//! Fidelity: every quantity of a cut run is compared with the undivided run of the same seed; the mean difference has Student's 95 % interval,
//! and stands beside the deviation of the undivided runs between seeds. Cost: processor times.

mod cost;
mod fidelity;
mod kept;
mod mouths;
mod page;
#[path = "../walls_study/picture.rs"]
mod picture;
mod plant;
mod shell;

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (folder, file, part) = match words.as_slice() {
        [folder, file] => (folder, file, None),
        [folder, file, part] if ["fidelity", "mouths", "cost"].contains(&part.as_str()) => {
            (folder, file, Some(part.as_str()))
        }
        _ => {
            eprintln!("stages_study: usage: stages_study FOLDER PAGE.md [fidelity|mouths|cost]");
            return ExitCode::from(2);
        }
    };
    match study(Path::new(folder), Path::new(file), part) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("stages_study: {why}");
            ExitCode::FAILURE
        }
    }
}

fn study(folder: &Path, file: &Path, part: Option<&str>) -> Result<(), String> {
    // Commands run in the folder and name its files.
    let folder = &std::path::absolute(folder).map_err(|why| format!("{}: {why}", folder.display()))?;
    std::fs::create_dir_all(folder).map_err(|why| format!("{}: {why}", folder.display()))?;
    let lock =
        std::fs::File::create(folder.join("lock")).map_err(|why| format!("{}: {why}", folder.display()))?;
    if lock.try_lock().is_err() {
        return Err(format!(
            "{}: another process works there: wait for its end, or give another folder",
            folder.display()
        ));
    }
    let seeds = std::env::var("SEEDS").ok().and_then(|s| s.parse().ok()).filter(|n| *n >= 2).unwrap_or(5);
    if part.is_none_or(|p| p == "fidelity") {
        eprintln!("stages_study: fidelity, {seeds} seeds");
        fidelity::study(folder, file, seeds)?;
    }
    if part.is_none_or(|p| p == "mouths") {
        eprintln!("stages_study: mouths, {seeds} seeds");
        mouths::study(folder, file, seeds)?;
    }
    if part.is_none_or(|p| p == "cost") {
        eprintln!("stages_study: cost");
        cost::study(folder, file)?;
    }
    Ok(())
}
