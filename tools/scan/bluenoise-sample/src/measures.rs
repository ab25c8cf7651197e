//! Nearest distances, anisotropy and spectrum, for the report and the plot.

use cli::Report;
use cloud::Cloud;
use std::path::Path;

/// Adds the measures to the report, and draws the spectrum.
pub fn measure(report: Report, before: &Cloud, after: &Cloud, plot: Option<&Path>) -> anyhow::Result<Report> {
    let nearest = sampling::nearest_distances(&after.points);
    let spectrum = nearest.and_then(|n| sampling::spectrum(&after.points, n.median));
    if let Some(path) = plot {
        match &spectrum {
            Some(spectrum) => {
                let picture = crate::plot::draw(path, spectrum)?;
                cli::OutputStream::write_file(path, &picture)?;
            }
            None => cli::warn("--plot: too few points of a sheet for a spectrum: no plot is drawn"),
        }
    }
    Ok(report
        .with("nearest_distance_before", sampling::nearest_distances(&before.points))
        .with("nearest_distance_after", nearest)
        .with("anisotropy", spectrum.as_ref().map(|s| s.mean_anisotropy()))
        .with("spectrum_peak", spectrum.as_ref().map(|s| s.peak().1))
        .with("spectrum_low", spectrum.as_ref().map(|s| s.low()))
        .with("spectrum", spectrum))
}
