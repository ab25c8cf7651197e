//! Attacks the tools and writes docs/reliability.md: `attack FILES KILLS SEED [PAGE.md]`.

#[path = "../../../../tests/tests/faults/attack/mod.rs"]
mod attack;
#[path = "../../../../tests/tests/faults/samples.rs"]
#[expect(dead_code, reason = "the fuzz seeds use the other samples")]
mod samples;

use attack::case::Outcome;
use attack::{Findings, files, kills, options, scenes};
use std::fmt::Write;
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let number = |k: usize, default| arguments.get(k).and_then(|a| a.parse().ok()).unwrap_or(default);
    let (drawn, killed, seed) = (number(0, 15_000), number(1, 100), number(2, 1));
    let mut found = Findings::default();
    found.run(files::cases(seed as u64, drawn));
    found.run(scenes::cases());
    found.run(options::cases());
    kills::run(seed as u64, killed, &mut found);
    let page = page(&found, seed);
    print!("{page}");
    for (name, verdict) in &found.bad {
        println!("{:?}: {name}\n    {}", verdict.outcome, verdict.message);
    }
    arguments.get(3).map_or(Ok(()), |file| fs::write(file, page))
}

/// The page: what was tried, and a row for each kind of case.
fn page(found: &Findings, seed: usize) -> String {
    let mut page = HEAD.to_owned();
    let titles = [
        "accepted",
        "refused",
        "panic",
        "killed",
        "too long",
        "no message",
        "half output",
        "not finite",
        "raw text",
    ];
    let _ = writeln!(page, "{} cases, seed {seed}:\n", found.count());
    let _ = writeln!(page, "| what | cases | {} |", titles.join(" | "));
    let _ = writeln!(page, "|---|{}", "---:|".repeat(titles.len() + 1));
    for (group, totals) in &found.totals {
        let cells = Outcome::ALL.map(|o| totals.get(&o).copied().unwrap_or(0).to_string());
        let _ = writeln!(page, "| {group} | {} | {} |", totals.values().sum::<usize>(), cells.join(" | "));
    }
    page + TAIL
}

const HEAD: &str = "# Reliability

What the tools do with damaged files, absurd values and killed partners. `make -C pipelines attack` runs the attack and writes this page; `cargo test` runs a short form with
another seed.

Each case is one call of a tool. It may take 1.5 GB of address space and 20 seconds, and its files have a few kilobytes.

";

const TAIL: &str = "
| column | meaning |
|---|---|
| accepted | exit 0 and whole output. Clouds, meshes and walls in it are read again, and have finite coordinates |
| refused | exit 1, 2 or 3 with a message |
| panic, killed, too long | the program failed to control itself: a bug |
| no message | failed without a word |
| half output | failed, and left output under its final name that looks whole |
| not finite | succeeded with output that holds NaN or infinity |
| raw text | the message has control characters, which a terminal would obey |

**Files**: one word or line of a text, or one number, record or length of a binary file is changed, with checksums that are right again. So the damage reaches the code behind the
checksums. **Keys and options**: every key of the tables of [scene.md](scene.md) and every option of `--help`, each with 14 values such as `nan`, `1e308`, an empty text, a device or a terminal's control
sequence. **Kills**: one program of a pipe gets SIGKILL at a random time. Output under the final name must then be the whole output.
";
