//! Every example of every tool with every further option of that tool.

use super::super::{example_files, examples};
use super::answer::REPORT;
use super::call::{Call, Grammar};
use super::{Findings, Shop, Trial, run};
use grainpipe_tests::tools::line;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Options that only steer how a tool runs, what it prints meanwhile, and where its output goes.
const STEERS: &[&str] =
    &["-o", "--output", "--report", "-q", "--quiet", "--threads", "--progress", "--jobs", "--dir", "--color"];

/// Options that may change nothing: tool, option, why.
pub const FREE: &[(&str, &str, &str)] = &[
    ("bluenoise-sample", "--distance", "on a flat cloud both distances are one"),
    ("bluenoise-sample", "--seed", "--method eliminate draws only among very many points"),
    ("cloud-crop", "--columns", "--check may count the same"),
    ("cloud-crop", "--regions", "its shapes may hold what others keep anyway"),
    ("cloud-crop", "--scale", "--check may count the same"),
    ("cloud-crop", "--tolerance", "a check that finds nothing"),
    ("cloud-crop", "--units", "the unit that the file has anyway"),
    ("dem-lammps", "--lmp", "names the program that runs anyway"),
    ("dem-lammps", "--until", "with --read-dump it must be where the dump ends"),
    ("dem-measure", "--all", "names the default of measures over time"),
    ("dem-measure", "--from", "the beginning of the run"),
    ("dem-measure", "--last", "names the default of measures of one frame"),
    ("dem-measure", "--up", "against gravity, which is the default"),
    ("dem-measure", "--wall", "the examples have one wall"),
    ("dem-view", "--components", "a precaution: acts in pages that are too large"),
    ("stage-replay", "--intervals", "the default is the only one for recorded paths"),
    ("stage-replay", "--keep-times", "the examples begin at time 0"),
    ("stage-replay", "--outlet", "the examples have one outlet"),
    ("stage-replay", "--passage", "the default is the only one for recorded paths"),
    ("stone-clump", "--material", "names the default"),
    ("stone-pack", "--bonded", "names the default"),
    ("stone-pack", "--tolerance", "every try may be too heavy for any of them"),
    ("wallgen", "--flow-at", "names the side that a closed drawing has anyway"),
    ("wallgen", "--largest-particle", "a check that finds nothing"),
    ("wallgen", "--place", "is what follows from the flow side"),
    ("wallgen", "--smallest-particle", "a check that finds nothing"),
    ("wallgen", "--units", "the unit that the file has anyway"),
];

/// Values besides those of the examples, some of which give the default or what the inputs have anyway.
const VALUES: &[(&str, &str)] = &[
    ("--scale", "0.5"),
    ("--units", "mm"),
    ("--seed", "5"),
    ("--colour", "x"),
    ("--color", "x"),
    ("--keep", "box:-1,-1,-1,0.1,1,1"),
    ("--keep", "box:0.05,0.05,-1,1,1,1"),
    ("--columns", "x,z,y"),
    ("--remove", "box:-1,-1,-1,0.1,1,1"),
    ("--outer", "box:-1,-1,-1,0.1,1,1"),
    ("--tolerance", "0.001"),
    ("--largest", "0.002"),
    ("--up", "1,0,0"),
    ("--ground", "0.01"),
    ("--from", "0.003"),
    ("--until", "0.003"),
    ("--until", "0.00001"),
    ("--set", "time.until=0.00001"),
    ("--to", "0.003"),
    ("--time", "0.002"),
    ("--within", "box:0,0,0,0.05,0.05,0.02"),
    ("--within", "box:-1,-1,-1,1,1,0.02"),
    ("--within", "box:0,0,0,0.1,0.1,0.06"),
    ("--axis", "0,0,0,1,0,0"),
    ("--at", "0,0,0.021,0,0,-1"),
    ("--blind", "0.4"),
    ("--overlap", "0.1"),
    ("--min-radius", "0.003"),
    ("--min-radius", "0.006"),
    ("--min-radius", "0.01"),
    ("--least-grains", "60"),
    ("--smallest-particle", "0.001"),
    ("--largest-particle", "10"),
];

/// Runs every `one_in`-th case; `only` names tools, or options, those that may change nothing included.
///
/// # Panics
/// When an example fails.
pub fn find(one_in: usize, only: &[&str], found: &mut Findings) {
    let tools: BTreeSet<&str> = examples::EXAMPLES.iter().filter_map(|line| line.split(' ').next()).collect();
    let grammar = Grammar::of(tools.into_iter().map(str::to_owned));
    let calls: Vec<Call> = examples::EXAMPLES.iter().map(|line| grammar.parse(line)).collect();
    let shop = shop(&calls);
    let mut bases: Vec<Call> = Vec::new();
    let (options, tools): (Vec<&str>, Vec<&str>) = only.iter().partition(|name| name.starts_with("--"));
    let chosen = calls.iter().filter(|call| tools.is_empty() || tools.contains(&call.tool.as_str()));
    let whole: Vec<Call> = chosen.filter_map(base).collect();
    let least: Vec<Call> = whole.par_iter().step_by(one_in).map(|call| reduced(&shop, call)).collect();
    for call in whole.into_iter().chain(least) {
        if !bases.contains(&call) {
            bases.push(call);
        }
    }
    let values = values(&calls);
    let cases = bases.iter().flat_map(|base| trials(base, &values[&base.tool], &options));
    run(&shop, cases.step_by(one_in).collect(), found);
}

/// A folder in which the examples have run.
fn shop(calls: &[Call]) -> Shop {
    let folder = example_files::inputs();
    let names = |folder: &Path| -> BTreeSet<String> {
        let entries = std::fs::read_dir(folder).expect("a folder").flatten();
        entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect()
    };
    let mut inputs = names(folder.path());
    for example in examples::EXAMPLES {
        let done = line(folder.path(), example);
        // A film in MP4 is packed by a program that is not on every machine.
        assert!(done.code == 0 || done.stderr.contains("ffmpeg"), "{example}: {}", done.stderr);
    }
    let made = names(folder.path());
    let read =
        calls.iter().flat_map(|c| c.reads.iter().cloned().chain(c.value("--resume").map(str::to_owned)));
    inputs.extend(read.filter(|name| made.contains(name)));
    Shop { folder, inputs, unseen: &[] }
}

/// A call as a base: without what only steers it, and with an output in a separate file.
fn base(call: &Call) -> Option<Call> {
    let mut base = call.clone();
    let output = call.value("-o").or(call.value("--output")).map(str::to_owned);
    base.options.retain(|(name, _)| !STEERS.contains(&name.as_str()));
    if call.has("--no-measures") {
        base = base.with("--report", Some(REPORT));
    }
    if let Some(output) = output {
        let ending = Path::new(&output).extension()?.to_string_lossy().into_owned();
        base = base.with("-o", Some(&format!("made.{ending}")));
    }
    Some(base)
}

/// The same with as few options as it needs. A film keeps its size: with that of the default it would take as long as a hundred other calls.
fn reduced(shop: &Shop, call: &Call) -> Call {
    let mut least = call.clone();
    let film = call.value("-o").is_some_and(|file| file.ends_with(".gif") || file.ends_with(".mp4"));
    let kept = |name: &str| name == "-o" || film && name == "--size";
    for (name, _) in call.options.iter().filter(|(name, _)| !kept(name)) {
        let mut fewer = least.clone();
        fewer.options.retain(|o| o.0 != *name);
        if shop.answer(&fewer).code == 0 {
            least = fewer;
        }
    }
    least
}

/// Values of each option of each tool in the examples.
fn values(calls: &[Call]) -> BTreeMap<String, BTreeMap<String, BTreeSet<Option<String>>>> {
    let mut found: BTreeMap<String, BTreeMap<String, BTreeSet<Option<String>>>> = BTreeMap::new();
    for call in calls {
        let of_tool = found.entry(call.tool.clone()).or_default();
        for (name, value) in call.options.iter().filter(|o| !STEERS.contains(&o.0.as_str())) {
            let values = of_tool.entry(name.clone()).or_default();
            values.insert(value.clone());
            values.extend(VALUES.iter().filter(|v| v.0 == name).map(|v| Some(v.1.to_owned())));
        }
    }
    found
}

/// A base with each further option.
fn trials(base: &Call, values: &BTreeMap<String, BTreeSet<Option<String>>>, only: &[&str]) -> Vec<Trial> {
    let free = |name: &str| match only {
        [] => FREE.iter().any(|f| f.0 == base.tool && f.1 == name),
        only => !only.contains(&name),
    };
    let further = values.iter().filter(|(name, _)| !base.has(name) && !free(name));
    let trial = |(name, values): (&String, &BTreeSet<Option<String>>)| Trial {
        group: "further options",
        added: name.clone(),
        base: base.clone(),
        more: values.iter().map(|value| base.with(name, value.as_deref())).collect(),
    };
    further.map(trial).collect()
}
