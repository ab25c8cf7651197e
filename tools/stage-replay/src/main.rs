//! Turns the crossings of a run into an inlet for the stage downstream.

use clap::{Parser, ValueEnum};
use cli::{Output, Report, Source, usage};
use geom::Plane;
use scene::replay::{Intervals, Replay, replay};
use std::process::ExitCode;
use stream::mcap::Compression;

/// Turns the crossings of a run into an inlet MCAP, also while the run is still being written
#[derive(Parser)]
struct Args {
    /// The run (MCAP), - for stdin
    #[arg(value_name = "RUN.mcap", default_value = "-", hide_default_value = true)]
    run: Source,
    /// Calculation plane, px,py,pz,nx,ny,nz (default: the storage plane of the run)
    #[arg(long, value_name = "PLANE", allow_hyphen_values = true)]
    at: Option<Plane>,
    /// Length of the zone before it [m] (default: that of the run)
    #[arg(long, value_name = "M")]
    length: Option<f64>,
    /// Leave out what passes before S; S becomes time 0 [s]
    #[arg(long, value_name = "S", value_parser = seconds)]
    from: Option<f64>,
    /// Leave out what passes at S or later [s]
    #[arg(long, value_name = "S", value_parser = seconds)]
    until: Option<f64>,
    /// Keep the recorded times (default: the first passage becomes time 0)
    #[arg(long, conflicts_with = "from")]
    keep_times: bool,
    /// Index of the storage plane
    #[arg(long, value_name = "N", default_value_t = 0)]
    outlet: u16,
    /// Where recorded intervals are kept; "both" lets grains of a dense flow in without overlap
    #[arg(long, value_enum, default_value = "both")]
    intervals: Keep,
    /// Motion in the zone
    #[arg(long = "move", value_enum, default_value = "constant")]
    motion: Motion,
    #[command(flatten)]
    output: Output,
}

#[derive(Clone, Copy, ValueEnum)]
enum Keep {
    Generation,
    Both,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Motion {
    Constant,
    Ballistic,
    Recorded,
}

fn main() -> ExitCode {
    cli::run("stage-replay", stage_replay)
}

fn stage_replay(args: Args) -> anyhow::Result<Report> {
    if args.motion != Motion::Constant {
        return Err(usage("not available yet: --move ballistic and recorded; use --move constant"));
    }
    if let (Some(from), Some(until)) = (args.from, args.until)
        && until <= from
    {
        return Err(usage(format!("--until {until} s is not after --from {from} s: give a later end")));
    }
    let what = Replay {
        at: args.at,
        length: args.length,
        from: args.from,
        until: args.until,
        keep_times: args.keep_times,
        outlet: args.outlet,
        intervals: match args.intervals {
            Keep::Generation => Intervals::Generation,
            Keep::Both => Intervals::Both,
        },
    };
    let source = args.run.open()?;
    let out = args.output.open()?;
    let compression = if out.is_stream() { Compression::None } else { Compression::Zstd };
    let written = (cli::provenance(Vec::new()), compression);
    let (done, out) = replay(&args.run.to_string(), source, &what, out, written)?;
    out.commit()?;
    if done.particles == 0 {
        cli::warn("nothing passed the storage plane");
    }
    let summary =
        format!("{} particles over {:.4} s, from {:.4} s on", done.particles, done.last, done.start);
    Ok(Report::new(summary).with_all(&done))
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err("give a time in seconds, such as 0.5".into()),
    }
}
