//! Keeps or removes the points of a cloud that lie inside given shapes.

use anyhow::Context;
use clap::Parser;
use cli::Report;
use cloud::crop::Rules;
use cloud::outliers::Outliers;
use geom::Shape;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const SHAPES: &str = "SHAPE: box:x0,y0,z0,x1,y1,z1 | sphere:x,y,z,r | cylinder:x0,y0,z0,x1,y1,z1,r | \
    halfspace:px,py,pz,nx,ny,nz (the side n points to) | prism:FILE.json | mesh:FILE; \
    a ! in front means outside. All in metres.";

/// Keep or remove points of a cloud by shapes, isolation and connectedness
#[derive(Parser)]
#[command(after_help = SHAPES)]
struct Args {
    #[command(flatten)]
    input: cli::Input,
    #[command(flatten)]
    output: cli::CloudOutput,
    /// Keep the points inside SHAPE (repeat: inside any of them)
    #[arg(long, value_name = "SHAPE", value_parser = cloud::shape)]
    keep: Vec<Shape>,
    /// Remove the points inside SHAPE
    #[arg(long, value_name = "SHAPE", value_parser = cloud::shape)]
    remove: Vec<Shape>,
    /// Named regions to keep and to remove
    #[arg(long, value_name = "FILE.toml")]
    regions: Option<PathBuf>,
    /// Remove points whose mean distance to K neighbours is SIGMA deviations above the mean
    #[arg(long, value_name = "K,SIGMA")]
    outliers: Option<Outliers>,
    /// Keep only the largest part connected by steps of at most RADIUS [m]
    #[arg(long, value_name = "RADIUS", value_parser = positive)]
    largest: Option<f64>,
}

fn main() -> ExitCode {
    cli::run("cloud-crop", crop)
}

fn crop(args: Args) -> anyhow::Result<Report> {
    check_ending(&args.output.to)?;
    let mut rules =
        Rules { keep: args.keep, remove: args.remove, outliers: args.outliers, largest: args.largest };
    if let Some(file) = &args.regions {
        let text =
            std::fs::read_to_string(file).with_context(|| format!("{}: cannot read", file.display()))?;
        let folder = file.parent().unwrap_or(Path::new(""));
        cloud::regions::add_regions(&mut rules, &text, folder).with_context(|| file.display().to_string())?;
    }
    let cloud = args.input.read_cloud()?;
    let (kept, counts) = cloud::crop(&cloud, &rules);
    if counts.not_finite > 0 {
        cli::warn(&format!("{} points without finite coordinates were dropped", counts.not_finite));
    }
    if counts.points_out == 0 && counts.points_in > 0 {
        cli::warn("no point is left: check the shapes against the coordinates of the cloud");
    }
    args.output.write_cloud(&kept)?;
    let summary = format!("{} of {} points kept", counts.points_out, counts.points_in);
    Ok(Report::new(summary).with_all(&counts))
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("give a length above 0 in metres".into()),
    }
}

/// Refuses a name that promises another format than PLY.
fn check_ending(output: &cli::Output) -> anyhow::Result<()> {
    let ending = output.path().and_then(std::path::Path::extension);
    if ending.is_none() || output.has_extension("ply") {
        return Ok(());
    }
    Err(cli::usage(format!("-o {}: only PLY is written: use a name in .ply", output.name())))
}
