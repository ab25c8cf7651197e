//! Makes a library of stones: named meshes, a table of their shapes, a page of pictures, and variants.

mod args;
mod outputs;

use anyhow::Context;
use args::Args;
use cli::Report;
use geom::{Shown, counted};
use std::process::ExitCode;
use stones::variants::Ranges;
use stones::{Harmonics, Measured, ShapeMeasures, Stone, variants};

fn main() -> ExitCode {
    cli::run("stone-library", stone_library)
}

/// A stone of the library, and what it is.
struct Entry {
    pub stone: Stone,
    pub shape: ShapeMeasures,
    /// `scan` or `variant`.
    pub kind: &'static str,
    /// The file, or the files between which it lies.
    pub source: String,
}

fn stone_library(args: Args) -> anyhow::Result<Report> {
    args.check_used()?;
    let mut all =
        args.meshes.iter().map(|path| scanned(&args, path)).collect::<anyhow::Result<Vec<Entry>>>()?;
    let scans = all.len();
    let ranges = match args.variants {
        Some(count) => Some(vary(&args, &mut all, count as usize)?),
        None => None,
    };
    let names = args.names(&all);
    outputs::write(&args, &all, &names)?;
    let sizes = all.iter().map(|e| e.shape.sieve_size);
    let (lo, hi) = sizes.fold((f64::INFINITY, 0.0f64), |(lo, hi), d| (lo.min(d), hi.max(d)));
    let variants = all.len() - scans;
    let summary = format!(
        "{} and {}, sieve sizes {} to {} m",
        counted(scans, "scan"),
        counted(variants, "variant"),
        Shown(lo),
        Shown(hi)
    );
    args.warn_of_sieves(lo, hi);
    let report = Report::new(summary)
        .with("scans", scans)
        .with("variants", variants)
        .with("names", names)
        .with("ranges", ranges)
        .with("seed", args.seed.seed());
    Ok(args.placing.report(report))
}

fn scanned(args: &Args, path: &std::path::Path) -> anyhow::Result<Entry> {
    let name = path.display().to_string();
    let bytes = stream::whole::file(path).with_context(|| format!("{name}: cannot open it"))?;
    let mesh = cli::read_mesh(&bytes, &name, &args.lengths, &args.placing).with_context(|| name.clone())?;
    let units_given = args.lengths.factor().is_some() || args.placing.scales();
    let stone = Stone::new(&mesh, units_given).with_context(|| name.clone())?;
    let source = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Entry { shape: ShapeMeasures::of(&stone), stone, kind: "scan", source })
}

/// Adds variants of the scans.
fn vary(args: &Args, all: &mut Vec<Entry>, count: usize) -> anyhow::Result<Ranges> {
    let mut measured = Vec::new();
    for entry in all.iter() {
        let Some((harmonics, more)) = Harmonics::of(&entry.stone) else {
            anyhow::bail!(
                "{}: its centre of mass is outside of it: leave it out, or make no variants",
                entry.source
            );
        };
        if more > 0.05 {
            cli::warn(&format!(
                "{}: in {} % of all directions its surface is met more than once: variants have no such hollows",
                entry.source,
                Shown((1000.0 * more).round() / 10.0)
            ));
        }
        measured.push(Measured { harmonics, shape: entry.shape });
    }
    if measured.len() < 3 {
        let scans = counted(measured.len(), "scan");
        cli::warn(&format!("variants of {scans} are much alike: scan more stones"));
    }
    let progress = cli::Progress::new("variants", count as u64);
    let made = variants(&measured, count, args.seed.seed(), || progress.add(1)).context("--variants")?;
    let sources: Vec<String> = all.iter().map(|e| e.source.clone()).collect();
    all.extend(made.into_iter().map(|v| Entry {
        source: format!("{} and {} mirrored ({:.2})", sources[v.between[0]], sources[v.between[1]], v.share),
        stone: v.stone,
        shape: v.shape,
        kind: "variant",
    }));
    Ok(Ranges::of(&measured))
}
