//! Turns the points of a surface into wall spheres.

mod args;
mod changes;
mod surface;

use anyhow::Context;
use args::Args;
use cli::Report;
use geom::Shown;
use std::process::ExitCode;
use stream::Values;
use surface::WallPoints;
use wall::drawn::DrawnReport;
use wall::{Radius, Regions, Wall, WallReport, WallSettings, build};

fn main() -> ExitCode {
    cli::run("wallgen", wallgen)
}

fn wallgen(args: Args) -> anyhow::Result<Report> {
    args.output.to.check_ending(&["mcap", "ply"])?;
    args.check_used()?;
    let mut settings = args.settings()?;
    let mut regions = args.regions()?;
    let WallPoints { cloud, name, hashes, drawn, added } = surface::read(&args, &regions, &settings)?;
    cloud.check_reach().with_context(|| name.clone())?;
    args.look(&mut settings, cloud.viewpoints())?;
    let property = |name: &str| cloud.attributes.get(name).map(|v| (0..v.len()).map(|i| v.get(i)).collect());
    let wear = regions.measure(&cloud.points, &property).with_context(|| name.clone())?;
    let (wall, report) = build(&cloud.points, &regions, &settings).with_context(|| name)?;
    if args.output.to.has_extension("ply") {
        args.output.write_cloud(&as_cloud(cloud, &wall, &regions)?)?;
    } else {
        let inputs =
            hashes.into_iter().chain(args.regions_hash()?).chain(args.input.placing.hash()).collect();
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
    if let Some(path) = &args.changes {
        changes::write(path, &report.changed)?;
    }
    report.warnings.iter().for_each(|w| cli::warn(w));
    far_in_front(&report).iter().for_each(|w| cli::warn(w));
    let words = summary(&report, &settings, drawn.as_ref())
        + &in_front(&report)
        + &as_seen(&settings)
        + &of_drawing(added)
        + &in_steps(&regions)
        + &passes(&report, &settings);
    let all = args.input.placing.report(Report::new(words));
    let all = all.with_all(&report).with("materials", &regions.materials).with("stepped", &regions.stepped);
    let all = if let Some(added) = added { all.with("of_drawing", added) } else { all };
    let all = if let Some(drawn) = &drawn { all.with("drawing", drawn) } else { all };
    Ok(if let Some(wear) = &wear { all.with("wear", wear) } else { all })
}

/// The cloud with the spheres' columns in it; its other properties stay.
fn as_cloud(mut cloud: cloud::Cloud, wall: &Wall, regions: &Regions) -> anyhow::Result<cloud::Cloud> {
    cloud.points = wall.centres.clone();
    cloud.double = true;
    cloud.attributes.replace("radius", Values::F64(wall.radii.clone()))?;
    wall.push_attributes(&mut cloud.attributes, regions)?;
    Ok(cloud)
}

/// Share of the width of a cloud above which a wall that stands so far in front of its points has another shape [–].
const IN_FRONT: f64 = 0.02;
/// The same of the radius of curvature: a pipe is then narrower by this share.
const OF_RADIUS: f64 = 0.05;

/// A warning where the wall stands far in front of the points, or in steps.
fn far_in_front(report: &WallReport) -> Option<String> {
    let radius = report.curvature_radius.unwrap_or(f64::INFINITY);
    let is_far = |most: f64| most > IN_FRONT * report.width || most > OF_RADIUS * radius;
    let [least, most] = report.in_front.filter(|[_, most]| is_far(*most))?;
    let step = match most - least > 0.5 * most {
        true => format!(", and {} m less where it is rougher", Shown(most - least)),
        false => String::new(),
    };
    let first = if most > report.width { "; is it in millimetres? If not, give" } else { ": give" };
    let bends = match most > OF_RADIUS * radius {
        true => format!(", and a quarter of it bends with a radius below {} m", Shown(radius)),
        false => String::new(),
    };
    Some(format!(
        "the centres of the spheres are on the points, so the wall stands {} m in front of them{step}; the cloud is {} m wide{bends}{first} the flow \
         side, --facing x,y,z or --flow-at x,y,z, and the wall goes through the points",
        Shown(most),
        Shown(report.width)
    ))
}

/// How far the wall stands in front of the points, where the centres are on them.
fn in_front(report: &WallReport) -> String {
    match report.in_front {
        Some([least, most]) if Shown(least).to_string() == Shown(most).to_string() => {
            format!("; the wall stands {} m in front of the points", Shown(most))
        }
        Some([least, most]) => {
            format!("; the wall stands {} to {} m in front of the points", Shown(least), Shown(most))
        }
        None => String::new(),
    }
}

/// Where the flow side is known from.
fn as_seen(settings: &WallSettings) -> String {
    match settings.seen_from.len() {
        0 => String::new(),
        n => format!(
            "; surfaces on the points, on the side that {} of the cloud saw",
            geom::counted(n, "viewpoint")
        ),
    }
}

/// How many spheres stand on the drawing, if there is one beside the cloud.
fn of_drawing(added: Option<usize>) -> String {
    added
        .map_or(String::new(), |added| format!("; {added} of them on the drawing, where the cloud is sparse"))
}

/// Properties that change along a column of the cloud, and how exactly.
fn in_steps(regions: &Regions) -> String {
    let words = |s: &wall::steps::Stepped| {
        format!("; {} by {} in {} steps, at most {} off", s.property, s.column, s.steps, Shown(s.error))
    };
    regions.stepped.iter().map(words).collect()
}

/// The result of the check of gaps, if requested.
fn passes(report: &WallReport, settings: &WallSettings) -> String {
    let limit = Shown(report.gaps_up_to);
    match report.widest_gap {
        _ if !settings.gaps => String::new(),
        None => format!("; nothing passes (gaps wider than {limit} m count as outline)"),
        Some(gap) => {
            let [x, y, z] = gap.at.map(|c| format!("{c:.4}"));
            let widest = Shown(gap.diameter);
            format!(
                "; the largest sphere that passes: {widest} m at ({x}, {y}, {z}) m (gaps wider than {limit} m count as outline)"
            )
        }
    }
}

fn summary(report: &WallReport, settings: &WallSettings, drawn: Option<&DrawnReport>) -> String {
    let [least, mean, largest] = report.radius_range.map(Shown);
    let (spheres, spacing, changes) = (report.spheres, Shown(report.spacing), &report.changes);
    if settings.radius == Radius::Solve {
        return format!(
            "{spheres} wall spheres, radius {least} to {largest} m (mean {mean}), spacing {spacing} m, \
             roughness changed on {} of {} pairs",
            changes.pairs_changed, changes.pairs
        );
    }
    if let Some(drawn) = drawn {
        return format!(
            "{spheres} wall spheres of radius {mean} m under {} faces, spacing {spacing} m on average, {} stretches with {} corners, \
             deepest dent {} m",
            drawn.faces,
            drawn.stretches,
            drawn.corners,
            Shown(drawn.deepest)
        );
    }
    let [low, middle, high] = changes.dents.map(Shown);
    let asked = match settings.radius {
        Radius::Uniform => format!(", requested {} m", Shown(report.roughness)),
        _ => String::new(),
    };
    let apart = match changes.pairs_apart {
        0 => String::new(),
        apart => format!("; {apart} of {} pairs are too far apart to touch", changes.pairs),
    };
    format!(
        "{spheres} wall spheres of radius {mean} m, spacing {spacing} m, \
         dents {low} to {high} m (mean {middle}){asked}{apart}"
    )
}
