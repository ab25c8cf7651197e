//! The command line.

use cli::OutPath;
use cloud::Cloud;
use sampling::{Amount, Distance, Method, SampleSettings};

const EXAMPLES: &str = "Examples:\n\
    \x20 bluenoise-sample filled.ply --spacing 0.012 -o sampled.ply\n\
    \x20 bluenoise-sample filled.ply --count 200 --method eliminate --plot spectrum.svg -o sampled.ply";

/// Thin a cloud to points at even distances (blue noise).
#[derive(clap::Parser)]
#[command(after_help = EXAMPLES)]
#[command(allow_negative_numbers = true)]
#[command(group = clap::ArgGroup::new("amount").required(true).args(["spacing", "count", "density"]))]
pub struct Args {
    #[command(flatten)]
    pub input: cloud_cli::Input,
    #[command(flatten)]
    pub output: cloud_cli::CloudOutput,
    /// Least distance between kept points (grid: distance between its nodes) [m]
    #[arg(long, value_name = "M", value_parser = cli::length)]
    spacing: Option<f64>,
    /// Number of points to keep (within 1 %; exact below 200 and with eliminate; grid: the nearest count that a grid can have)
    #[arg(long, value_name = "N")]
    count: Option<usize>,
    /// Lowest and highest number of kept points per area [1/m²]
    #[arg(long, value_name = "LO,HI", allow_hyphen_values = true, value_parser = density)]
    density: Option<(f64, f64)>,
    /// How points are chosen
    #[arg(long, value_enum, default_value = "poisson")]
    method: Choice,
    /// How to measure distance where two sheets are closer than the spacing: in space, or along the surface, so that the two sides of a thin plate do not thin each other (slower; needs noise well below the spacing of the scan; grid always uses space)
    #[arg(long, value_enum, default_value = "space")]
    distance: Along,
    /// Keep all points whose property `filled` is 1
    #[arg(long)]
    keep_filled: bool,
    /// Draw the spectrum and the anisotropy (FILE.svg or FILE.png)
    #[arg(long, value_name = "FILE")]
    pub plot: Option<OutPath>,
    /// Leave nearest distances and spectrum out of the report; measuring them takes longer than sampling
    #[arg(long)]
    no_measures: bool,
    #[command(flatten)]
    seed: cli::Seed,
    #[command(flatten)]
    common: cli::Common,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Choice {
    /// Poisson disk: kept points are at least the spacing apart, and every other point is within the spacing of a kept one
    Poisson,
    /// Weighted sample elimination
    Eliminate,
    /// Poisson disk, then relaxation
    Relax,
    /// A prepared even pattern, laid on patch by patch; Poisson disk closes the seams
    Tile,
    /// The point nearest to each node of a grid along x, y, z
    Grid,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Along {
    /// Along the surface: points on the other side of a thin plate do not count
    Surface,
    /// In space: near points on another sheet count, too
    Space,
}

impl Args {
    /// The requested sampling.
    pub fn settings(&self) -> anyhow::Result<SampleSettings> {
        let method = match self.method {
            Choice::Poisson => Method::Poisson,
            Choice::Eliminate => Method::Eliminate,
            Choice::Relax => Method::Relax,
            Choice::Grid => Method::Grid,
            Choice::Tile => Method::Tile,
        };
        let amount = match (self.spacing, self.count, self.density) {
            (Some(spacing), _, _) => Amount::Spacing(spacing),
            (_, Some(count), _) => Amount::Count(count),
            (_, _, Some((low, high))) => Amount::Density(low, high),
            _ => return Err(cli::usage("one of --spacing, --count, --density is needed")),
        };
        if self.no_measures && (self.plot.is_some() || self.common.report.is_none()) {
            let why = match &self.plot {
                Some(_) => "--plot draws what is measured",
                None => "changes nothing without --report: nothing is measured then",
            };
            return Err(cli::usage(format!("--no-measures: {why}: leave it out")));
        }
        let distance = match self.distance {
            Along::Surface => Distance::Surface,
            Along::Space => Distance::Space,
        };
        if let Choice::Grid = self.method {
            self.seed.none("--method grid")?;
            if distance == Distance::Surface {
                return Err(cli::usage("--distance surface: --method grid measures in space: leave it out"));
            }
        }
        let settings = SampleSettings { amount, method, distance, seed: self.seed.seed() };
        sampling::check_settings(&settings).map_err(|e| cli::usage(e.to_string()))?;
        Ok(settings)
    }

    /// The points to keep as they are, when `--keep-filled` was given and there are any.
    pub fn forced(&self, cloud: &Cloud) -> Option<Vec<bool>> {
        let filled = cloud.attributes.get("filled");
        if self.keep_filled && filled.is_none() {
            cli::warn("--keep-filled keeps nothing: no property 'filled': cloud-fill writes it");
        }
        let filled = filled.filter(|_| self.keep_filled)?;
        Some((0..filled.len()).map(|row| filled.get(row) == 1.0).collect())
    }

    /// Whether the measures are wanted: they take longer than the sampling.
    pub fn measured(&self) -> bool {
        (self.common.report.is_some() && !self.no_measures) || self.plot.is_some()
    }
}

fn density(text: &str) -> Result<(f64, f64), String> {
    let wrong = || format!("'{text}' is not LO,HI: give two numbers of points per m², such as 20000,30000");
    let (low, high) = text.split_once(',').ok_or_else(wrong)?;
    let number = |t: &str| geom::number::finite(t).map_err(|_| wrong());
    Ok((number(low)?, number(high)?))
}
