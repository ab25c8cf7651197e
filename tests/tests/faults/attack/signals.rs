//! Every tool with a signal at a random time: nothing half done has a final name, nothing hidden is left, and the exit code is the same in all tools.

use super::Findings;
use super::case::{Outcome, Verdict, bounded, write};
use super::options::{Call, calls};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::ExitStatus;
use std::time::Instant;

/// Signals, and whether a tool may end in order after them.
const SIGNALS: [(&str, i32); 4] = [("INT", 2), ("TERM", 15), ("HUP", 1), ("QUIT", 3)];
/// Exit code of a tool that ended in order.
const STOPPED: i32 = 3;

/// The files of a folder by their names.
pub type Files = BTreeMap<String, Vec<u8>>;

/// Files in a folder and below, with their bytes.
pub fn held(folder: &Path) -> Files {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(&next).into_iter().flatten().flatten() {
            let path = entry.path();
            let name = path.strip_prefix(folder).unwrap_or(&path).to_string_lossy().into_owned();
            if path.is_dir() {
                folders.push(path);
            } else if path.exists() {
                found.insert(name, fs::read(&path).unwrap_or_default());
            }
        }
    }
    found.retain(|name, _| name != "stdout" && name != "stderr");
    found
}

/// What became of a call that got a signal; `inputs` are the files before, `whole` those after a call that got none.
fn judge(
    status: Option<ExitStatus>,
    signal: i32,
    folder: &Path,
    (inputs, whole): (&Files, &Files),
) -> Outcome {
    let Some(code) = status.and_then(|s| s.code()) else { return Outcome::Killed };
    let after = held(folder);
    if inputs.iter().any(|(name, bytes)| after.get(name) != Some(bytes)) {
        return Outcome::LeftOutput;
    }
    let made = || after.iter().filter(|(name, _)| !inputs.contains_key(*name));
    let hidden = |name: &str| name.rsplit('/').next().is_some_and(|name| name.starts_with('.'));
    // A core that cannot be written leaves nothing; QUIT is no polite signal, but it is caught.
    if made().any(|(name, _)| hidden(name)) {
        return Outcome::LeftOutput;
    }
    // Folders of runs and trials hold what goes on; a long run keeps its part.
    let same = |(name, bytes): (&String, &Vec<u8>)| {
        whole.get(name) == Some(bytes) || name.ends_with(".part") || !name.starts_with("out")
    };
    match code {
        0 => Outcome::Accepted,
        STOPPED => Outcome::Refused,
        code if code == 128 + signal && made().all(same) => Outcome::Refused,
        code if code == 128 + signal => Outcome::LeftOutput,
        _ => Outcome::Panicked,
    }
}

/// `count` signals for each call of each tool, at times over one and a half of the call's own.
pub fn run(seed: u64, count: usize, found: &mut Findings) {
    let all: Vec<Vec<(String, Verdict)>> =
        calls().into_par_iter().enumerate().map(|(k, call)| one(&call, seed + k as u64, count)).collect();
    all.into_iter().for_each(|verdicts| found.all("signals", verdicts));
}

fn one(call: &Call, seed: u64, count: usize) -> Vec<(String, Verdict)> {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), &call.files);
    let (inputs, begun) = (held(folder.path()), Instant::now());
    let (status, stderr) = bounded(folder.path(), "", None, call.tool, &call.args);
    let lasts = begun.elapsed().as_secs_f64();
    // A call that only serves to add options to it may lack one that it needs.
    if !status.is_some_and(|s| s.success()) {
        return vec![(name_of(call), Verdict::new(Outcome::Refused, &stderr))];
    }
    let whole = held(folder.path());
    let mut verdicts = Vec::new();
    for n in 0..count {
        let ((name, number), after) = (SIGNALS[n % SIGNALS.len()], lasts * rng.random_range(0.0..1.5));
        let folder = tempfile::tempdir().expect("a folder");
        write(folder.path(), &call.files);
        // Under nohup and in some shells these are ignored, which children inherit.
        let before = format!(
            "exec env --default-signal=HUP,INT,QUIT timeout --preserve-status -k 60 -s {name} {after:.4}"
        );
        let before = format!("f() {{ {before} \"$@\"; }}; f \"$0\" \"$@\";");
        let (status, stderr) = bounded(folder.path(), &before, None, call.tool, &call.args);
        let outcome = judge(status, number, folder.path(), (&inputs, &whole));
        let name = format!("{}   # SIG{name} after {after:.4} s", name_of(call));
        verdicts.push((name, Verdict::new(outcome, &stderr)));
    }
    verdicts
}

fn name_of(call: &Call) -> String {
    format!("{} {}", call.tool, call.args.join(" "))
}
