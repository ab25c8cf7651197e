//! Finds the masks of photographs of a stone.

mod args;
mod kept;
mod work;

use args::Args;
use cli::Report;
use geom::Shown;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run("stone-mask", stone_mask)
}

fn stone_mask(args: Args) -> anyhow::Result<Report> {
    args.check_used()?;
    let photographs = args.photographs()?;
    let done = work::masks(&args, &photographs)?;
    let warned = work::warn(&photographs, &done);
    if let Some(sheet) = &args.sheet {
        work::write_sheet(sheet, &done, &warned)?;
    }
    let names: Vec<String> = photographs.iter().map(|p| p.display().to_string()).collect();
    let shares: Vec<f64> = done.iter().map(|d| d.area / d.pixels as f64).collect();
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    let before = done.iter().filter(|d| d.origin == work::Origin::Before).count();
    let doubtful = warned.iter().filter(|w| **w).count();
    let summary = format!(
        "{}{}; the stone takes {} % of a photograph on average{}",
        geom::counted(done.len(), "mask"),
        if before > 0 { format!(", {before} of them found before") } else { String::new() },
        Shown((1000.0 * mean).round() / 10.0),
        if doubtful > 0 { format!("; doubtful: {doubtful}") } else { String::new() }
    );
    Ok(Report::new(summary)
        .with("photographs", names)
        .with("areas", done.iter().map(|d| d.area).collect::<Vec<_>>())
        .with("found", done.iter().map(|d| d.found).collect::<Vec<_>>())
        .with("doubtful", warned))
}
