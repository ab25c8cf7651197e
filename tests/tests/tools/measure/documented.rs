//! The documents against the list of measures.

use grainpipe_tests::tools::tool;
use measure::definition::Frames;
use measure::registry::ALL;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::tempdir;

/// The page of measures, in whichever folder of the documents it stands.
fn page() -> String {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs")];
    let mut found: Vec<PathBuf> = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.file_name().is_some_and(|name| name == "measure.md") {
                found.push(path);
            }
        }
    }
    assert_eq!(found.len(), 1, "{found:?}");
    fs::read_to_string(&found[0]).unwrap()
}

/// The rows of the table of measures, as cells.
fn rows(page: &str) -> Vec<Vec<&str>> {
    let table = page.lines().skip_while(|line| !line.starts_with("| measure | needs |")).skip(2);
    let rows = table.take_while(|line| line.starts_with('|'));
    rows.map(|line| line.split('|').map(str::trim).filter(|cell| !cell.is_empty()).collect()).collect()
}

/// Each measure has its row with its argument, and what the row says of frames is what the measure does; no row is of something else.
#[test]
fn the_table_of_measures_is_that_of_the_registry() {
    let page = page();
    let rows = rows(&page);
    for entry in ALL {
        let value = entry.argument.value_name().map_or(String::new(), |name| format!(" {name}"));
        let option = format!("`--{}{value}`", entry.name);
        let row = rows.iter().find(|row| row[0] == option).unwrap_or_else(|| panic!("{option} has no row"));
        let frames = *row.last().unwrap();
        let is_last = matches!(entry.frames, Frames::Last | Frames::One);
        assert_eq!(frames.starts_with("last"), is_last, "{option}: {frames}");
    }
    assert_eq!(rows.len(), ALL.len());
}

/// The help of cost-curve names each result that has a name, with what must follow it.
#[test]
fn the_help_of_cost_curve_names_each_result_that_has_a_name() {
    let folder = tempdir().unwrap();
    let help = tool(folder.path(), "cost-curve", &["--help"]);
    let help = String::from_utf8(help.stdout).unwrap().split_whitespace().collect::<Vec<_>>().join(" ");
    for entry in ALL {
        let value = entry.argument.value_name().map_or(String::new(), |name| format!(" {name}"));
        for figure in entry.figures {
            let word = format!(" {}{value},", figure.name);
            assert!(help.contains(&word), "'{word}' is not in the help: {help}");
        }
    }
}
