//! Every option of every tool, read from its `--help`, with each of fourteen values.

use super::case::Case;
use super::{files, folders, values};
use crate::samples;
use grainpipe_tests::tools::tool;
use std::path::Path;

/// A call of each tool that succeeds, to which options are added.
pub const CALLS: &[(&str, &str)] = &[
    ("cloud-crop", "ascii.ply -o out.ply"),
    ("cloud-fill", "ascii.ply -o out.ply"),
    ("bluenoise-sample", "ascii.ply --spacing 0.01 -o out.ply"),
    ("wallgen", "ascii.ply --roughness 0.001 -o out.ply"),
    ("dem-run", "scene.toml --until 0.002 -o out.mcap"),
    ("dem-view", "run.mcap -o out.png"),
    ("dem-measure", "run.mcap --energy"),
    ("dem-measure", "run.mcap --flow 0,0,0.02,0,0,-1"),
    ("dem-measure", "run.mcap --profile"),
    ("dem-measure", "run.mcap --repose"),
    ("stage-split", "scene.toml --at 0,0,0.03,0,0,-1 --keep upstream -o out.toml"),
    ("stage-replay", "run.mcap -o out.mcap"),
    ("chute-scan", "--points 100 -o out.ply"),
];

/// An option, and whether it takes a value.
pub struct Flag {
    /// `--name`.
    pub name: String,
    /// Whether a value follows.
    pub takes_value: bool,
}

/// What a tool's help lists, without what ends the tool at once or names an output.
pub fn flags(name: &str) -> Vec<Flag> {
    let help = String::from_utf8_lossy(&tool(Path::new("."), name, &["--help"]).stdout).into_owned();
    let mut found = Vec::new();
    for line in help.lines().map(str::trim_start).filter(|l| l.starts_with('-')) {
        let Some(at) = line.find("--").filter(|&at| at <= 4) else { continue };
        let name = line[at..].split(|c: char| c.is_whitespace() || c == '=').next().unwrap_or_default();
        let takes_value = line[at + name.len()..].trim_start_matches(['=', ' ']).starts_with('<');
        let name = name.trim_end_matches([',', ')']).to_owned();
        if !["--help", "--version", "--output", "--report", "--threads"].contains(&name.as_str()) {
            found.push(Flag { name, takes_value });
        }
    }
    found
}

/// A file of a case: its name and bytes.
type CaseFile = (String, Vec<u8>);

/// The files of a call of a tool.
pub fn files_of(tool: &str, shared: &[CaseFile], examples: &[CaseFile]) -> Vec<CaseFile> {
    if CALLS.iter().any(|call| call.0 == tool) { shared.to_vec() } else { folders::of(examples, tool) }
}

/// A call of a tool that succeeds.
pub struct Call {
    /// The tool.
    pub tool: &'static str,
    /// Its arguments.
    pub args: Vec<String>,
    /// The files that it reads.
    pub files: Vec<CaseFile>,
}

/// A call of each tool that succeeds, with its files.
///
/// # Panics
/// When the files cannot be made.
pub fn calls() -> Vec<Call> {
    let mut shared = files::others();
    let run = samples::mcap().into_iter().find(|s| s.0 == "run.mcap").expect("a run").1;
    shared.push(("run.mcap".into(), run));
    let examples = folders::files();
    let one = |&(tool, call): &(&'static str, &str)| {
        let args = call.split(' ').map(str::to_owned).collect();
        Call { tool, args, files: files_of(tool, &shared, &examples) }
    };
    CALLS.iter().chain(folders::CALLS).map(one).collect()
}

/// All cases: tools × options × values.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for Call { tool, args: call, files } in calls() {
        for Flag { name, takes_value } in flags(tool) {
            let values = if takes_value { values::OPTION.map(Some).to_vec() } else { vec![None] };
            for value in values {
                let mut args = call.clone();
                // A second --spacing would be refused as a second one.
                if let Some(at) = args.iter().position(|a| *a == name) {
                    args.drain(at..(at + 2).min(args.len()));
                }
                args.push(value.map_or(name.clone(), |v| format!("{name}={v}")));
                cases.push(Case {
                    group: "options",
                    tool,
                    args,
                    files: files.clone(),
                    change: String::new(),
                    memory: None,
                });
            }
        }
    }
    cases
}
