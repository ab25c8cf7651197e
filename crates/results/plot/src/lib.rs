//! Plots as files: the ending of a name chooses SVG or PNG.

mod chart;

pub use chart::chart;

use kuva::backend::{raster::RasterBackend, svg::SvgBackend};
use kuva::prelude::{Layout, Plot};
use kuva::render::render::{Scene, render_multiple};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Colours that are easy to distinguish (Okabe & Ito 2008), and two more.
pub const COLOURS: [&str; 8] =
    ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#A6761D", "#7F7F7F"];

/// What drawing refuses.
#[derive(Debug, Error)]
pub enum PlotError {
    #[error("{}: the name must end in .svg or .png", .0.display())]
    Ending(PathBuf),
    #[error("{}: cannot draw it: {why}", .file.display())]
    Draw { file: PathBuf, why: String },
}

fn is_svg(file: &Path) -> Result<bool, PlotError> {
    match file.extension().unwrap_or_default().to_ascii_lowercase().to_str() {
        Some("svg") => Ok(true),
        Some("png") => Ok(false),
        _ => Err(PlotError::Ending(file.to_owned())),
    }
}

/// Whether a plot can have this name; asked before the work is done.
///
/// # Errors
/// Another ending than .svg or .png.
pub fn check_name(file: &Path) -> Result<(), PlotError> {
    is_svg(file).map(drop)
}

/// The bytes of a picture.
///
/// # Errors
/// Another ending than .svg or .png; a picture that cannot be drawn.
pub fn bytes(file: &Path, scene: &Scene) -> Result<Vec<u8>, PlotError> {
    if is_svg(file)? {
        return Ok(SvgBackend::new().render_scene(scene).into_bytes());
    }
    let drawn = RasterBackend::new().render_scene(scene);
    drawn.map_err(|why| PlotError::Draw { file: file.to_owned(), why })
}

/// The bytes of one diagram.
///
/// # Errors
/// As for [`bytes`].
pub fn diagram(file: &Path, plots: Vec<Plot>, layout: Layout) -> Result<Vec<u8>, PlotError> {
    bytes(file, &render_multiple(plots, layout))
}
