//! Turns the points of a surface into wall spheres.

mod args;

use anyhow::Context;
use args::Args;
use cli::Report;
use std::process::ExitCode;
use stream::Values;
use wall::{Regions, Wall, WallReport, build};

fn main() -> ExitCode {
    cli::run("wallgen", wallgen)
}

fn wallgen(args: Args) -> anyhow::Result<Report> {
    let wish = args.wish()?;
    let regions = args.regions()?;
    let (cloud, hash) = args.input.read_cloud_hashed()?;
    let (wall, report) = build(&cloud.points, &regions, &wish).with_context(|| args.input.name())?;
    if args.output.to.has_extension("ply") {
        args.output.write_cloud(&as_cloud(cloud, &wall, &regions)?)?;
    } else {
        let inputs = std::iter::once(hash).chain(args.regions_hash()?).collect();
        let table = wall.table(&regions)?;
        let out = wall::write_mcap(
            args.output.open_binary("walls MCAP")?,
            &table,
            &regions,
            &cli::provenance(inputs),
        )
        .with_context(|| args.output.to.name())?;
        out.commit()?;
    }
    report.warnings.iter().for_each(|w| cli::warn(w));
    Ok(summary(&report).with_all(&report).with("materials", &regions.materials))
}

/// The cloud with the spheres' columns in it; its other properties stay.
fn as_cloud(mut cloud: cloud::Cloud, wall: &Wall, regions: &Regions) -> anyhow::Result<cloud::Cloud> {
    cloud.points = wall.centres.clone();
    cloud.double = true;
    cloud.attributes.replace("radius", Values::F64(wall.radii.clone()))?;
    wall.push_attributes(&mut cloud.attributes, regions)?;
    Ok(cloud)
}

fn summary(report: &WallReport) -> Report {
    let [least, mean, largest] = report.radius_range;
    Report::new(format!(
        "{} wall spheres, radius {least:.4} to {largest:.4} m (mean {mean:.4}), spacing {:.4} m, roughness changed on {} of {} pairs",
        report.spheres, report.spacing, report.changes.pairs_changed, report.changes.pairs
    ))
}
