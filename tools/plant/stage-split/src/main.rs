//! Cuts a scene at a plane into the stages upstream and downstream of it.

mod args;

use anyhow::Context;
use args::Args;
use cli::Report;
use scene::Scene;
use stages::split::split;
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run("stage-split", stage_split)
}

fn stage_split(args: Args) -> anyhow::Result<Report> {
    let folder = args.scene.path().and_then(Path::parent).unwrap_or(Path::new("")).to_owned();
    let scene = Scene::new(&args.scene.to_string(), args.scene.read_text()?, &[], &folder)?;
    cli::also_reads(scene.files())?;
    let (text, gone) = split(&scene, &args.cut())?;
    let unchanged = args.output.holds(text.as_bytes());
    if !unchanged {
        let mut out = args.output.open_text()?;
        out.write_all(text.as_bytes()).context("cannot write the scene")?;
        out.commit()?;
    }
    let left_out = if gone.is_empty() { "nothing".to_owned() } else { gone.join(", ") };
    let kept = if unchanged {
        format!("; {} holds this stage already and was not written again", args.output.name())
    } else {
        String::new()
    };
    let report = Report::new(format!("left out: {left_out}{kept}"));
    Ok(report.with("left_out", gone).with("unchanged", unchanged))
}
