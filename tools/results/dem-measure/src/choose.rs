//! From the command line to what measures.

use crate::args::{Args, Bins, GivenShape};
use crate::around;
use anyhow::{Context, anyhow};
use cli::usage;
use geom::{Plane, Vec3, shape::Solid};
use measure::bed::{BedHeight, BedSlope, SlopeOptions};
use measure::bonds::{BondNumbers, CrackList, FragmentList, Grading};
use measure::coordination::ContactNumbers;
use measure::domain::Domain;
use measure::energy::Energy;
use measure::flow::{Flow, FlowOptions};
use measure::forces::Forces;
use measure::impact::Impacts;
use measure::plane_force::PlaneForce;
use measure::porosity::Porosity;
use measure::profile::{Profile, ProfileOptions};
use measure::radial::{Radial, RadialOptions};
use measure::region::Region;
use measure::repose::{HeapOptions, Repose};
use measure::residence::Residence;
use measure::segregation::{Kinds, Segregation};
use measure::settling::Settling;
use measure::strain::Strain;
use measure::stress::Stress;
use measure::track::Track;
use measure::wall_force::{WallContactFilter, WallForce};
use measure::wear::Wear;
use measure::{Observer, PerFrame, Selected, Which};
use std::path::Path;

/// The option that was given, and what measures.
pub fn observer(args: &Args) -> anyhow::Result<(&'static str, Box<dyn Observer>)> {
    let between = between(args)?;
    let name = name(args);
    args.check(name)?;
    let (observer, which) = measure_of(args, name, between)?;
    Ok((name, Box::new(Selected::new(observer, which))))
}

/// What measures, and the frames that it is given. Flow, cracks and impacts choose among events, which have their own times, and see all frames.
fn measure_of(
    args: &Args,
    name: &'static str,
    between: (f64, f64),
) -> anyhow::Result<(Box<dyn Observer>, Which)> {
    let series = which(args, Which::ALL, between);
    let single = which(args, Which::Last, between);
    let events = Which::Events(between.0, between.1);
    let within = || args.within.as_ref().map(|g| g.shape.clone());
    let region = |given: &GivenShape| anyhow::Ok(Region::new(given.shape.clone(), volume(given)?));
    let chosen: (Box<dyn Observer>, Which) = match (args, name) {
        (_, "--repose") => {
            let heap = Repose::new(heap(args)).context(name)?;
            (Box::new(PerFrame::new(heap).within(within()).without_fallen()), single)
        }
        (Args { flow: Some(plane), .. }, _) => {
            let options = FlowOptions { plane: *plane, within: within(), span: args.span, between };
            (Box::new(Flow::new(options).context(name)?), events)
        }
        (_, "--profile") => {
            let which = if args.mean { series } else { single };
            let mut options = grid(args)?;
            if options.corners.is_none() && matches!(which, Which::Between(..)) {
                options.corners = around::corners(args, which, options.turn)?;
            }
            (Box::new(PerFrame::new(Profile::new(options).context(name)?)), which)
        }
        (_, "--segregation") => {
            let kinds = args.kind.clone().map_or(Kinds::Size(args.split), Kinds::Material);
            let measure = Segregation::new(kinds, args.cell, args.up).context(name)?;
            (Box::new(PerFrame::new(measure)), series)
        }
        (_, "--energy") => (Box::<Energy>::default(), series),
        (_, "--settling") => (Box::<Settling>::default(), series),
        (_, "--domain") => (Box::<Domain>::default(), series),
        (_, "--bonds") => (Box::<BondNumbers>::default(), series),
        (_, "--cracks") => (Box::new(CrackList::new(between)), events),
        (_, "--fragments") => (Box::<FragmentList>::default(), single),
        (_, "--grading") => (Box::new(Grading::new(args.sieves.as_ref().map(|s| s.0.clone()))), series),
        (_, "--forces") => (Box::new(Forces::new(args.on_walls)), single),
        (Args { porosity: Some(given), .. }, _) => {
            let porosity = Porosity::new(region(given)?).context(format!("--porosity {}", given.text))?;
            (Box::new(PerFrame::new(porosity)), series)
        }
        (Args { wall_force: Some(given), .. }, _) => {
            (Box::new(WallForce::new(on_walls(args, given))), series)
        }
        (Args { stress: Some(given), .. }, _) => {
            let stress = Stress::new(region(given)?).context(format!("--stress {}", given.text))?;
            (Box::new(stress), series)
        }
        (_, "--strain") => (Box::new(PerFrame::new(Strain::new(within()))), series),
        (Args { plane_force: Some(plane), .. }, _) => (Box::new(PlaneForce::new(*plane)), series),
        (Args { wear: Some(given), .. }, _) => {
            (Box::new(Wear::new(on_walls(args, given), args.cell).context(name)?), series)
        }
        (Args { track: Some(ids), .. }, _) => {
            let track = Track::new(ids).map_err(|e| usage(format!("--track: {e}")))?;
            (Box::new(PerFrame::new(track)), series)
        }
        (Args { residence: Some(given), .. }, _) => (Box::new(Residence::new(given.shape.clone())), series),
        (_, "--impact") => (Box::new(Impacts::new(between)), events),
        (Args { bed_slope: Some(side), .. }, _) => {
            let bed = BedSlope::new(slope(args, *side)).context(name)?;
            (Box::new(PerFrame::new(bed).without_fallen()), series)
        }
        (Args { radial: Some(axis), .. }, _) => {
            let radial = Radial::new(radial(args, *axis)?).context(name)?;
            (Box::new(PerFrame::new(radial).without_fallen()), single)
        }
        (_, "--bed-height") => {
            let height = BedHeight::new(args.up, args.ground);
            (Box::new(PerFrame::new(height).within(within()).without_fallen()), single)
        }
        _ => (Box::<ContactNumbers>::default(), series),
    };
    Ok(chosen)
}

/// Clap sees to it that one is given.
fn name(args: &Args) -> &'static str {
    let given = [
        ("--repose", args.repose),
        ("--flow", args.flow.is_some()),
        ("--profile", args.profile),
        ("--radial", args.radial.is_some()),
        ("--segregation", args.segregation),
        ("--energy", args.energy),
        ("--settling", args.settling),
        ("--domain", args.domain),
        ("--bonds", args.bonds),
        ("--cracks", args.cracks),
        ("--fragments", args.fragments),
        ("--grading", args.grading),
        ("--forces", args.forces),
        ("--porosity", args.porosity.is_some()),
        ("--wall-force", args.wall_force.is_some()),
        ("--stress", args.stress.is_some()),
        ("--strain", args.strain),
        ("--plane-force", args.plane_force.is_some()),
        ("--wear", args.wear.is_some()),
        ("--residence", args.residence.is_some()),
        ("--track", args.track.is_some()),
        ("--impact", args.impact),
        ("--bed-height", args.bed_height),
        ("--bed-slope", args.bed_slope.is_some()),
    ];
    given.iter().find(|(_, given)| *given).map_or("--contacts", |(name, _)| name)
}

fn between(args: &Args) -> anyhow::Result<(f64, f64)> {
    let (from, until) = (args.from.unwrap_or(f64::NEG_INFINITY), args.until.unwrap_or(f64::INFINITY));
    match from < until {
        true => Ok((from, until)),
        false => Err(usage(format!("--until {until} s is not after --from {from} s: give a later end"))),
    }
}

fn which(args: &Args, default: Which, (from, until): (f64, f64)) -> Which {
    match args.time {
        Some(time) => Which::At(time),
        None if args.last => Which::Last,
        None if args.all || args.from.is_some() || args.until.is_some() => Which::Between(from, until),
        None => default,
    }
}

fn heap(args: &Args) -> HeapOptions {
    let default = HeapOptions::default();
    HeapOptions {
        up: args.up,
        wall: args.side,
        sectors: args.sectors.unwrap_or(default.sectors),
        fractions: args.fractions.unwrap_or(default.fractions),
        bin: args.bin,
        ground: args.ground,
        without_falling: args.within.is_some(),
    }
}

fn slope(args: &Args, side: Vec3) -> SlopeOptions {
    let fractions = args.fractions.unwrap_or(HeapOptions::default().fractions);
    SlopeOptions { side, up: args.up, fractions, bin: args.bin }
}

fn radial(args: &Args, axis: Plane) -> anyhow::Result<RadialOptions> {
    let rings = match args.bins.unwrap_or(Bins::One(20)) {
        Bins::One(rings) => rings,
        Bins::All(_) => return Err(usage("--bins: --radial has rings only: give one number")),
    };
    Ok(RadialOptions {
        axis,
        rings,
        sectors: args.sectors.unwrap_or(1),
        outer: args.outer,
        ground: args.ground,
    })
}

fn grid(args: &Args) -> anyhow::Result<ProfileOptions> {
    let corners = match args.within.as_ref().map(|g| (&g.shape, &g.text)) {
        None => None,
        Some((shape, text)) => match &shape.solid {
            Solid::Box(low, high) if !shape.outside => Some((*low, *high)),
            _ => return Err(usage(format!("--within {text}: the grid of --profile is a box: give box:…"))),
        },
    };
    let mut bins = [1; 3];
    match args.bins.unwrap_or(Bins::One(20)) {
        Bins::One(n) => bins[args.axis.unwrap_or(2)] = n,
        Bins::All(_) if args.axis.is_some() => {
            return Err(usage("--axis: --bins gives all three axes: leave --axis out"));
        }
        Bins::All(all) => bins = all,
    }
    let fields = args.field.clone();
    Ok(ProfileOptions { bins, corners, turn: args.turn_deg, mean: args.mean, fields })
}

fn on_walls(args: &Args, given: &GivenShape) -> WallContactFilter {
    let shape = (given.text != "all").then(|| given.shape.clone());
    WallContactFilter { shape, wall: args.wall.clone() }
}

/// Volume [m³] of what has a file; shapes without one know theirs.
fn volume(given: &GivenShape) -> anyhow::Result<f64> {
    if let Solid::Mesh(inside) = &given.shape.solid {
        return Ok(inside.volume());
    }
    match given.text.trim_start_matches('!').split_once(':') {
        Some(("prism", file)) => {
            let text =
                stream::whole::text(Path::new(file)).with_context(|| format!("{file}: cannot read"))?;
            prism_volume(&text).ok_or_else(|| anyhow!("{file}: not a prism"))
        }
        _ => Ok(f64::NAN),
    }
}

/// Area of the polygon (as a vector) times the extrusion.
fn prism_volume(text: &str) -> Option<f64> {
    let json: serde_json::Value = serde_json::from_str(text).ok()?;
    let vector = |v: &serde_json::Value| Some(Vec3::new(v[0].as_f64()?, v[1].as_f64()?, v[2].as_f64()?));
    let corners: Vec<Vec3> = json["polygon"].as_array()?.iter().map(vector).collect::<Option<_>>()?;
    let first = corners.first()?;
    let area: Vec3 = corners.windows(2).map(|w| (w[0] - first).cross(&(w[1] - first)) * 0.5).sum();
    Some(area.dot(&vector(&json["extrusion"])?).abs())
}
