//! Attacks the tools and writes docs/reliability.md: `attack FILES KILLS SEED [PAGE.md]`;
//! `attack silent [options|keys] [ONE_IN] [TOOL…] [--OPTION…]` only lists silent options and keys, or those named.

#[path = "../../../../tests/tests/faults/attack/mod.rs"]
mod attack;
#[path = "../../../../tests/tests/faults/samples.rs"]
mod samples;

use attack::{Findings, files, kills, limits, options, scenes, silent};
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
    let parts: [Part; 6] = [
        ("files", &|found| found.run(files::cases(seed as u64, drawn))),
        ("keys", &|found| found.run(scenes::cases())),
        ("options", &|found| found.run(options::cases())),
        ("memory", &|found| found.run(limits::cases())),
        ("kills", &|found| kills::run(seed as u64, killed, found)),
        ("silent", &|found| silent::find(None, 1, &[], found)),
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
    arguments.get(3).map_or(Ok(()), |file| fs::write(file, page + &rest(file)))
}

/// Parts of the page that other programs write: they follow the first heading of the second level.
fn rest(file: &str) -> String {
    let old = fs::read_to_string(file).unwrap_or_default();
    old.find("\n## ").map_or_else(String::new, |at| old[at..].to_owned())
}

const HEAD: &str = "# Reliability

What the tools do with damaged files, absurd values and killed partners. `make -C pipelines attack` runs the attack and writes this page; `cargo test` runs a short form with
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
| silent | an option was accepted, changed nothing, and nothing said so |

**Files**: one word or line of a text, or one number, record or length of a binary file is changed, with checksums that are right again. So the damage reaches the code behind the
checksums. **Keys and options**: every key of the tables of [scene.md](scene.md) and every option of `--help`, each with 14 values such as `nan`, `1e308`, an empty text, a device or a terminal's control
sequence. **Further options**: every example of every tool (`tests/tests/tools/every_option`), whole and with as few options as it needs, with each further option of that tool that an example has. It counts as
accepted if the output or what the tool prints changes with one of its values. Left out are options that only steer how a tool runs (threads, names of outputs), those listed with a reason in
`tests/tests/faults/attack/silent/options.rs`, and calls whose output holds times. **Further keys**: every key of every scene of the test of keys (`tests/tests/tools/every_key`), left out where the scene runs
without it, and with the values that it has in other scenes, half and twice its numbers. What a run repeats of its scene is not compared. **Memory**: a call of every tool within each of 14 limits of address space, from less than a program needs to start. **Kills**: one program of a pipe gets SIGKILL at a random time. Output under the final name must then be the whole output.
";
