//! Turns the crossings of a run into an inlet for the stage downstream.

mod args;

use args::Args;
use cli::Report;
use stages::replay::replay;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run("stage-replay", stage_replay)
}

fn stage_replay(args: Args) -> anyhow::Result<Report> {
    let what = args.what()?;
    let mut parts = Vec::new();
    for run in &args.runs {
        parts.push((run.to_string(), run.open()?));
    }
    let out = args.output.open()?;
    let written = (cli::provenance(Vec::new()), out.how());
    let (done, out) = replay(parts, &what, out, written)?;
    out.commit()?;
    if done.particles == 0 {
        let part = if what.from.is_some() { " in the part from --from on" } else { "" };
        cli::warn(&format!("no grain passed the storage plane{part}"));
    }
    if done.near > 0 {
        let cure = match done.ahead {
            Some(ahead) => format!("give a longer --ahead (now {} s)", geom::Shown(ahead)),
            None => "use --intervals both with a longer --ahead".to_owned(),
        };
        cli::warn(&format!(
            "{} less than the largest diameter before the calculation plane, among other grains: {cure}, or cut \
             where grains are faster",
            geom::counted_as(done.near, "slow grain", ["starts", "start"])
        ));
    }
    if let (1.., Some(ahead)) = (done.far, done.ahead) {
        cli::warn(&format!(
            "{} up to {} m before the calculation plane, many lengths of the zone, and {} s \
             before the arrival there, because the slow first grain takes this time for the zone: give a shorter --ahead",
            geom::counted_as(done.far, "grain", ["starts", "start"]),
            geom::Shown(done.farthest),
            geom::Shown(ahead)
        ));
    }
    if done.in_zone > 0 {
        cli::warn(&format!(
            "{} inside the zone when the replay begins, among others: choose a --from at which no grain is in the zone",
            geom::counted_as(done.in_zone, "grain", ["is", "are"])
        ));
    }
    if done.copies > 1 {
        cli::warn(&format!(
            "{} superposed copies: they scale the rate, but a real flow of that rate looks different",
            done.copies
        ));
    }
    let summary =
        format!("{} particles over {:.4} s, from {:.4} s on", done.particles, done.last, done.start);
    Ok(Report::new(summary).with_all(&done))
}
