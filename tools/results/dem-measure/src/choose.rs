//! From the command line to what measures.

use crate::args::Args;
use crate::around;
use anyhow::{Context, anyhow};
use cli::usage;
use geom::{Vec3, shape::Solid};
use measure::definition::{Argument, ArgumentKind, AskError, Asked, Frames, GivenShape};
use measure::{Observer, Selected, Which};
use std::path::Path;

/// The option that was given, and what measures.
pub fn observer(args: &Args) -> anyhow::Result<(String, Box<dyn Observer>)> {
    let between = between(args)?;
    args.check()?;
    let entry = args.measure.entry;
    let option = format!("--{}", entry.name);
    let which = match entry.frames {
        Frames::Last | Frames::One if !args.mean => which(args, Which::Last, between),
        // They choose among events, which have their own times, and see all frames.
        Frames::Events => Which::Events(between.0, between.1),
        _ => which(args, Which::ALL, between),
    };
    let (named, volume) = match &args.measure.argument {
        Argument::Shape(given) if entry.argument == ArgumentKind::Room => {
            (format!("{option} {}", given.text), volume(given)?)
        }
        _ => (option.clone(), f64::NAN),
    };
    let box_of = |which, turn| around::corners(args, which, turn);
    let observer = (entry.observer)(&asked(args, which, between, (volume, &box_of)));
    let observer = observer.map_err(|error| match error {
        AskError::Usage(why) => usage(why),
        AskError::Look(error) => anyhow::Error::new(error).context(args.run.to_string()),
        AskError::Setting(error) => anyhow::Error::new(error).context(named),
        AskError::Argument(_) => anyhow::Error::new(error).context(option.clone()),
    })?;
    Ok((option, Box::new(Selected::new(observer, which))))
}

fn asked<'a>(
    args: &Args,
    which: Which,
    between: (f64, f64),
    (volume, box_of): (f64, measure::definition::BoxOf<'a>),
) -> Asked<'a> {
    Asked {
        argument: args.measure.argument.clone(),
        volume,
        which,
        between,
        box_of,
        up: args.up,
        sectors: args.sectors,
        outer: args.outer,
        fractions: args.fractions,
        bin: args.bin,
        ground: args.ground,
        side: args.side,
        within: args.within.clone(),
        span: args.span,
        axis: args.axis,
        bins: args.bins,
        turn: args.turn_deg,
        mean: args.mean,
        fields: args.field.clone(),
        cell: args.cell,
        split: args.split,
        kind: args.kind.clone(),
        sieves: args.sieves.as_ref().map(|sieves| sieves.0.clone()),
        wall: args.wall.clone(),
        wear_coefficients: args.wear_coefficient.clone(),
        thickness: args.thickness,
        on_walls: args.on_walls,
        instants: args.instants,
    }
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
