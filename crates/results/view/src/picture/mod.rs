//! Pictures: spheres with their true outlines, drawn by a z-buffer of our own, the same bits every time.

mod caption;
mod chains;
mod counts;
mod drawn_table;
mod font;
mod furniture;
mod hull;
mod ink;
mod joined;
mod joined_bodies;
mod key;
mod lens;
mod light;
mod options;
mod paint;
mod png;
mod rod;
mod rods;
mod shadow;
mod shapes;
mod solid;
mod splat;
mod survey;
mod theme;
mod thin_walls;
mod veil;
mod walls;

pub(crate) use chains::PULL;
pub use drawn_table::DrawnTable;
pub use options::PictureOptions;
pub use png::Png;
pub(crate) use shapes::{ArrowKey, arrow_key};
pub use survey::Survey;

use crate::appearance::field;
use crate::{ViewError, WallSurface};
use ink::Canvas;
use paint::Painted;
use stream::Table;

/// A picture: red, green, blue, alpha, row by row from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// Width [pixel].
    pub width: u32,
    /// Height [pixel].
    pub height: u32,
    /// Four bytes a pixel.
    pub rgba: Vec<u8>,
    /// Longer side of what is shown, without text and planes [pixel].
    pub subject: u32,
    /// Grains that lie outside, where the camera was placed by the program, and all grains; a clump is one.
    pub outside: [usize; 2],
}

impl Image {
    /// The colour at a pixel, from the top left.
    pub fn pixel(&self, x: u32, y: u32) -> [u8; 4] {
        let at = 4 * (y as usize * self.width as usize + x as usize);
        [self.rgba[at], self.rgba[at + 1], self.rgba[at + 2], self.rgba[at + 3]]
    }
}

/// Draws the parts as they are at one moment, and the surfaces where they are at the time stated.
///
/// # Errors
/// Nothing to draw, a broken table, an unknown field, or a size out of range.
pub fn draw(
    parts: &[DrawnTable],
    surfaces: &[WallSurface],
    options: &PictureOptions,
) -> Result<Image, ViewError> {
    let mut survey = Survey::default();
    survey.add(parts, surfaces, options)?;
    draw_surveyed(parts, surfaces, &survey, options)
}

/// Draws a moment of a film: seen and coloured as all the moments that `survey` took in.
///
/// # Errors
/// As [`draw`].
pub fn draw_surveyed(
    parts: &[DrawnTable],
    surfaces: &[WallSurface],
    survey: &Survey,
    options: &PictureOptions,
) -> Result<Image, ViewError> {
    let mut rgba = Vec::with_capacity(4 * options.width as usize * options.height as usize);
    let drawn = rows(parts, surfaces, survey, options, |rows| {
        rgba.extend_from_slice(rows);
        Ok(())
    })?;
    let (width, height) = (options.width, options.height);
    Ok(Image { width, height, rgba, subject: drawn.subject, outside: drawn.outside })
}

/// Draws as [`draw`], into a PNG file: a few rows of the picture are in memory at once.
///
/// # Errors
/// As [`draw`]; the encoder failed.
pub fn png(
    parts: &[DrawnTable],
    surfaces: &[WallSurface],
    options: &PictureOptions,
) -> Result<Png, ViewError> {
    let mut survey = Survey::default();
    survey.add(parts, surfaces, options)?;
    let mut file = png::Rows::new([options.width, options.height])?;
    let drawn = rows(parts, surfaces, &survey, options, |rows| file.add(rows))?;
    file.finish(drawn)
}

/// What is known of a picture besides its colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Drawn {
    subject: u32,
    outside: [usize; 2],
}

/// Draws from the top down; `each` takes the next rows, four bytes a pixel.
fn rows(
    parts: &[DrawnTable],
    surfaces: &[WallSurface],
    survey: &Survey,
    options: &PictureOptions,
    mut each: impl FnMut(&[u8]) -> Result<(), ViewError>,
) -> Result<Drawn, ViewError> {
    let (width, height) = (options.width, options.height);
    if !(64..=16384).contains(&width) || !(64..=16384).contains(&height) {
        return Err(ViewError::Size { width, height });
    }
    let painted = Painted::new(parts, surfaces, survey, options)?;
    let lens = lens::Lens::new(&painted, options);
    light::render(&painted, &lens, options, |top, mut rgba| {
        let canvas = Canvas { size: [width, height], top, rgba: &mut rgba };
        furniture::add(canvas, &painted, &lens, options);
        each(&rgba)
    })?;
    Ok(Drawn { subject: lens.longer_side(&painted.outline), outside: lens.outside(&painted, options) })
}

/// The colour of the paper.
pub(crate) fn paper(dark: bool) -> [u8; 3] {
    theme::Theme::of(dark).paper_bytes()
}

/// The columns of a table that a picture coloured by `colour` needs; all of them where that field is not there, so
/// that the message can name what is.
pub fn needed(mut table: Table, colour: Option<&str>) -> Table {
    let asked = colour.map(field::canonical);
    let Some(wanted) = field::columns(&table, asked) else { return table };
    let others: Vec<String> = table.columns().iter().map(|c| c.name.clone()).collect();
    for name in others.iter().filter(|name| !wanted.contains(name)) {
        table.remove(name);
    }
    table
}
