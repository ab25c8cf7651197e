//! Attacks the tools and writes docs/evidence/reliability.md: `attack FILES KILLS SEED [PAGE.md]`;
//! `attack short _ SEED` makes a part of each kind in minutes and writes no page;
//! `attack silent [options|keys] [ONE_IN] [TOOL…] [--OPTION…]` only lists silent options and keys, or those named.

#[path = "../../../../tests/tests/faults/attack/mod.rs"]
mod attack;
#[path = "../../../../tests/tests/faults/samples.rs"]
mod samples;

use attack::{
    Findings, caches, files, kills, limits, modes, names, options, remedies, scenes, signals, silent,
};
use std::path::Path;
use std::{env, fs, io};

/// A part of the attack, and its name.
type Part<'a> = (&'static str, &'a dyn Fn(&mut Findings));

fn main() -> io::Result<()> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let number = |k: usize, default| arguments.get(k).and_then(|a| a.parse().ok()).unwrap_or(default);
    let (drawn, killed, seed) = (number(0, 15_000), number(1, 100), number(2, 1));
    let mut found = Findings::default();
    if arguments.first().is_some_and(|a| a == "silent") {
        let only: Vec<&str> = arguments.iter().skip(3).map(String::as_str).collect();
        silent::find(arguments.get(1).map(String::as_str), number(2, 1), &only, &mut found);
        print!("{}\n{}", found.table(), found.list());
        return Ok(());
    }
    // What was found so far is printed after each part: the whole takes up to an hour.
    // `attack short` makes a part of each kind, and no page.
    let short = arguments.first().is_some_and(|a| a == "short");
    let (one_in, drawn, killed) = if short { (10, 1000, 5) } else { (1, drawn, killed) };
    let some = |cases: Vec<attack::case::Case>| cases.into_iter().step_by(3 * one_in - 2).collect::<Vec<_>>();
    let parts: [Part; 11] = [
        ("names", &|found| names::run(one_in, found)),
        ("modes", &|found| modes::run(one_in, found)),
        ("remedies", &|found| remedies::run(5 * one_in - 4, found)),
        ("signals", &|found| signals::run(seed as u64, killed, found)),
        ("caches", &|found| caches::run(seed as u64, killed, found)),
        ("files", &|found| found.run(files::cases(seed as u64, drawn))),
        ("keys", &|found| found.run(some(scenes::cases()))),
        ("options", &|found| found.run(some(options::cases()))),
        ("memory", &|found| found.run(some(limits::cases()))),
        ("kills", &|found| kills::run(seed as u64, killed, found)),
        ("silent", &|found| silent::find(None, 1 + 20 * (one_in - 1), &[], found)),
    ];
    for (name, part) in parts {
        part(&mut found);
        eprintln!(
            "attack: {name}: {} cases so far, {} bad\n{}",
            found.count(),
            found.bad.len(),
            found.list()
        );
    }
    let page = format!("{HEAD}{} cases, seed {seed}:\n\n{}{TAIL}", found.count(), found.table());
    print!("{page}");
    let Some(file) = arguments.get(3) else { return Ok(()) };
    fs::write(file, page + &rest(file))?;
    overview(file, found.count())
}

/// The number of cases in the line of overview.md, beside the page, that links it.
fn overview(page: &str, count: usize) -> io::Result<()> {
    let file = Path::new(page).with_file_name("overview.md");
    if !file.exists() {
        return Ok(());
    }
    let text = fs::read_to_string(&file)?;
    let Some((before, rest)) = text.split_once("killed programs: ") else { return Ok(()) };
    let Some((_, after)) = rest.split_once(" cases |") else { return Ok(()) };
    fs::write(&file, format!("{before}killed programs: {} {:03} cases |{after}", count / 1000, count % 1000))
}

/// Parts of the page that other programs write: they follow the first heading of the second level.
fn rest(file: &str) -> String {
    let old = fs::read_to_string(file).unwrap_or_default();
    old.find("\n## ").map_or_else(String::new, |at| old[at..].to_owned())
}

const HEAD: &str = "# Reliability

What the tools do with damaged files, absurd values, hostile names, signals and killed partners. `make -C pipelines attack` runs the attack and writes this page; `cargo test` runs a short form with
another seed.

Each case is one call of a tool. It may take 1.5 GB of address space and 20 seconds of processor time, and its files have a few kilobytes.

";

const TAIL: &str = "
| column | meaning |
|---|---|
| accepted | exit 0 and whole output. Clouds, meshes and walls in it are read again, and have finite coordinates |
| refused | exit 1, 2 or 3 with a message |
| panic, killed, too long | the program failed to control itself: a bug. Too long is also a program that has not ended after five minutes on the clock |
| no message | failed without a word |
| half output | failed, and left output under its final name that looks whole |
| not finite | succeeded with output that holds NaN or infinity |
| raw text | the message has control characters, which a terminal would obey |
| silent | an option was accepted, changed nothing, and nothing said so; an output that is protected was replaced |
| unquoted | a name became a command, or broke the output |
| no remedy | what a message proposes was done, and did not help |
| stale | a result of other inputs was used again |

**Files**: one word or line of a text, or one number, record or length of a binary file is changed, with checksums that are right again. So the damage reaches the code behind the
checksums. **Keys and options**: every key of the tables of [scene.md](../reference/scene.md) and every option of `--help`, each with 14 values such as `nan`, `1e308`, an empty text, a device or a terminal's control
sequence. **Further options**: every example of every tool (`tests/tests/tools/every_option`), whole and with as few options as it needs, with each further option of that tool that an example has. It counts as
accepted if the output or what the tool prints changes with one of its values. Left out are options that only steer how a tool runs (threads, names of outputs), those listed with a reason in
`tests/tests/faults/attack/silent/options.rs`, and calls whose output holds times. **Further keys**: every key of every scene of the test of keys (`tests/tests/tools/every_key`), left out where the scene runs
without it, and with the values that it has in other scenes, half and twice its numbers. What a run repeats of its scene is not compared. **Memory**: a call of every tool within each of 14 limits of address space, from less than a program needs to start. **Names**: 80 names that mean something to a shell, LAMMPS, TOML, CSV, HTML or a terminal, as names of materials, walls, clumps, titles and files, in 12 calls that write them. **Users and modes**: every call that names an output, where the output is protected, a folder or a link, where folder or inputs are another user's, where nothing can be written, and with two masks of rights. **Signals**: every call gets INT, TERM, HUP or QUIT at a random time; nothing half done has a final name, nothing hidden is left, the exit code is 128 + signal, or 3 of what ends in order. **Printed remedies**: keys and options with letters left out, doubled and exchanged; the name that the message proposes is tried. **Caches**: a digit of an input is changed between two calls of `cost-curve` that share a folder; the second must give what a call in a new folder gives. **Kills**: one program of a pipe gets SIGKILL at a random time. Output under the final name must then be the whole output.
";
