//! Shows runs, walls and clouds: one HTML page that plays, a picture, a film, or files for ParaView.

mod film;
mod formats;
mod inputs;
mod moment;
mod mp4;
mod page;
mod paraview;
mod run;
mod series;

use anyhow::Context;
use clap::Parser;
use cli::{Output, OutputStream, Report, Source};
use formats::Format;
use moment::Moment;
use series::Span;
use std::{io::Write, path::PathBuf, process::ExitCode};
use view::{Camera, Map, PictureOptions, picture};

/// Show runs, walls and clouds together: an HTML page (no network needed), a picture, a film, files for ParaView
#[derive(Parser)]
struct Args {
    /// Runs and walls (MCAP), clouds (PLY, LAS, E57, PCD, XYZ), meshes (PLY), shown together; - or none: stdin
    #[arg(value_name = "INPUT")]
    inputs: Vec<Source>,
    /// Write to FILE (appears when whole) instead of HTML to stdout: .html, .png, .gif, .mp4 (needs ffmpeg), .vtp
    /// (ParaView, one moment), .pvd (ParaView, a series: NAME.pvd and a folder NAME)
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
    /// Time to show [s]; HTML: show it first, paused; PNG, VTP: the frame nearest to it [default: the last with grains in it]
    #[arg(long, value_name = "S", value_parser = formats::seconds)]
    time: Option<f64>,
    /// Where the eye is: iso, top, bottom, front, back, left, right; a side: x, -x, y, -y, z, -z; azimuth/elevation in
    /// degrees, from x towards y and up: 35/20; or its x,y,z and, after it, the point looked at [m]
    #[arg(long, value_name = "VIEW", value_parser = formats::camera, default_value = "iso", allow_hyphen_values = true)]
    camera: Camera,
    /// First time of a film or series [s]
    #[arg(long, value_name = "S", value_parser = formats::seconds, allow_hyphen_values = true)]
    from: Option<f64>,
    /// Last time of a film or series [s]
    #[arg(long, value_name = "S", value_parser = formats::seconds)]
    to: Option<f64>,
    /// Simulated time from one picture of a film or series to the next [s] [default: every frame]
    #[arg(long, value_name = "S", value_parser = formats::interval)]
    every: Option<f64>,
    /// Pictures of a film shown in a second
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100), default_value_t = 25)]
    fps: u32,
    /// Size of a picture or film [pixel] [default: 1920x1080, GIF 960x540]
    #[arg(long, value_name = "WxH", value_parser = formats::size)]
    size: Option<[u32; 2]>,
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
    let format = Format::of(&output)?;
    args.check(format)?;
    match format {
        Format::Html => page::html(&args, &output),
        Format::Png => png(&args, &output),
        Format::Gif | Format::Mp4 => film::film(&args, &output, format),
        Format::Vtp => paraview::vtp(&args, &output),
        Format::Pvd => paraview::pvd(&args, &output),
    }
}

impl Args {
    /// Refuses options of another kind of output.
    fn check(&self, format: Format) -> anyhow::Result<()> {
        let part =
            [("--from", self.from.is_some()), ("--to", self.to.is_some()), ("--every", self.every.is_some())];
        if let Some((name, _)) = part.iter().find(|(_, given)| *given && !format.is_series()) {
            return Err(cli::usage(format!(
                "{name} is for a film or series (.gif, .mp4, .pvd): use --time for one moment"
            )));
        }
        if self.pick && format != Format::Html {
            return Err(cli::usage("--pick makes a page: give a name in .html"));
        }
        if self.time.is_some() && format.is_series() {
            return Err(cli::usage("--time is for one moment: give a film or series its --from and --to"));
        }
        Ok(())
    }

    /// The part of a run that a film or series shows.
    fn span(&self) -> Span {
        Span {
            from: self.from.unwrap_or(f64::NEG_INFINITY),
            to: self.to.unwrap_or(f64::INFINITY),
            every: self.every,
        }
    }

    /// How pictures are drawn.
    fn picture(&self, format: Format) -> PictureOptions {
        let [width, height] =
            self.size.unwrap_or(if format == Format::Gif { [960, 540] } else { [1920, 1080] });
        PictureOptions {
            width,
            height,
            camera: self.camera,
            colour: self.colour.clone(),
            map: self.map,
            range: self.range,
            time: None,
            wall_opacity: self.wall_opacity,
            cut: self.cut,
        }
    }
}

fn png(args: &Args, output: &Output) -> anyhow::Result<Report> {
    let mut moment = Moment::at(args.time);
    let seen = inputs::read_all(&args.inputs, &mut moment)?;
    moment.settle();
    let options = PictureOptions { time: moment.time(), ..args.picture(Format::Png) };
    let image = picture::draw(&moment.parts(), moment.surfaces(), &options)?;
    let mut out: OutputStream = output.open()?;
    out.write_all(&image.png()?).with_context(|| output.name())?;
    out.commit()?;
    let when = options.time.map_or_else(String::new, |t| format!(" at t = {t:.6} s"));
    let summary = format!("{}: {} x {} pixels{when}", output.name(), image.width, image.height);
    Ok(Report::new(summary).with("time_s", options.time).with("layers", seen))
}
