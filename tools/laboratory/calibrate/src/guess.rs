//! `--guess`: four questions, and a start.

use crate::args::Args;
use anyhow::Context;
use calibration::CalibrateError;
use calibration::guess::{Answers, Moisture, start};
use cli::Report;
use std::io::{BufRead, IsTerminal, Write};

/// Asks what is not given, and prints a start.
pub fn guess(args: &Args) -> anyhow::Result<Report> {
    let material = answer(&args.material, "--material", "What is it (a name, such as sand)?")?;
    let size = answer(&args.size, "--size", "How large are its grains (such as 5 mm)?")?;
    let size = size
        .parse()
        .or_else(|_| geom::units::parse(&size, "m"))
        .map_err(|e| cli::usage(format!("--size: {e}")))?;
    let moisture = match answer(&args.moisture, "--moisture", "How wet is it (dry, damp or wet)?")?.as_str() {
        "dry" => Moisture::Dry,
        "damp" => Moisture::Damp,
        "wet" => Moisture::Wet,
        other => return Err(cli::usage(format!("--moisture {other}: give dry, damp or wet"))),
    };
    let repose = answer(&args.repose_deg, "--repose-deg", "At which angle do its heaps lie (degrees)?")?;
    let repose =
        geom::number::positive(&repose).map_err(|e| cli::usage(format!("--repose-deg {repose}: {e}")))?;
    let text = start(&Answers { material, size, moisture, repose }).map_err(|e| match e {
        CalibrateError::Usage(text) => cli::usage(text),
        other => other.into(),
    })?;
    let mut out = args.output.open_text()?;
    out.write_all(text.as_bytes()).with_context(|| args.output.name())?;
    out.commit()?;
    Ok(Report::new("a start: calibrate it with a measured curve before you trust it"))
}

/// The answer of an option, or of the person at the terminal.
fn answer(given: &Option<String>, option: &str, question: &str) -> anyhow::Result<String> {
    if let Some(given) = given {
        return Ok(given.trim().to_owned());
    }
    if !std::io::stdin().is_terminal() {
        return Err(cli::usage(format!("--guess: {question} Give {option}")));
    }
    cli::say(question);
    let mut line = String::new();
    std::io::stdin().lock().read_line(&mut line).context("stdin")?;
    Ok(line.trim().to_owned())
}
