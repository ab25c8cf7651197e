//! Keeps points of a cloud so that their distances are even and their spectrum is blue noise.

mod args;
mod measures;
mod plot;

use anyhow::Context;
use args::Args;
use cli::Report;
use sampling::{Amount, sample};
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run("bluenoise-sample", bluenoise_sample)
}

fn bluenoise_sample(args: Args) -> anyhow::Result<Report> {
    args.output.to.check_ending(&["ply"])?;
    let settings = args.settings()?;
    if let Some(plot) = &args.plot {
        ::plot::check_name(plot).map_err(|e| cli::usage(format!("--plot {e}")))?;
    }
    let cloud = args.input.read_places()?;
    cloud.check_reach().with_context(|| args.input.name())?;
    let forced = args.forced(&cloud);
    let chosen = sample(&cloud.points, forced.as_deref(), &settings).with_context(|| args.input.name())?;
    let kept = cloud.select(&chosen.kept);
    let density = matches!(settings.amount, Amount::Density(..))
        .then(|| sampling::median_density(&kept.points, chosen.spacing));
    warn(&settings.amount, cloud.points.len(), kept.points.len(), chosen.spacing);
    missed(&settings.amount, kept.points.len(), density);
    args.output.write_cloud(&kept)?;
    let mut report = Report::new(format!(
        "{} of {} points, spacing {} m",
        kept.points.len(),
        cloud.points.len(),
        geom::Shown(chosen.spacing)
    ))
    .with("points_before", cloud.points.len())
    .with("points_after", kept.points.len())
    .with("kept_as_filled", forced.iter().flatten().filter(|&&f| f).count())
    .with("method", settings.method)
    .with("amount", settings.amount)
    .with("distance", settings.distance)
    .with("beside_another_sheet", chosen.beside)
    .with("seed", settings.seed)
    .with("spacing", chosen.spacing)
    .with("tries", chosen.tries);
    if let Some(density) = density {
        report = report.with("median_density", density);
    }
    if args.measured() {
        report = measures::measure(report, &cloud, &kept, args.plot.as_deref())?;
    }
    Ok(args.input.placing.report(report))
}

/// Warns if a spacing [m] or a density does not fit the cloud, as with a scan in millimetres.
fn warn(amount: &Amount, before: usize, after: usize, spacing: f64) {
    if matches!(amount, Amount::Count(_)) || before < 4 {
        return;
    }
    let spacing = geom::Shown(spacing);
    if after == before {
        cli::warn(&format!(
            "all {before} points were kept: the spacing {spacing} m is smaller than that of the cloud; is the cloud in metres?"
        ));
    } else if after < 4 {
        cli::warn(&format!(
            "{after} of {before} points were kept: the spacing {spacing} m is about as wide as the cloud; \
             is the cloud in metres?"
        ));
    }
}

/// Warns if the requested amount was not met.
fn missed(amount: &Amount, after: usize, density: Option<f64>) {
    match (amount, density) {
        (Amount::Count(count), _) if after != *count && 100 * after.abs_diff(*count) > *count => {
            cli::warn(&format!(
                "{after} points instead of {count}: this method has no sample with a nearer count; --method eliminate meets a count exactly"
            ));
        }
        (Amount::Density(low, high), Some(found)) if !(*low..=*high).contains(&found) => {
            let [found, low, high] = [found, *low, *high].map(geom::Shown);
            cli::warn(&format!(
                "the median density is {found} points/m², not between {low} and {high}: the cloud is too sparse, or the range too narrow"
            ));
        }
        _ => {}
    }
}
