//! Fills the blind spots of a scan.

use anyhow::Context;
use clap::Parser;
use cli::Report;
use cloud::fill::Settings;
use cloud::{Mesher, Method};
use geom::number::positive;
use geom::{Shape, Vec3, counted};
use std::process::ExitCode;

const ABOUT: &str = "A hole is a region inside the outline of the surface with a density of at most --below. The rim is not \
    changed. Each hole is meshed by ball pivoting, and points are put on the smooth surface that continues its \
    surroundings. Added points have the property filled = 1 and take all other properties from the nearest of those \
    points of the rim that the mesh of the hole joins: another scanned point may be nearer. Without --below, a hole has at most a quarter of the \
    density around it: holes about 8 local spacings wide and wider are found; the report gives the smallest.\n\n\
    Examples:\n\
    \x20 cloud-fill cropped.ply -o filled.ply\n\
    \x20 cloud-fill cropped.ply --for-spacing 0.012 -o filled.ply\n\
    \x20 cloud-fill cropped.ply --seen-from 0,0,1.8 --seen-from 4,2,1.8 -o filled.ply\n\
    \x20 cloud-fill cropped.ply --below 5000 --max-hole 0.1 -o filled.ply";

/// Find the holes of a scan and fill them with points
#[derive(Parser)]
#[command(after_help = ABOUT)]
struct Args {
    #[command(flatten)]
    input: cloud_cli::Input,
    #[command(flatten)]
    output: cloud_cli::CloudOutput,
    /// Smallest distance between added points [m] (default: as dense as the surroundings)
    #[arg(long, value_name = "M", value_parser = cli::length)]
    spacing: Option<f64>,
    /// Also fill surface where the scan is too sparse for bluenoise-sample --spacing M [m]
    #[arg(long, value_name = "M", value_parser = cli::length)]
    for_spacing: Option<f64>,
    /// Fill where there are at most DENSITY points per m² (default: a quarter of the density around)
    #[arg(long, value_name = "DENSITY", value_parser = positive)]
    below: Option<f64>,
    /// Fill only inside SHAPE, also where it crosses the rim (repeat for more)
    #[arg(long, value_name = "SHAPE", value_parser = mesh::shape)]
    region: Vec<Shape>,
    /// Where a scanner stood [m] (repeat for more): space that it looked through stays open
    #[arg(long, value_name = "x,y,z", value_parser = cloud::points::viewpoint, allow_hyphen_values = true)]
    seen_from: Vec<Vec3>,
    /// Also fill holes between two surfaces, as between an edge and the floor behind it
    #[arg(long, conflicts_with = "seen_from")]
    bridge: bool,
    /// Widest hole to fill [m] (default: a fifth of the cloud's diagonal)
    #[arg(long, value_name = "M", value_parser = cli::length)]
    max_hole: Option<f64>,
    /// How added points are spread: blue-noise, random or grid
    #[arg(long, value_name = "METHOD", default_value = "blue-noise")]
    fill: Method,
    /// How holes are meshed: ball-pivoting, or volumetric (signed distances, diffused)
    #[arg(long, value_name = "METHOD", default_value = "ball-pivoting")]
    method: Mesher,
    /// Radii of the balls that mesh a hole [m] (default: fitted to each hole)
    #[arg(long, value_name = "M,…", value_delimiter = ',', value_parser = cli::length)]
    ball: Vec<f64>,
    /// Write the meshes of the holes to FILE (PLY)
    #[arg(long, value_name = "FILE")]
    mesh: Option<cli::OutPath>,
    #[command(flatten)]
    seed: cli::Seed,
}

fn main() -> ExitCode {
    cli::run("cloud-fill", fill)
}

fn fill(args: Args) -> anyhow::Result<Report> {
    args.output.to.check_ending(&["ply"])?;
    if args.fill == Method::Grid {
        args.seed.none("--fill grid")?;
    }
    if args.method == Mesher::Volumetric && !args.ball.is_empty() {
        return Err(cli::usage("--ball: --method volumetric rolls no ball: leave it out"));
    }
    let mut balls = args.ball;
    balls.sort_by(f64::total_cmp);
    let settings = Settings {
        spacing: args.spacing,
        for_spacing: args.for_spacing,
        below: args.below,
        regions: args.region,
        seen_from: args.seen_from,
        bridge: args.bridge,
        max_hole: args.max_hole,
        method: args.fill,
        mesher: args.method,
        balls,
        seed: args.seed.seed(),
    };
    let cloud = args.input.read_places()?;
    if args.bridge && cloud.viewpoints().next().is_some() {
        let name = args.input.name();
        return Err(cli::usage(format!(
            "--bridge changes nothing: {name} says where the scanner stood, and what it did not see is filled: leave --bridge out"
        )));
    }
    let filled = cloud::fill(cloud, &settings).with_context(|| args.input.name())?;
    warn(&filled.report);
    if args.bridge && !filled.report.holes.iter().any(|h| h.between) {
        cli::warn("--bridge changes nothing: no hole lies between two surfaces");
    }
    if !settings.seen_from.is_empty() && filled.report.holes.is_empty() {
        cli::warn("--seen-from changes nothing: no hole was found that could be seen through");
    }
    if let Some(path) = &args.mesh {
        let mut out = cli::OutputStream::file(path)?;
        cloud::write_mesh(&mut out, &filled.mesh, stream::ply::Encoding::default())?;
        out.commit()?;
    }
    args.output.write_cloud(&filled.cloud)?;
    let report = &filled.report;
    let summary = summary(report);
    Ok(args.input.placing.report(Report::new(summary).with_all(report)))
}

fn summary(report: &cloud::fill::Report) -> String {
    let holes = report.holes.len();
    let smallest = report.scales.iter().map(|s| s.smallest_hole);
    let checked = match report.viewpoints {
        0 => String::new(),
        1 => " (checked from 1 viewpoint)".to_owned(),
        eyes => format!(" (checked from {eyes} viewpoints)"),
    };
    match &report.sparse {
        None if holes == 0 && !report.scales.is_empty() => format!(
            "0 points added in 0 holes: holes would be found from {:.3} m wide where the scan is densest, from {:.3} m where it is sparsest, to \
             {:.3} m (--max-hole)",
            smallest.clone().fold(f64::INFINITY, f64::min),
            smallest.fold(0.0, f64::max),
            report.max_hole
        ),
        None => format!("{} added in {}{checked}", counted(report.added, "point"), counted(holes, "hole")),
        Some(sparse) => format!(
            "{} added in {}{checked}, {} in {} too sparse for a spacing of {} m",
            counted(report.added - sparse.added, "point"),
            counted(holes, "hole"),
            sparse.added,
            counted(sparse.places, "place"),
            sparse.spacing
        ),
    }
}

/// Warnings besides the numbers.
fn warn(report: &cloud::fill::Report) {
    if report.not_finite > 0 {
        cli::warn(&format!("{} points without finite coordinates were dropped", report.not_finite));
    }
    if report.below.is_none() {
        cli::warn("too few points, or all at one position: their density is unknown, and nothing was filled");
    }
    for (number, region) in (1..).zip(&report.regions).filter(|(_, region)| region.holes == 0) {
        cli::warn(&match (region.spacing, region.smallest_hole) {
            (Some(spacing), Some(smallest)) => format!(
                "region {number}: no hole was found in its {} points; the spacing there is {spacing:.4} m, so a hole must be at least {smallest:.3} m \
                 wide: give --below DENSITY for a smaller one",
                region.points
            ),
            _ => format!("region {number}: no surface is in or beside it: check its coordinates"),
        });
    }
    if let Some(sparse) = report.sparse.as_ref().filter(|s| s.left > 0) {
        let [x, y, z] = sparse.widest_at.unwrap_or_default();
        cli::warn(&format!(
            "{} gaps in {} places stay too wide for a spacing of {} m: the widest is {:.3} m wide, at {x:.3},{y:.3},{z:.3}: they are holes \
             that stay open, or the points around them lie on no smooth surface; give --below or --max-hole, or a wider spacing",
            sparse.left, sparse.left_places, sparse.spacing, sparse.widest_left
        ));
    }
    let free = |h: &&cloud::fill::HoleReport| h.sight.is_some_and(|sight| sight.free > 0);
    let left: Vec<_> = report.holes.iter().filter(free).collect();
    if let Some(hole) = left.first() {
        let [x, y, z] = hole.centre;
        cli::warn(&format!(
            "{} of {} would lie in space that a scanner looked through: they were left out; the first hole is at {x:.3},{y:.3},{z:.3}, \
             {:.3} m wide; the report lists the holes",
            counted(left.iter().filter_map(|h| h.sight).map(|sight| sight.free).sum::<usize>(), "point"),
            counted(left.len(), "hole"),
            hole.width
        ));
    }
    between(report);
    let is_open = |h: &&cloud::fill::HoleReport| h.open && !h.between;
    let open = report.holes.iter().filter(is_open).count();
    if let Some(hole) = report.holes.iter().find(is_open) {
        let [x, y, z] = hole.centre;
        cli::warn(&format!(
            "{} not completely closed, the first at {x:.3},{y:.3},{z:.3}, {:.3} m wide: balls \
             up to {:.3} m fall through, or too few points surround it; the report lists the holes",
            counted(open, "hole"),
            hole.width,
            hole.ball
        ));
    }
}

/// Says which holes lie between two surfaces.
fn between(report: &cloud::fill::Report) {
    let holes: Vec<_> = report.holes.iter().filter(|h| h.between).collect();
    let Some(widest) = holes.iter().max_by(|a, b| a.width.total_cmp(&b.width)) else { return };
    let ([x, y, z], step) = (widest.centre, widest.step.unwrap_or_default());
    let (what, cure) = if holes.iter().any(|h| h.added > 0) {
        ("filled all the same", "check them in a picture, or give --seen-from")
    } else {
        ("left open", "give --seen-from x,y,z, where the scanner stood, or --bridge to fill them")
    };
    cli::warn(&format!(
        "{} between two surfaces, as between an edge and the floor behind it, {what}: the widest, at {x:.3},{y:.3},{z:.3}, is {:.3} m wide, \
         with a step of {:.0} % of the distance across; the report lists them; {cure}",
        counted(holes.len(), "hole"),
        widest.width,
        100.0 * step
    ));
}
