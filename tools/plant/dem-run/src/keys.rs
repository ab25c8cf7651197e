//! The reference of scenes, printed.

use anyhow::Context;
use cli::{Output, Report};
use std::io::Write;

/// Prints the reference of scenes.
pub fn print(output: &Output) -> anyhow::Result<Report> {
    let mut out = output.open_text()?;
    out.write_all(scene::keys::reference().as_bytes()).context("--keys")?;
    out.commit()?;
    Ok(Report::new(format!("{} keys; docs/reference/scene.md explains them", scene::keys::rows().len())))
}
