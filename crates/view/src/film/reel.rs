//! A film of a run: GIF, or MP4 where ffmpeg is there.

use crate::{
    Args,
    formats::Format,
    inputs,
    mp4::{self, Mp4},
    series::Series,
};
use anyhow::Context;
use cli::{Output, OutputStream, Progress, Report};
use std::borrow::Cow;
use stream::Table;
use view::{
    Image, Part, PictureOptions, Survey, ViewError,
    film::{Gif, Palette},
    picture,
};

/// Pictures that the colours of a GIF are chosen by.
const TRIALS: usize = 8;

/// Draws every moment of the span with the same eye and the same colours.
pub fn film(args: &Args, output: &Output, format: Format) -> anyhow::Result<Report> {
    if format == Format::Mp4 {
        mp4::find().with_context(|| output.name())?;
    }
    let colour = args.colour.clone();
    let slim = move |table| picture::needed(table, colour.as_deref());
    let mut series = Series::new(args.span(), Box::new(move |_, _, _, table| Ok(slim(table))));
    let seen = inputs::read_all(&args.inputs, &mut series)?;
    let times = match series.times() {
        times if times.is_empty() => return Err(ViewError::Empty.into()),
        times => times,
    };
    let mut reel = Reel { series, survey: Survey::default(), options: args.picture(format) };
    reel.survey(&times)?;
    let shown = reel.draw_all(args, output, format, &times)?;
    let [first, last] = [times[0], times[times.len() - 1]];
    let seconds = times.len() as f64 * shown;
    let summary = format!(
        "{}: {} pictures, t = {first:.3} to {last:.3} s, shown in {seconds:.2} s",
        output.name(),
        times.len()
    );
    Ok(Report::new(summary)
        .with("pictures", times.len())
        .with("from_s", first)
        .with("to_s", last)
        .with("shown_s", seconds)
        .with("layers", seen))
}

/// What is drawn, and how.
struct Reel {
    series: Series<Table>,
    survey: Survey,
    options: PictureOptions,
}

impl Reel {
    fn survey(&mut self, times: &[f64]) -> Result<(), ViewError> {
        let mut survey = Survey::default();
        for &time in times {
            let tables = self.tables(time);
            survey.add(&self.parts(&tables), &self.series.surfaces, &self.at(time))?;
        }
        self.survey = survey;
        Ok(())
    }

    fn at(&self, time: f64) -> PictureOptions {
        PictureOptions { time: Some(time), ..self.options.clone() }
    }

    /// Each layer as it is at a time.
    fn tables(&self, time: f64) -> Vec<Option<Cow<'_, Table>>> {
        let layers = self.series.layers.iter();
        layers
            .map(|layer| match &layer.home {
                Some(home) => Some(Cow::Owned(record::moved(home, &layer.motion.pose(time)))),
                None => layer.at(time).map(Cow::Borrowed),
            })
            .collect()
    }

    fn parts<'a>(&self, tables: &'a [Option<Cow<'a, Table>>]) -> Vec<Part<'a>> {
        let shown = self.series.layers.iter().zip(tables);
        shown
            .filter_map(|(layer, table)| {
                let (role, name, kinds) = (layer.role, layer.name.clone(), layer.kinds.clone());
                Some(Part { role, name, table: table.as_deref()?, kinds })
            })
            .collect()
    }

    fn draw(&self, time: f64) -> Result<Image, ViewError> {
        let tables = self.tables(time);
        picture::draw_surveyed(&self.parts(&tables), &self.series.surfaces, &self.survey, &self.at(time))
    }

    /// Draws and writes; how long each picture is shown [s].
    fn draw_all(&self, args: &Args, output: &Output, format: Format, times: &[f64]) -> anyhow::Result<f64> {
        let progress = Progress::new("drawing", times.len() as u64);
        let (mut sink, shown) = self.sink(args, output, format, times)?;
        for &time in times {
            sink.add(&self.draw(time)?).with_context(|| output.name())?;
            progress.add(1);
        }
        sink.finish().with_context(|| output.name())?;
        Ok(shown)
    }

    fn sink(
        &self,
        args: &Args,
        output: &Output,
        format: Format,
        times: &[f64],
    ) -> anyhow::Result<(Sink, f64)> {
        let size = [self.options.width, self.options.height];
        if format == Format::Mp4 {
            return Ok((Sink::Mp4(Mp4::begin(output, size, args.fps)?), 1.0 / f64::from(args.fps)));
        }
        let trials = times.len().min(TRIALS);
        let trial = |n: usize| self.draw(times[n * (times.len() - 1) / (trials - 1).max(1)]);
        let images = (0..trials).map(trial).collect::<Result<Vec<_>, _>>()?;
        let delay = (100.0 / f64::from(args.fps)).round().max(2.0) as u16;
        let gif = Gif::new(output.open()?, size, Palette::of(&images, self.options.map), delay)?;
        Ok((Sink::Gif(gif), f64::from(delay) / 100.0))
    }
}

/// Where pictures go.
enum Sink {
    Gif(Gif<OutputStream>),
    Mp4(Mp4),
}

impl Sink {
    fn add(&mut self, image: &Image) -> anyhow::Result<()> {
        match self {
            Sink::Gif(gif) => Ok(gif.add(image)?),
            Sink::Mp4(mp4) => mp4.add(image),
        }
    }

    fn finish(self) -> anyhow::Result<()> {
        match self {
            Sink::Gif(gif) => gif.finish()?.commit(),
            Sink::Mp4(mp4) => mp4.finish(),
        }
    }
}
