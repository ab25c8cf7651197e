//! Shows runs, walls and clouds: one HTML page that plays, a picture, a film, or files for ParaView.

mod args;
mod colours;
mod counts;
mod diagrams;
mod film;
mod formats;
mod inputs;
mod page;
mod paraview;
mod preview;

use anyhow::Context;
use args::Args;
use cli::{Output, OutputStream, Report, Source};
use formats::Format;
use std::process::ExitCode;
use view::{Moment, PictureOptions, picture};

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
    args.planned = preview::plan(&args, format)?;
    args.colour = args.colour.or(args.planned.as_ref().and_then(preview::Planned::colour));
    let report = match format {
        Format::Html => page::html(&args, &output),
        Format::Png => png(&args, &output),
        Format::Gif | Format::Mp4 => film::film(&args, &output, format),
        Format::Vtp => paraview::vtp(&args, &output),
        Format::Pvd => paraview::pvd(&args, &output),
    };
    Ok(args.placing.report(report?))
}

fn png(args: &Args, output: &Output) -> anyhow::Result<Report> {
    let mut moment = Moment::at(args.time);
    let seen = inputs::read_all(args, &mut moment)?;
    moment.settle()?;
    let options = PictureOptions {
        time: moment.time(),
        surface_values: moment.surface_values(),
        walls_end: moment.walls_end,
        ..args.picture(Format::Png)
    };
    let image = picture::png(&moment.parts(), moment.surfaces(), &options)?;
    for (name, without) in args.doubtful(&options) {
        if picture::png(&moment.parts(), moment.surfaces(), &without)? == image {
            cli::warn(&format!("{name} changes nothing in this picture: leave it out"));
        }
    }
    if args.time.is_some() && options.time.is_none() {
        cli::warn("--time changes nothing in this picture: what is drawn has no times: leave it out");
    }
    args.warn_of_size(image.subject, image.size);
    counts::warn_of_outside(image.outside, "the picture");
    let mut out: OutputStream = output.open()?;
    image.write(&mut out).with_context(|| output.name())?;
    out.commit()?;
    let when = options.time.map_or_else(String::new, |t| format!(" at t = {t:.6} s"));
    let [width, height] = image.size;
    let (size, grains) = (format!("{width} x {height} pixels"), moment.grains());
    let summary = format!("{}: {size}{when}{}", output.name(), counts::words(grains));
    let report = Report::new(summary).with("time_s", options.time).with("layers", seen);
    Ok(report.with_all(&counts::fields(grains)))
}
