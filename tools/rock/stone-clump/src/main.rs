//! Finds spheres that stand for a stone, and measures its shape.

mod words;

use anyhow::Context;
use clap::Parser;
use cli::Report;
use std::io::Write;
use std::process::ExitCode;
use stones::{Clump, ClumpSettings, Method, ShapeMeasures, Stone};

const EXAMPLES: &str = "The output is a [[clump]] of a scene (TOML) with the mass, centre and inertia of the mesh; with -o NAME.csv or NAME.ply the spheres \
    alone.\n\nExamples:\n\
    \x20 stone-clump stone.ply --spheres 30 -o clump.toml\n\
    \x20 stone-clump stone.stl --units mm --error 10% -o clump.toml\n\
    \x20 stone-clump stone.ply --measures";

/// Find spheres inside a closed mesh that stand for it as a rigid clump, and measure its shape
#[derive(Parser)]
#[command(after_help = EXAMPLES)]
#[command(group = clap::ArgGroup::new("amount").required(true).args(["spheres", "error", "measures"]))]
struct Args {
    /// Closed mesh (PLY, STL, OBJ; detected by content), - for stdin
    #[arg(value_name = "MESH", default_value = "-", hide_default_value = true)]
    mesh: cli::Source,
    #[command(flatten)]
    lengths: cli::Lengths,
    #[command(flatten)]
    placing: cli::Placing,
    #[command(flatten)]
    output: cli::Output,
    /// Number of spheres (tangent: at most this number)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=2000))]
    spheres: Option<u16>,
    /// Share of the volume that may stay outside all spheres: 0.02, or 2%
    #[arg(long, value_name = "SHARE", value_parser = share)]
    error: Option<f64>,
    /// Print the measures of shape as JSON instead: volume, area, sieve size, sides of the smallest box, elongation, flatness, convexity, sphericity, roundness (docs/how-to/rock-fill.md)
    #[arg(long, conflicts_with_all = ["method", "min_radius", "overlap", "distance", "name", "material", "given"])]
    measures: bool,
    /// How spheres are found
    #[arg(long, value_enum, default_value = "distance")]
    method: Choice,
    /// Smallest radius of a sphere [m] [default: 1 % of the diameter of a sphere of the stone's volume]
    #[arg(long, value_name = "M", value_parser = cli::length)]
    min_radius: Option<f64>,
    /// With --method distance: deepest overlap of two spheres, over the diameter of the smaller one; 0: they touch, 1: one may just enclose the other [default: 0.9]
    #[arg(long, value_name = "SHARE", value_parser = share)]
    overlap: Option<f64>,
    /// With --method tangent: surface this near to a sphere needs no further one [m] [default: what the number or the error needs]
    #[arg(long, value_name = "M", value_parser = geom::number::not_negative)]
    distance: Option<f64>,
    /// Name of the clump [default: stone]
    #[arg(long, value_name = "NAME", value_parser = record::name::name)]
    name: Option<String>,
    /// Material of the clump [default: rock]
    #[arg(long, value_name = "NAME", value_parser = record::name::name)]
    material: Option<String>,
    #[command(flatten)]
    seed: cli::Seed,
}

#[derive(Clone, Copy, PartialEq, clap::ValueEnum)]
enum Choice {
    /// The next sphere is the inscribed one that covers most of what is left
    Distance,
    /// Spheres that touch random points of the surface from inside (Ferellec & McDowell 2010)
    Tangent,
}

fn share(text: &str) -> Result<f64, String> {
    let wrong = || "give a share from 0 to 1, such as 0.02 or 2%".to_owned();
    // Units keep the digits of a percentage.
    let value = match text.ends_with('%') {
        true => geom::units::parse(text, "").ok(),
        false => geom::number::finite(text).ok(),
    };
    value.filter(|v| (0.0..=1.0).contains(v)).ok_or_else(wrong)
}

fn main() -> ExitCode {
    cli::run("stone-clump", stone_clump)
}

fn stone_clump(args: Args) -> anyhow::Result<Report> {
    args.check_used()?;
    let (bytes, name) = (args.mesh.read_all()?, args.mesh.to_string());
    let mesh = cli::read_mesh(&bytes, &name, &args.lengths, &args.placing).with_context(|| name.clone())?;
    let units_given = args.lengths.factor().is_some() || args.placing.scales();
    let stone = Stone::new(&mesh, units_given).with_context(|| args.mesh.to_string())?;
    if args.measures {
        args.placing.none("measures of shape are the same in any position")?;
        let shape = ShapeMeasures::of(&stone);
        args.write(words::json(&shape)?.as_bytes())?;
        return Ok(Report::new(words::shape(&shape)).with_all(&shape));
    }
    let settings = args.settings();
    let clump = Clump::of(&stone, &settings).with_context(|| args.mesh.to_string())?;
    let found = clump.spheres.len();
    if let Some(wanted) = args.spheres.filter(|n| usize::from(*n) > found && args.method == Choice::Distance)
    {
        cli::warn(&format!(
            "--spheres {wanted}: only {found} are larger than the smallest radius: give a smaller --min-radius, or more --overlap"
        ));
    }
    if args.output.has_extension("csv") {
        args.write(words::csv(&clump).as_bytes())?;
    } else if args.output.has_extension("ply") {
        args.write(&words::ply(&clump)?)?;
    } else {
        args.write(
            words::toml(
                args.name.as_deref().unwrap_or("stone"),
                args.material.as_deref().unwrap_or("rock"),
                &clump,
                &stone.moments,
            )
            .as_bytes(),
        )?;
    }
    let report = args.placing.report(Report::new(words::summary(&clump)));
    Ok(report
        .with("spheres", clump.spheres.len())
        .with("settings", settings)
        .with("volume", stone.moments.volume)
        .with("volume_error", clump.fit.volume)
        .with("errors", clump.fit))
}

impl Args {
    /// Refuses options that would change nothing.
    fn check_used(&self) -> anyhow::Result<()> {
        let tangent = self.method == Choice::Tangent;
        if !tangent && self.distance.is_some() {
            return Err(cli::usage(
                "--distance: changes nothing with --method distance: it is for --method tangent",
            ));
        }
        if tangent && self.overlap.is_some() {
            return Err(cli::usage(
                "--overlap: changes nothing with --method tangent: it is for --method distance",
            ));
        }
        if self.distance.is_some() && self.error.is_some() {
            return Err(cli::usage("--distance: --error chooses it: leave one of them out"));
        }
        if !tangent && !self.measures {
            self.seed.none("--method distance")?;
        }
        let spheres = self.output.has_extension("csv") || self.output.has_extension("ply");
        let names = [("--name", self.name.is_some()), ("--material", self.material.is_some())];
        if let Some((option, _)) = names.into_iter().find(|(_, given)| *given && spheres) {
            let name = self.output.name();
            return Err(cli::usage(format!(
                "{option}: -o {name} has the spheres alone: leave it out, or write a .toml"
            )));
        }
        let other = self.output.path().and_then(std::path::Path::extension);
        let known = ["toml", "csv", "ply"].iter().any(|e| self.output.has_extension(e));
        if other.is_some() && !known && !self.measures {
            let name = self.output.name();
            return Err(cli::usage(format!("-o {name}: use a name that ends in .toml, .csv or .ply")));
        }
        Ok(())
    }

    fn settings(&self) -> ClumpSettings {
        ClumpSettings {
            method: if self.method == Choice::Tangent { Method::Tangent } else { Method::Distance },
            spheres: self.spheres.map(usize::from),
            error: self.error,
            least_radius: self.min_radius,
            overlap: self.overlap.unwrap_or(0.9),
            distance: self.distance,
            seed: self.seed.seed(),
        }
    }

    fn write(&self, bytes: &[u8]) -> anyhow::Result<()> {
        let mut out = self.output.open()?;
        out.write_all(bytes).with_context(|| self.output.name())?;
        out.commit()
    }
}
