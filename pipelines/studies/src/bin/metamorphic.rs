//! Draws random scenes and asks each the same question in other words:
//! `metamorphic [--scenes N] [--seed N] [--from N] [--relation WORDS] [--dem-run PATH] [--keep FOLDER] [--threads N] [--page PAGE.md]`;
//! `metamorphic --scene FOLDER --relation WORDS [--number N]` asks a scene that was kept, and leaves the runs in its folder.

use grainpipe_tests::metamorphic::answer::{Runner, SCENE};
use grainpipe_tests::metamorphic::campaign::{self, Case, Findings, Verdict, random};
use grainpipe_tests::metamorphic::relations::{RELATIONS, Relation};
use grainpipe_tests::metamorphic::scene::Scene;
use grainpipe_tests::metamorphic::{page, shrink};
use grainpipe_tests::tools::program;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::{env, fs, io};

/// Words behind options.
struct Options(Vec<String>);

impl Options {
    fn text(&self, name: &str) -> Option<String> {
        let at = self.0.iter().position(|a| a == name);
        at.and_then(|k| self.0.get(k + 1)).cloned()
    }

    fn number(&self, name: &str, default: u64) -> u64 {
        self.text(name).and_then(|v| v.parse().ok()).unwrap_or(default)
    }

    /// Whether a relation is asked.
    fn chooses(&self, relation: &Relation) -> bool {
        self.text("--relation").is_none_or(|words| relation.name.contains(&words))
    }
}

fn main() -> io::Result<ExitCode> {
    let options = Options(env::args().skip(1).collect());
    let runner =
        Runner { program: options.text("--dem-run").map_or_else(|| program("dem-run"), PathBuf::from) };
    let runner = Runner { program: fs::canonicalize(runner.program)? };
    if let Some(folder) = options.text("--scene") {
        return show(&runner, &options, &PathBuf::from(folder));
    }
    let mut found = all(&runner, &options);
    if let Some(folder) = options.text("--keep") {
        keep(&runner, &mut found, &PathBuf::from(folder))?;
    }
    let words = page::summary(&found, options.number("--seed", 1));
    println!("{words}");
    for (words, count) in &found.refused {
        println!("refused {count} × {words}");
    }
    if let Some(file) = options.text("--page") {
        fs::write(file, words)?;
    }
    Ok(if found.failures.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn all(runner: &Runner, options: &Options) -> Findings {
    let found = Mutex::new(Findings::default());
    let (first, seed) = (options.number("--from", 0), options.number("--seed", 1));
    let next = AtomicU64::new(first);
    let end = first + options.number("--scenes", 200);
    std::thread::scope(|scope| {
        for _ in 0..options.number("--threads", 2) {
            scope.spawn(|| {
                loop {
                    let k = next.fetch_add(1, Ordering::Relaxed);
                    if k >= end {
                        break;
                    }
                    let part =
                        campaign::ask(runner, seed * 1_000_000 + k, &|relation| options.chooses(relation));
                    for failure in &part.failures {
                        eprintln!("scene {k}, {}: {}", failure.relation.name, failure.words);
                    }
                    found.lock().expect("no thread panicked").add(part);
                }
            });
        }
    });
    found.into_inner().expect("no thread panicked")
}

/// Writes the smallest scene of each failure, and prints the command that shows it.
fn keep(runner: &Runner, found: &mut Findings, folder: &std::path::Path) -> io::Result<()> {
    for failure in &mut found.failures {
        shrink::shrink(runner, failure);
        let name = failure.relation.name.replace(|c: char| !c.is_alphanumeric(), "-");
        let folder = folder.join(format!("{name}-{}", failure.seed));
        failure.scene.write(&folder, SCENE)?;
        let command = format!(
            "metamorphic --scene {} --relation '{}' --number {} --dem-run {}",
            folder.display(),
            failure.relation.name,
            failure.seed,
            runner.program.display()
        );
        fs::write(folder.join("difference.txt"), format!("{}\n{command}\n", failure.words))?;
        eprintln!("{}\n  {command}", failure.words);
    }
    Ok(())
}

fn show(runner: &Runner, options: &Options, folder: &std::path::Path) -> io::Result<ExitCode> {
    let scene = Scene::read(folder, SCENE)?;
    let case = match Case::in_folder(runner, scene, folder.to_owned()) {
        Ok(case) => case,
        Err(refusal) => {
            println!("{}", refusal.words);
            return Ok(ExitCode::FAILURE);
        }
    };
    let mut status = ExitCode::SUCCESS;
    for relation in RELATIONS.iter().filter(|relation| options.chooses(relation)) {
        let verdict = relation.asks(&case, &mut random(options.number("--number", 1), relation.name));
        if matches!(verdict, Some(Verdict::Differs(_))) {
            status = ExitCode::FAILURE;
        }
        println!("{}: {verdict:?}", relation.name);
    }
    Ok(status)
}
