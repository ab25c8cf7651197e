//! Draws the radial power spectrum and the anisotropy, as SVG or PNG.

use crate::Spectrum;
use kuva::prelude::*;
use thiserror::Error;

/// What drawing refuses.
#[derive(Debug, Error)]
#[allow(missing_docs)]
pub enum PlotError {
    #[error("plot {0}: the name must end in .svg or .png")]
    Ending(String),
    #[error("plot {name}: cannot draw it: {why}")]
    Draw { name: String, why: String },
}

/// Whether a plot can be written under this name; asked before the work is done.
///
/// # Errors
/// Another ending than .svg or .png.
pub fn check_name(name: &str) -> Result<(), PlotError> {
    let lower = name.to_ascii_lowercase();
    if lower.ends_with(".svg") || lower.ends_with(".png") {
        Ok(())
    } else {
        Err(PlotError::Ending(name.to_owned()))
    }
}

/// The bytes of the picture; the ending of `name` chooses the format.
///
/// # Errors
/// Another ending than .svg or .png; a picture that cannot be drawn.
pub fn draw(name: &str, spectrum: &Spectrum) -> Result<Vec<u8>, PlotError> {
    check_name(name)?;
    let line = |values: &[f64], colour: &str, label: &str| {
        let data: Vec<(f64, f64)> =
            spectrum.wave_number.iter().copied().zip(values.iter().copied()).collect();
        Plot::from(LinePlot::new().with_data(data).with_color(colour).with_legend(label))
    };
    let plots = vec![
        line(&spectrum.power, "steelblue", "radial power (1: random)"),
        line(&spectrum.anisotropy, "darkorange", "anisotropy (1: chance only)"),
    ];
    let layout = Layout::auto_from_plots(&plots)
        .with_title(format!("Spectrum of {} patches", spectrum.patches))
        .with_x_label("waves per mean spacing")
        .with_y_label("power, anisotropy");
    if name.to_ascii_lowercase().ends_with(".svg") {
        return Ok(kuva::render_to_svg(plots, layout).into_bytes());
    }
    kuva::render_to_raster(plots, layout, 1.0).map_err(|why| PlotError::Draw { name: name.to_owned(), why })
}
