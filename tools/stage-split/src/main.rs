//! Cuts a scene at a plane into the stages upstream and downstream of it.

use anyhow::Context;
use clap::{Parser, ValueEnum};
use cli::{Output, Report, Source, usage};
use geom::Plane;
use scene::Scene;
use scene::split::{Cut, Stage, split};
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

/// Cuts a scene at a plane and writes the scene of one stage
#[derive(Parser)]
struct Args {
    /// The scene (TOML), - for stdin
    #[arg(value_name = "SCENE.toml", default_value = "-", hide_default_value = true)]
    scene: Source,
    /// The plane, px,py,pz,nx,ny,nz, its normal in the direction of flow
    #[arg(long, value_name = "PLANE", allow_hyphen_values = true)]
    at: Plane,
    /// The stage that is written
    #[arg(long, value_enum)]
    keep: Keep,
    /// Length of the zone behind the plane [m] (default: 1.2 times the largest diameter)
    #[arg(long, value_name = "M")]
    length: Option<f64>,
    /// Motion in the zone
    #[arg(long, value_enum, default_value = "constant")]
    motion: Motion,
    /// What of a particle passes the plane
    #[arg(long, value_enum, default_value = "centre")]
    test: Test,
    #[command(flatten)]
    output: Output,
}

#[derive(Clone, Copy, ValueEnum)]
enum Keep {
    Upstream,
    Downstream,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Motion {
    Constant,
    Ballistic,
    Recorded,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Test {
    Centre,
    Lowest,
}

fn main() -> ExitCode {
    cli::run("stage-split", stage_split)
}

fn stage_split(args: Args) -> anyhow::Result<Report> {
    if args.motion != Motion::Constant {
        return Err(usage("not available yet: --motion ballistic and recorded; use --motion constant"));
    }
    if args.test != Test::Centre {
        return Err(usage("not available yet: --test lowest; use --test centre"));
    }
    let parent = |path: Option<&Path>| path.and_then(Path::parent).unwrap_or(Path::new("")).to_owned();
    let folder = parent(args.scene.path());
    let scene = Scene::new(&args.scene.to_string(), args.scene.read_text()?, &[], &folder)?;
    let keep = match args.keep {
        Keep::Upstream => Stage::Upstream,
        Keep::Downstream => Stage::Downstream,
    };
    let cut = Cut { plane: args.at, keep, length: args.length, folder: parent(args.output.path()) };
    let (text, gone) = split(&scene, &cut)?;
    let mut out = args.output.open_text()?;
    out.write_all(text.as_bytes()).context("cannot write the scene")?;
    out.commit()?;
    let left_out = if gone.is_empty() { "nothing".to_owned() } else { gone.join(", ") };
    Ok(Report::new(format!("left out: {left_out}")).with("left_out", gone))
}
