//! The pictures of a film: every moment of a series, with the same eye and the same colours.

use super::Palette;
use crate::reading::series::Series;
use crate::{GrainCount, Image, PictureOptions, Survey, ViewError, picture};
use stream::Table;

/// Pictures that the colours of a GIF are chosen by.
const TRIALS: usize = 8;

/// The moments of a film, and how they are drawn.
pub struct Reel {
    series: Series<Table>,
    survey: Survey,
    options: PictureOptions,
    times: Vec<f64>,
}

impl Reel {
    /// The film of a series.
    ///
    /// # Errors
    /// Nothing to show, positions that are missing or not finite.
    pub fn new(series: Series<Table>, options: PictureOptions) -> Result<Reel, ViewError> {
        let times = series.times();
        if times.is_empty() {
            return Err(ViewError::Empty);
        }
        let mut reel = Reel { series, survey: Survey::default(), options, times };
        let mut survey = Survey::default();
        for &time in &reel.times {
            let tables = reel.series.tables(time)?;
            survey.add(&reel.series.parts(&tables), &reel.series.surfaces, &reel.at(time))?;
        }
        reel.survey = survey;
        Ok(reel)
    }

    /// Times of its pictures [s].
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Most grains of a picture.
    pub fn grains(&self) -> GrainCount {
        self.survey.grains()
    }

    /// Width and height of its pictures [pixel].
    pub fn size(&self) -> [u32; 2] {
        [self.options.width, self.options.height]
    }

    fn at(&self, time: f64) -> PictureOptions {
        self.at_with(time, &self.options)
    }

    fn at_with(&self, time: f64, options: &PictureOptions) -> PictureOptions {
        let surface_values = self.series.surface_values(time);
        let walls_end = self.series.walls_end;
        PictureOptions { time: Some(time), surface_values, walls_end, ..options.clone() }
    }

    /// The picture of a time [s].
    ///
    /// # Errors
    /// As [`picture::draw`].
    pub fn draw(&self, time: f64) -> Result<Image, ViewError> {
        self.draw_with(time, &self.options)
    }

    /// The same with other options, of the same colours' field and camera.
    ///
    /// # Errors
    /// As [`picture::draw`].
    pub fn draw_with(&self, time: f64, options: &PictureOptions) -> Result<Image, ViewError> {
        let tables = self.series.tables(time)?;
        let parts = self.series.parts(&tables);
        let options = self.at_with(time, options);
        picture::draw_surveyed(&parts, &self.series.surfaces, &self.survey, &options)
    }

    /// The colours of a GIF: those of a few pictures over its whole length.
    ///
    /// # Errors
    /// As [`Reel::draw`].
    pub fn palette(&self) -> Result<Palette, ViewError> {
        let trials = self.times.len().min(TRIALS);
        let time = |n: usize| self.times[n * (self.times.len() - 1) / (trials - 1).max(1)];
        let images = (0..trials).map(|n| self.draw(time(n))).collect::<Result<Vec<_>, _>>()?;
        Ok(Palette::of(&images, self.options.map, picture::paper(self.options.dark)))
    }
}
