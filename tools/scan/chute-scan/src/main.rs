//! Makes the scan of a swivel chute that the samples and tests use.

mod scan;

use clap::Parser;
use cli::Report;
use std::process::ExitCode;

const EXAMPLES: &str = "Examples:\n\
    \x20 chute-scan --points 20000 -o chute.ply\n\
    \x20 chute-scan --points 20000 --noise 0.001 | cloud-fill -o chute-filled.ply";

/// Make a synthetic laser scan of a swivel chute, with a blind spot and its mounting end
#[derive(Parser)]
#[command(after_help = EXAMPLES)]
struct Args {
    /// Number of points
    #[arg(long, value_name = "N", default_value_t = 60_000, value_parser = clap::value_parser!(u32).range(1..=50_000_000))]
    points: u32,
    /// Standard deviation of the range noise [m]
    #[arg(long, value_name = "M", default_value_t = 0.0008, value_parser = length)]
    noise: f64,
    /// Radius of the blind spot [m], 0 for none
    #[arg(long, value_name = "M", default_value_t = 0.12, value_parser = length)]
    blind: f64,
    /// Angle of the chute's axis below the horizontal [degrees]
    #[arg(long, value_name = "DEG", default_value_t = 0.0, value_parser = geom::number::finite, allow_hyphen_values = true)]
    tilt_deg: f64,
    #[command(flatten)]
    seed: cli::Seed,
    #[command(flatten)]
    output: cloud_cli::CloudOutput,
}

fn main() -> ExitCode {
    cli::run("chute-scan", |args: Args| {
        let scan = scan::Scan {
            points: args.points as usize,
            noise: args.noise,
            blind: args.blind,
            tilt: args.tilt_deg.to_radians(),
            seed: args.seed.seed(),
        };
        let cloud = scan.cloud();
        args.output.write_cloud(&cloud)?;
        let summary =
            format!("{} points, noise {} m, blind spot of radius {} m", args.points, args.noise, args.blind);
        Ok(Report::new(summary)
            .with("points", args.points)
            .with("noise_m", args.noise)
            .with("blind_m", args.blind)
            .with("tilt_deg", args.tilt_deg)
            .with("seed", args.seed.seed()))
    })
}

fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=0.3).contains(&value) => Ok(value),
        _ => Err("give a length from 0 to 0.3 in metres".into()),
    }
}
