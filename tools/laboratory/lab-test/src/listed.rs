//! The specimens that are not finished, as lines of a shell.

use crate::args::Args;
use crate::outputs;
use anyhow::Context;
use cli::Report;
use lab::recipes::Loading;
use lab::{Lab, Stresses};
use std::path::Path;
use stream::quoted;

/// Options that each line has its own of.
const OWN: [&str; 4] = ["--stress=", "--seed=", "--seeds=", "--jobs-file="];

/// Writes a line for each specimen. A specimen that a guard stops is one of the results, and no failure of its line.
pub fn write(file: &Path, args: &Args, lab: &Lab, open: &[&Loading]) -> anyhow::Result<()> {
    let program = std::env::current_exe().context("cannot find out where this program is")?;
    let here = std::env::current_dir().context("the current folder")?;
    let [program, here] = [program, here].map(|path| quoted(&path.display().to_string()));
    let mut words = vec![quoted(lab.recipe().name()), quoted(&args.sample.to_string())];
    let is_common = |a: &String| a.starts_with("--") && !OWN.iter().any(|own| a.starts_with(own));
    words.extend(cli::arguments().iter().filter(|a| is_common(a)).map(|argument| quoted(argument)));
    // Where the command line names outputs, they are no arguments of the result: the folder is what the lines have in common.
    words.extend(args.dir.as_ref().map(|dir| quoted(&format!("--dir={}", dir.display()))));
    let common = words.join(" ");
    let line = |loading: &&Loading| {
        let own = own(args, lab, loading).join(" ");
        format!("cd {here} && {{ {program} {common} {own} -q --threads 1 -o /dev/null || [ $? = 3 ]; }}\n")
    };
    outputs::bytes_to(file, open.iter().map(line).collect::<String>().as_bytes())
}

/// Stress and seed of one specimen.
fn own(args: &Args, lab: &Lab, loading: &Loading) -> Vec<String> {
    let stresses = match lab.recipe().stresses().0 {
        Stresses::Each => &loading.path,
        _ => &args.stress,
    };
    let all: Vec<String> = stresses.iter().map(|stress| format!("{stress:?}")).collect();
    let stress = (!all.is_empty()).then(|| format!("--stress={}", all.join(",")));
    stress.into_iter().chain(lab.is_random().then(|| format!("--seed={}", loading.seed))).collect()
}

/// What is left to do.
pub fn report(open: &[&Loading]) -> Report {
    let summary = geom::counted_as(open.len(), "specimen", ["is", "are"])
        + " open: run what is open, then give the same command again";
    Report::new(summary).with("open", open.len())
}
