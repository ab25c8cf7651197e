//! Walls of spheres, studied: `walls_study FOLDER PAGE.md` writes the tables as CSV into the folder, the page, and its plots beside it.
//!
//! Every number of the page comes from here. The short forms of these studies are the tests `sphere_walls`.

mod fall;
mod flow;
mod graze;
mod hold;
mod mend;
mod page;
mod picture;
mod rebound;

use page::Page;
use std::path::Path;
use std::process::ExitCode;

/// Diameter of the smallest grain here [m]; everything is reported as a share of it.
const GRAIN: f64 = 0.012;

/// Adds a part to the page.
type Study = fn(&mut Page) -> Result<(), String>;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [folder, file] = words.as_slice() else {
        eprintln!("walls_study: usage: walls_study FOLDER PAGE.md");
        return ExitCode::from(2);
    };
    match study(Path::new(folder), Path::new(file)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("walls_study: {why}");
            ExitCode::FAILURE
        }
    }
}

fn study(folder: &Path, file: &Path) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|why| format!("{}: {why}", folder.display()))?;
    let mut page = Page::new(folder, file);
    let parts: [(&str, Study); 6] = [
        ("rebound", rebound::study),
        ("grazing", graze::study),
        ("leaks", fall::study),
        ("flow", flow::study),
        ("fill", mend::study),
        ("hold", hold::study),
    ];
    for (name, part) in parts {
        eprintln!("walls_study: {name}");
        part(&mut page)?;
        page.write()?;
    }
    Ok(())
}
