//! Every option of every tool, in each of its forms: what `--help` lists stands in an example, and every example runs.

mod examples;
pub mod files;
mod overwritten;
mod shapes;
mod unused;

use examples::{EXAMPLES, FORMS};
use files::inputs;
use grainpipe_tests::tools::{line, program};
use grainpipe_tests::written::note;
use std::collections::BTreeSet;
use std::process::Command;

/// An option as `--help` lists it.
#[derive(Debug)]
struct Listed {
    /// `--name`.
    long: String,
    /// `-n`, of those that have one.
    short: Option<String>,
    /// How many forms its value has: `<M|FILE.toml>` has two.
    forms: usize,
    /// Values that it takes, where they are listed.
    values: Vec<String>,
}

/// The help of a tool, unbroken.
fn help(tool: &str) -> String {
    let done =
        Command::new(program(tool)).arg("--help").env("COLUMNS", "100000").output().expect("it starts");
    assert!(done.status.success());
    String::from_utf8(done.stdout).expect("text")
}

fn listed(help: &str) -> Vec<Listed> {
    let mut all: Vec<Listed> = Vec::new();
    for row in help.lines().map(str::trim) {
        if row.starts_with("--") || (row.starts_with('-') && row[2..].starts_with(", --")) {
            let (short, rest) = match row.split_once(", --") {
                Some((short, rest)) if short.len() == 2 => (Some(short.to_owned()), rest),
                _ => (None, &row[2..]),
            };
            let name: String = rest.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '-').collect();
            let value = rest[name.len()..].strip_prefix(" <").and_then(|value| value.split('>').next());
            let forms = value.map_or(1, |value| value.split('|').count());
            all.push(Listed { long: format!("--{name}"), short, forms, values: Vec::new() });
        }
        let Some(last) = all.last_mut() else { continue };
        if let Some(value) = row.strip_prefix("- ").and_then(|rest| rest.split_once(':')) {
            last.values.push(value.0.to_owned());
        }
        if let Some((_, values)) = row.split_once("[possible values: ") {
            last.values.extend(values.trim_end_matches(']').split(", ").map(str::to_owned));
        }
        if let Some((_, alias)) = row.split_once("[alias: ") {
            let long = alias.trim_end_matches(']').to_owned();
            all.push(Listed { long, short: None, forms: 1, values: Vec::new() });
        }
    }
    all
}

/// The options of the examples of a tool, each with its value where the next word is no option.
fn used(tool: &str) -> Vec<(String, String)> {
    let lines = EXAMPLES.iter().filter(|l| l.split(' ').next() == Some(tool));
    let words = |line: &&str| line.split(' ').map(str::to_owned).collect::<Vec<_>>();
    lines
        .map(words)
        .flat_map(|words| {
            let next = words.iter().skip(1).cloned().chain([String::new()]).collect::<Vec<_>>();
            words.into_iter().zip(next).filter(|(word, _)| word.starts_with('-')).collect::<Vec<_>>()
        })
        .collect()
}

#[test]
fn every_option_has_an_example_in_each_of_its_forms() {
    let tools: BTreeSet<&str> = EXAMPLES.iter().filter_map(|line| line.split(' ').next()).collect();
    let all = grainpipe_tests::tree::tools();
    assert_eq!(all, tools.iter().map(|tool| (*tool).to_owned()).collect(), "every tool has examples");
    let mut missing = Vec::new();
    for tool in &tools {
        let (used, options) = (used(tool), listed(&help(tool)));
        assert!(options.len() > 7, "{tool}: {options:?}");
        for option in options.iter().filter(|o| !["--help", "--version"].contains(&o.long.as_str())) {
            let is = |name: &str| name == option.long || Some(name) == option.short.as_deref();
            let values: BTreeSet<&str> = used.iter().filter(|u| is(&u.0)).map(|u| u.1.as_str()).collect();
            let names = [Some(&option.long), option.short.as_ref()].into_iter().flatten();
            let unused = names.filter(|name| !used.iter().any(|u| u.0 == **name));
            missing.extend(unused.map(|name| format!("{tool} {name}")));
            let forms =
                option.forms + FORMS.iter().find(|f| f.0 == *tool && f.1 == option.long).map_or(0, |f| f.2);
            if values.len() < forms {
                missing.push(format!("{tool} {}: {} of {forms} forms", option.long, values.len()));
            }
            let not = option.values.iter().filter(|value| !values.contains(value.as_str()));
            missing.extend(not.map(|value| format!("{tool} {} {value}", option.long)));
        }
    }
    assert!(missing.is_empty(), "without an example in every_option/examples.rs: {missing:#?}");
}

#[test]
fn every_example_runs() {
    let folder = inputs();
    let mut printed = Vec::new();
    let wrong = |line_: &&str| {
        let done = line(folder.path(), line_);
        printed.push(((*line_).to_owned(), done.stdout));
        (done.code != 0 || done.stderr.contains("panicked"))
            .then(|| format!("{line_}: {}: {}", done.code, done.stderr))
    };
    let lammps = files::lammps();
    let runs = |line: &&&str| lammps || !line.starts_with("dem-lammps");
    let wrong: Vec<String> = EXAMPLES.iter().filter(runs).filter_map(wrong).collect();
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), EXAMPLES.len(), wrong.join("\n"));
    note("options", folder.path(), &printed);
}

#[test]
fn help_and_version_are_short_and_long() {
    let tools: BTreeSet<&str> = EXAMPLES.iter().filter_map(|line| line.split(' ').next()).collect();
    for tool in tools {
        for option in ["-h", "--help", "-V", "--version"] {
            let done = Command::new(program(tool)).arg(option).output().expect("it starts");
            let text = String::from_utf8_lossy(&done.stdout).into_owned();
            let version = option.eq_ignore_ascii_case("-v") || option == "--version";
            let wanted = if version { format!("{tool} 0.") } else { "Usage: ".to_owned() };
            assert!(done.status.success() && text.contains(&wanted), "{tool} {option}: {text}");
        }
    }
}
