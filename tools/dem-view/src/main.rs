//! Shows runs, walls and clouds: one HTML page that plays, or a picture.

mod formats;
mod inputs;
mod moment;
mod page;
mod run;

use anyhow::Context;
use clap::Parser;
use cli::{Output, OutputStream, Report, Source};
use formats::Format;
use moment::Moment;
use std::{io::Write, path::PathBuf, process::ExitCode};
use view::{Camera, Map, PictureOptions, picture};

/// Show runs, walls and clouds together as one HTML page (no network needed) or as a PNG picture
#[derive(Parser)]
struct Args {
    /// Runs and walls (MCAP), meshes (PLY), clouds (PLY, LAS, E57, PCD, XYZ), all shown together; - or none: stdin
    #[arg(value_name = "INPUT")]
    inputs: Vec<Source>,
    /// Write to FILE (.html or .png; appears when whole) instead of HTML to stdout
    #[arg(id = "output", short = 'o', long = "output", value_name = "FILE")]
    file: Option<PathBuf>,
    /// Field to colour by: speed, spin, radius, material, id, x, y, z, rgb, or any column [default: speed, else z]
    #[arg(long, value_name = "FIELD")]
    colour: Option<String>,
    /// Ends of the colour scale in SI units [default: what 98 % of the values lie in]
    #[arg(long, value_name = "LO,HI", value_parser = formats::range, allow_hyphen_values = true)]
    range: Option<[f64; 2]>,
    /// Colour map: viridis or turbo
    #[arg(long, value_name = "NAME", value_parser = formats::map, default_value = "viridis")]
    map: Map,
    /// Time to show [s]; HTML: show it first, paused; PNG: the last frame not after it [default: the last with grains in it]
    #[arg(long, value_name = "S", value_parser = formats::seconds)]
    time: Option<f64>,
    /// iso, top, bottom, front, back, left, right, or the eye's x,y,z and, after it, the point looked at [m]
    #[arg(long, value_name = "VIEW", value_parser = formats::camera, default_value = "iso", allow_hyphen_values = true)]
    camera: Camera,
    /// Size of the picture [pixel]
    #[arg(long, value_name = "WxH", value_parser = formats::size, default_value = "1920x1080")]
    size: [u32; 2],
    /// How much of the grains a wall in front of them hides in the picture, 0 to 1
    #[arg(long, value_name = "SHARE", value_parser = formats::share, default_value_t = 0.2)]
    wall_opacity: f64,
    /// Leave out the nearer half of the walls in the picture
    #[arg(long)]
    cut: bool,
    /// Size of the page [MB]: components of vectors, then frames, evenly, are left out of a larger one; the rest is refused
    #[arg(long, value_name = "MB", value_parser = formats::megabytes, default_value = "60")]
    max_mb: f64,
    /// Keep the components of vectors in a page that is too large, and leave out more frames
    #[arg(long)]
    components: bool,
    /// Title of the page [default: the inputs' names]
    #[arg(long)]
    title: Option<String>,
    /// Page on which regions are drawn over one cloud, as --keep and --remove options for cloud-crop
    #[arg(long)]
    pick: bool,
}

fn main() -> ExitCode {
    cli::run("dem-view", show)
}

fn show(mut args: Args) -> anyhow::Result<Report> {
    if args.inputs.is_empty() {
        args.inputs.push(Source::Stdin);
    }
    let output = Output { file: args.file.clone() };
    Source::one_stdin(&args.inputs)?;
    match Format::of(&output)? {
        Format::Html => page::html(&args, &output),
        Format::Png => png(&args, &output),
    }
}

fn png(args: &Args, output: &Output) -> anyhow::Result<Report> {
    let mut moment = Moment::at(args.time);
    let seen = inputs::read_all(&args.inputs, &mut moment)?;
    moment.settle();
    let [width, height] = args.size;
    let options = PictureOptions {
        width,
        height,
        camera: args.camera,
        colour: args.colour.clone(),
        map: args.map,
        range: args.range,
        time: moment.time(),
        wall_opacity: args.wall_opacity,
        cut: args.cut,
    };
    let image = picture::draw(&moment.parts(), moment.surfaces(), &options)?;
    let mut out: OutputStream = output.open()?;
    out.write_all(&image.png()?).with_context(|| output.name())?;
    out.commit()?;
    let when = options.time.map_or_else(String::new, |t| format!(" at t = {t:.6} s"));
    let summary = format!("{}: {width} x {height} pixels{when}", output.name());
    Ok(Report::new(summary).with("time_s", options.time).with("layers", seen))
}
