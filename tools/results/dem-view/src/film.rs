//! A film of a run: GIF, or MP4 where ffmpeg is there.

use crate::{args::Args, counts, formats::Format, inputs};
use anyhow::Context;
use cli::{Output, OutputStream, Progress, Report};
use view::{
    Image, Role, Series,
    film::{Gif, Mp4, Reel, find_ffmpeg},
    picture,
};

/// Draws every moment of the span with the same eye and the same colours.
pub fn film(args: &Args, output: &Output, format: Format) -> anyhow::Result<Report> {
    if format == Format::Mp4 {
        find_ffmpeg().with_context(|| output.name())?;
    }
    let colour = args.colour.clone();
    let slim = move |role: Role, table| match role.is_rods() {
        true => table,
        false => picture::needed(table, colour.as_deref()),
    };
    let mut series =
        Series::new(args.span(), Box::new(move |_, layer, _, table| Ok(slim(layer.head.role, table))));
    let seen = inputs::read_all(args, &mut series)?;
    let reel = Reel::new(series, args.picture(format))?;
    let shown = draw_all(&reel, args, output, format)?;
    let times = reel.times();
    let [first, last] = [times[0], times[times.len() - 1]];
    let seconds = times.len() as f64 * shown;
    let summary = format!(
        "{}: {}, t = {first:.3} to {last:.3} s, shown in {seconds:.2} s{}",
        output.name(),
        geom::counted(times.len(), "picture"),
        counts::words(reel.grains())
    );
    Ok(Report::new(summary)
        .with_all(&counts::fields(reel.grains()))
        .with("pictures", times.len())
        .with("from_s", first)
        .with("to_s", last)
        .with("shown_s", seconds)
        .with("layers", seen))
}

/// Draws and writes; how long each picture is shown [s].
fn draw_all(reel: &Reel, args: &Args, output: &Output, format: Format) -> anyhow::Result<f64> {
    let progress = Progress::new("drawing", reel.times().len() as u64);
    let (mut sink, shown) = Sink::open(reel, args, output, format)?;
    // Options without effect so far: most act in the first picture, and are looked at once.
    let mut doubtful = args.doubtful(&args.picture(format));
    let (mut largest, mut outside) = (0, [0; 2]);
    for &time in reel.times() {
        let image = reel.draw(time)?;
        largest = largest.max(image.subject);
        outside = outside.max(image.outside);
        let mut idle = Vec::new();
        for (name, without) in doubtful {
            if reel.draw_with(time, &without)? == image {
                idle.push((name, without));
            }
        }
        doubtful = idle;
        sink.add(&image).with_context(|| output.name())?;
        progress.add(1);
    }
    sink.finish().with_context(|| output.name())?;
    for (name, _) in doubtful {
        cli::warn(&format!("{name} changes nothing in this film: leave it out"));
    }
    args.warn_of_size(largest, reel.size());
    counts::warn_of_outside(outside, "a picture of the film");
    Ok(shown)
}

/// Where pictures go.
enum Sink {
    Gif(Gif<OutputStream>),
    /// The film, and the file that ffmpeg writes.
    Mp4(Mp4, OutputStream),
}

impl Sink {
    fn open(reel: &Reel, args: &Args, output: &Output, format: Format) -> anyhow::Result<(Sink, f64)> {
        if format == Format::Mp4 {
            let out = output.open()?;
            let part = out.part().context("an MP4 needs a file: give -o NAME.mp4")?;
            let film = Mp4::begin(part, reel.size(), args.fps())?;
            return Ok((Sink::Mp4(film, out), 1.0 / f64::from(args.fps())));
        }
        let delay = (100.0 / f64::from(args.fps())).round().max(2.0) as u16;
        let palette = reel.palette()?;
        let gif = Gif::new(output.open()?, reel.size(), palette, delay)?;
        Ok((Sink::Gif(gif), f64::from(delay) / 100.0))
    }

    fn add(&mut self, image: &Image) -> anyhow::Result<()> {
        match self {
            Sink::Gif(gif) => Ok(gif.add(image)?),
            Sink::Mp4(mp4, _) => Ok(mp4.add(image)?),
        }
    }

    fn finish(self) -> anyhow::Result<()> {
        match self {
            Sink::Gif(gif) => gif.finish()?.commit(),
            Sink::Mp4(mp4, out) => {
                mp4.finish()?;
                out.commit()
            }
        }
    }
}
