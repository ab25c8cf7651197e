//! A scene to begin with.

use anyhow::{Context, anyhow};
use cli::Report;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

/// The scene: an example like the others, so that tests run it.
const SCENE: &str = include_str!("../../../../examples/first-plant.toml");

/// Makes a folder with a scene that runs as it is.
pub fn write(folder: &Path) -> anyhow::Result<Report> {
    let name = folder.display();
    fs::create_dir(folder).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => anyhow!("--new {name}: is there already: give the name of a new folder"),
        ErrorKind::NotFound => {
            anyhow!("--new {name}: the folder that it is to be in is not there: make it first")
        }
        _ => anyhow::Error::new(error).context(format!("--new {name}: cannot make the folder")),
    })?;
    let scene = folder.join("scene.toml");
    fs::write(&scene, SCENE).with_context(|| format!("{}: cannot write", scene.display()))?;
    let next = "cd there, and run the commands at its head: dem-run scene.toml -o run.mcap";
    Ok(Report::new(format!("{}: a plant to begin with; {next}", scene.display())))
}
