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
use measure::{Observer, PerFrame, Which};
use std::path::Path;

/// The option that was given, and what measures.
pub fn observer(args: &Args) -> anyhow::Result<(&'static str, Box<dyn Observer>)> {
    let between = between(args)?;
    let series = which(args, Which::ALL, between);
    let single = which(args, Which::Last, between);
    let name = name(args);
    args.check(name)?;
    let observer: Box<dyn Observer> = match (args, name) {
        (_, "--repose") => {
            let within = args.within.as_ref().map(|g| g.shape.clone());
            Box::new(
                PerFrame::new(Repose::new(heap(args)).context(name)?, single).within(within).without_fallen(),
            )
        }
        (Args { flow: Some(plane), .. }, _) => {
            let within = args.within.as_ref().map(|g| g.shape.clone());
            let options = FlowOptions { plane: *plane, within, span: args.span, between };
            Box::new(Flow::new(options).context(name)?)
        }
        (_, "--profile") => {
            let which = if args.mean { which(args, Which::ALL, between) } else { single };
            let mut options = grid(args)?;
            if options.corners.is_none() && matches!(which, Which::Between(..)) {
                options.corners = around::corners(args, which, options.turn)?;
            }
            Box::new(PerFrame::new(Profile::new(options).context(name)?, which))
        }
        (_, "--segregation") => {
            let kinds = args.kind.clone().map_or(Kinds::Size(args.split), Kinds::Material);
            let measure = Segregation::new(kinds, args.cell, args.up).context(name)?;
            Box::new(PerFrame::new(measure, series))
        }
        (_, "--energy") => Box::new(Energy::new(between)),
        (_, "--settling") => Box::new(Settling::new(between)),
        (_, "--domain") => Box::new(Domain::new(between)),
        (_, "--bonds") => Box::new(BondNumbers::new(between)),
        (_, "--cracks") => Box::new(CrackList::new(between)),
        (_, "--fragments") => Box::new(FragmentList::new(single)),
        (_, "--grading") => Box::new(Grading::new(series, args.sieves.as_ref().map(|s| s.0.clone()))),
        (_, "--forces") => Box::new(Forces::new(single, args.on_walls)),
        (Args { porosity: Some(given), .. }, _) => {
            let region = Region::new(given.shape.clone(), volume(given)?);
            Box::new(PerFrame::new(
                Porosity::new(region).context(format!("--porosity {}", given.text))?,
                series,
            ))
        }
        (Args { wall_force: Some(given), .. }, _) => Box::new(WallForce::new(on_walls(args, given, between))),
        (Args { stress: Some(given), .. }, _) => {
            let region = Region::new(given.shape.clone(), volume(given)?);
            Box::new(Stress::new(region, between).context(format!("--stress {}", given.text))?)
        }
        (_, "--strain") => {
            let within = args.within.as_ref().map(|g| g.shape.clone());
            Box::new(PerFrame::new(Strain::new(within), series))
        }
        (Args { plane_force: Some(plane), .. }, _) => Box::new(PlaneForce::new(*plane, between)),
        (Args { wear: Some(given), .. }, _) => {
            Box::new(Wear::new(on_walls(args, given, between), args.cell).context(name)?)
        }
        (Args { track: Some(ids), .. }, _) => {
            Box::new(PerFrame::new(Track::new(ids).map_err(|e| usage(format!("--track: {e}")))?, series))
        }
        (Args { residence: Some(given), .. }, _) => Box::new(Residence::new(given.shape.clone(), between)),
        (_, "--impact") => Box::new(Impacts::new(between)),
        (Args { bed_slope: Some(side), .. }, _) => {
            Box::new(PerFrame::new(BedSlope::new(slope(args, *side)).context(name)?, series).without_fallen())
        }
        (Args { radial: Some(axis), .. }, _) => {
            Box::new(PerFrame::new(Radial::new(radial(args, *axis)?).context(name)?, single).without_fallen())
        }
        (_, "--bed-height") => {
            let within = args.within.as_ref().map(|g| g.shape.clone());
            let height = BedHeight::new(args.up, args.ground);
            Box::new(PerFrame::new(height, single).within(within).without_fallen())
        }
        _ => Box::new(ContactNumbers::new(series)),
    };
    Ok((name, observer))
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

fn on_walls(args: &Args, given: &GivenShape, between: (f64, f64)) -> WallContactFilter {
    let shape = (given.text != "all").then(|| given.shape.clone());
    WallContactFilter { shape, wall: args.wall.clone(), between }
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
