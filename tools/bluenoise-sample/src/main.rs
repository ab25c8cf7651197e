//! Keeps points of a cloud so that their distances are even and their spectrum is blue noise.

mod args;
mod measures;

use anyhow::Context;
use args::Args;
use cli::Report;
use sampling::{Amount, sample};
use std::io::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run("bluenoise-sample", bluenoise_sample)
}

fn bluenoise_sample(args: Args) -> anyhow::Result<Report> {
    let wish = args.wish()?;
    if let Some(plot) = &args.plot {
        sampling::plot::check_name(&plot.to_string_lossy())
            .map_err(|e| cli::usage(format!("--plot: {e}")))?;
    }
    let cloud = args.input.read_cloud()?;
    cloud.check_reach().with_context(|| args.input.name())?;
    let forced = args.forced(&cloud);
    let chosen = sample(&cloud.points, forced.as_deref(), &wish).with_context(|| args.input.name())?;
    let kept = cloud.select(&chosen.kept);
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
    .with("method", wish.method)
    .with("amount", wish.amount)
    .with("seed", wish.seed)
    .with("spacing", chosen.spacing)
    .with("tries", chosen.tries);
    if matches!(wish.amount, Amount::Density(..)) {
        report = report.with("median_density", sampling::median_density(&kept.points, chosen.spacing));
    }
    if args.measured() {
        report = measures::measure(report, &cloud, &kept, args.plot.as_deref())?;
    }
    Ok(report)
}

/// Writes a picture so that it appears when it is whole.
fn write_picture(path: &std::path::Path, bytes: &[u8]) -> anyhow::Result<()> {
    let mut out = cli::OutputStream::file(path)?;
    out.write_all(bytes).with_context(|| path.display().to_string())?;
    out.commit()
}
