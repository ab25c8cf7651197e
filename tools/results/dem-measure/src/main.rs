//! Measures a run: `measure::registry` holds what can be measured.

mod args;
mod around;
mod choose;
mod measures;
mod sheet;
mod solids;

use anyhow::{Context, anyhow};
use args::Args;
use cli::{Progress, Report};
use measure::{Row, Run, Summary};
use std::process::ExitCode;
use stream::mcap::Reader;

fn main() -> ExitCode {
    cli::run("dem-measure", measure_run)
}

fn measure_run(args: Args) -> anyhow::Result<Report> {
    let (what, mut observer) = choose::observer(&args)?;
    if let Some(file) = &args.plot {
        plot::check_name(file).map_err(|e| cli::usage(format!("--plot {e}")))?;
    }
    let place = || format!("{}: {what}", args.run);
    let solids = solids::Solids::of(&args)?;
    let source = args.run.open()?;
    let mut sheet = solids.sheet(&args, &what)?;
    // Rows are kept only where they are drawn: a run may be longer than the memory.
    let (mut run, mut rows, mut kept): (Run, Vec<Row>, Vec<Row>) = Default::default();
    let progress = Progress::new("frames", 0);
    for event in Reader::new(source) {
        let event = args.run.as_far_as_it_goes(event).with_context(|| args.run.to_string())?;
        let Some(event) = event else { break };
        if let Some(message) = run.take(event).with_context(place)? {
            progress.add(u64::from(matches!(message, measure::RunMessage::Frame(_))));
            observer.observe(&run, message, &mut rows).with_context(place)?;
            sheet.as_mut().map_or(Ok(()), |sheet| sheet.rows(&observer.heads(), &rows))?;
            kept.append(&mut if args.plot.is_some() { std::mem::take(&mut rows) } else { Vec::new() });
            rows.clear();
        }
    }
    drop(progress);
    run.ending.warning().iter().for_each(|warning| cli::warn(&format!("{}: {warning}", args.run)));
    let summary = observer.end(&run, &mut rows).with_context(place)?;
    let count = match sheet {
        Some(sheet) => sheet.finish(&observer.heads(), &rows, &summary)?,
        None => solids.write(&args, observer.as_ref()).map(|()| rows.len() as u64)?,
    };
    kept.append(&mut rows);
    if let Some(file) = &args.plot {
        let chart = plot::chart(file, &observer.chart(&kept)).map_err(|e| anyhow!("--plot {e}"))?;
        cli::OutputStream::write_file(file, &chart)?;
    }
    Ok(report(&what, count, &summary))
}

fn report(what: &str, rows: u64, summary: &Summary) -> Report {
    let shown = |(head, value): &(measure::Head, f64)| {
        let unit = if head.unit == "1" { String::new() } else { format!(" {}", head.unit) };
        format!("{} {}{unit}", head.name, geom::Shown(*value))
    };
    let known = summary.values.iter().filter(|(_, value)| value.is_finite());
    let mut line: Vec<String> = known.take(5).map(shown).collect();
    line.extend(summary.notes.iter().cloned());
    let report = Report::new(format!("{what}: {}; {}", geom::counted(rows, "row"), line.join(", ")))
        .with("rows", rows);
    let report = report.with("measure", what).with("notes", &summary.notes);
    summary.values.iter().fold(report, |report, (head, value)| report.with(&head.name, value))
}
