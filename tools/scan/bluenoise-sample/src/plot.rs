//! Draws the radial power spectrum and the anisotropy.

use kuva::prelude::*;
use plot::PlotError;
use sampling::Spectrum;
use std::path::Path;

/// The bytes of the picture; the ending of the name chooses the format.
pub fn draw(file: &Path, spectrum: &Spectrum) -> Result<Vec<u8>, PlotError> {
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
    plot::diagram(file, plots, layout)
}
