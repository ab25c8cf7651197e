//! The report, the sentences as Markdown, and the lines of `--print-commands`.

use cli::Report;
use curve::sweep::script::SweepRun;
use curve::{Choice, Judged};
use std::collections::BTreeMap;
use stream::quoted;

/// A line to run each of the runs.
pub fn commands(open: &[&SweepRun]) -> String {
    let line = |job: &&SweepRun| {
        let script = job.file("run.sh");
        let script = quoted(&std::path::absolute(&script).unwrap_or(script).display().to_string());
        format!("bash {script}  # {}\n", job.dem_run())
    };
    open.iter().map(line).collect()
}

/// The sentences as a list, the advice in bold.
pub fn markdown(judged: &Judged, words: &[String]) -> String {
    let line = |line: &String| match Some(line) == judged.advice().as_ref() {
        true => format!("- **{line}**\n"),
        false => format!("- {line}\n"),
    };
    words.iter().map(line).collect()
}

/// The report of `runs` runs, of which `kept` were made before.
pub fn report(judged: &Judged, runs: usize, kept: usize) -> Report {
    let failed = judged.points.iter().filter(|p| p.failed.is_some()).count();
    let summary = format!(
        "{} points, {runs} runs, {kept} of them made before, {failed} points failed",
        judged.points.len()
    );
    let setting = |k: usize| judged.points[k].setting.iter().cloned().collect::<BTreeMap<String, String>>();
    let recommended = match judged.choice {
        Some(Choice::Point(k)) => Some(setting(k)),
        _ => None,
    };
    Report::new(summary)
        .with("points", judged.points.len())
        .with("runs", runs)
        .with("kept", kept)
        .with("failed", failed)
        .with("reference", judged.marks.0.map(setting))
        .with("in_use", judged.marks.1.map(setting))
        .with("recommended", recommended)
        .with("words", judged.words())
}
