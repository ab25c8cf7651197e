//! What a test leaves: the curves, the plot, the page, the report.

use crate::args::Args;
use crate::words;
use anyhow::{Context, anyhow};
use cli::{Output, Report};
use lab::recipes::Loading;
use lab::{Curve, Lab, SpecimenOutcome, Specimens, Stresses, Summary};
use measure::{Chart, Look};
use record::StopCause;
use std::io::Write;
use std::path::Path;

/// Prints what the user should know of one specimen.
pub fn warn(name: &str, outcome: &SpecimenOutcome) {
    if let SpecimenOutcome::Tested { warnings, .. } = outcome {
        warnings.iter().for_each(|warning| cli::warn(&format!("{name}: {warning}")));
    }
}

/// The curves that came to their end.
fn curves(specimens: &Specimens) -> impl Iterator<Item = (&Loading, &Curve)> {
    specimens.list.iter().filter_map(|(loading, outcome)| match outcome {
        SpecimenOutcome::Tested { curve, .. } => Some((loading, curve)),
        SpecimenOutcome::Stopped { .. } => None,
    })
}

/// Writes everything that was asked for.
pub fn write(
    args: &Args,
    lab: &Lab,
    specimens: &Specimens,
    summary: &Summary,
    folder: &Path,
) -> anyhow::Result<()> {
    // Without a curve there is nothing that a file could hold: the error says why.
    let Some((first, _)) = curves(specimens).next() else { return Ok(()) };
    text(&args.output, &csv(lab, specimens))?;
    if let Some(file) = &args.plot {
        let bytes = plot::chart(file, &chart(lab, specimens)).map_err(|e| anyhow!("--plot {e}"))?;
        bytes_to(file, &bytes)?;
    }
    if let Some(page) = &args.page {
        write_page(page, lab, first, folder)?;
    }
    if let Some(file) = &args.words {
        bytes_to(file, words::table(summary).as_bytes())?;
    }
    if !cli::quiet() {
        words::sentences(summary).iter().for_each(|line| cli::say(line));
    }
    Ok(())
}

/// Writes text to the output.
pub fn text(output: &Output, text: &str) -> anyhow::Result<()> {
    let mut out = output.open_text()?;
    out.write_all(text.as_bytes()).with_context(|| format!("{}: cannot write", output.name()))?;
    out.commit()
}

/// Writes a file.
pub fn bytes_to(file: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let mut out = Output { file: Some(file.into()) }.open_text()?;
    out.write_all(bytes).with_context(|| format!("{}: cannot write", file.display()))?;
    out.commit()
}

/// Stress where each specimen has one, seed, and the columns of its curve.
fn csv(lab: &Lab, specimens: &Specimens) -> String {
    let each = lab.recipe().stresses().0 == Stresses::Each;
    let mut text = String::new();
    for (k, (loading, curve)) in curves(specimens).enumerate() {
        if k == 0 {
            let unit = |name: &str, unit: &str| {
                if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") }
            };
            let first = each.then(|| unit("stress", "Pa")).into_iter().chain(["seed".to_owned()]);
            let names: Vec<String> =
                first.chain(curve.columns.iter().map(|c| unit(c.name, c.unit))).collect();
            text += &(names.join(",") + "\n");
        }
        for row in 0..curve.rows() {
            let first =
                each.then(|| loading.stress.to_string()).into_iter().chain([loading.seed.to_string()]);
            let cells: Vec<String> = first.chain(curve.columns.iter().map(|c| cell(c.values[row]))).collect();
            text += &(cells.join(",") + "\n");
        }
    }
    text
}

/// Nine digits; empty for NaN.
fn cell(value: f64) -> String {
    if value.is_nan() {
        String::new()
    } else {
        geom::Shown(format!("{value:.8e}").parse().unwrap_or(value)).to_string()
    }
}

/// A panel for each column of the plot, a line for each specimen.
fn chart(lab: &Lab, specimens: &Specimens) -> Chart {
    let (x, columns) = lab.recipe().axes();
    let unit = |name: &str| {
        let found =
            curves(specimens).next().and_then(|(_, curve)| curve.columns.iter().find(|c| c.name == name));
        format!(
            "{} [{}]",
            name.replace('_', " "),
            found.map_or("1", |c| if c.unit.is_empty() { "1" } else { c.unit })
        )
    };
    let mut chart = Chart::new(lab.recipe().name());
    for column in columns {
        let line = |(loading, curve): (&Loading, &Curve)| measure::Curve {
            name: lab.name(loading).replace(',', ", "),
            points: curve.column(x).iter().zip(curve.column(column)).map(|(x, y)| [*x, *y]).collect(),
            look: Look::Line,
        };
        let lines: Vec<measure::Curve> =
            curves(specimens).map(line).filter(|line| !line.points.is_empty()).collect();
        if !lines.is_empty() {
            chart = chart.curves(&unit(x), &unit(column), lines);
        }
    }
    chart
}

/// The page of the first specimen that came to its end, by dem-view.
fn write_page(page: &Path, lab: &Lab, first: &Loading, folder: &Path) -> anyhow::Result<()> {
    let run = folder.join(lab.name(first)).join("test.mcap");
    let program = lab::lab::beside_this_program()?.join("dem-view");
    let viewed = std::process::Command::new(program)
        .arg(run)
        .arg("-q")
        .arg("-o")
        .arg(page)
        .output()
        .context("dem-view: cannot be started")?;
    if viewed.status.success() {
        return Ok(());
    }
    if StopCause::of_exit(viewed.status).is_some() {
        return Err(cli::stopped_by_signal(format!("--page {}: stopped by a signal", page.display())));
    }
    Err(anyhow!("--page {}: {}", page.display(), String::from_utf8_lossy(&viewed.stderr).trim()))
}

pub fn report(lab: &Lab, specimens: &Specimens, summary: &Summary) -> Report {
    let tested = curves(specimens).count();
    let (all, test) = (specimens.list.len(), lab.recipe().name());
    let report = Report::new(format!("{test}: {tested} of {all} specimens tested"))
        .with("test", test)
        .with("specimens", all)
        .with("stopped", lab.stopped(specimens))
        .with("stresses", lab.loadings().iter().map(|l| l.stress).collect::<Vec<_>>())
        .with("seeds", lab.loadings().iter().map(|l| l.seed).collect::<Vec<_>>())
        .with_all(summary)
        .with("states", specimens.states());
    let report = match specimens.first_start() {
        Some(start) => report.with("size", start.size).with("mass", start.mass),
        None => report,
    };
    // Of one stress the means stand by themselves, too, where other programs find them.
    let [level] = &summary.levels[..] else { return report };
    level.figures.iter().fold(report, |report, figure| report.with(&figure.name, figure.mean))
}
