//! Draws random scenes and asks each the same question in other words: `metamorphic [--scenes N] [--seed N] [--from N] [--relation WORDS]
//! [--dem-run PATH] [--keep FOLDER] [--threads N] [--page PAGE.md]`.

use grainpipe_tests::metamorphic::answer::Runner;
use grainpipe_tests::metamorphic::campaign::{self, Findings};
use grainpipe_tests::metamorphic::{page, shrink};
use grainpipe_tests::tools::program;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let option = |name: &str| {
        let at = arguments.iter().position(|a| a == name);
        at.and_then(|k| arguments.get(k + 1)).cloned()
    };
    let number = |name: &str, default: u64| option(name).and_then(|v| v.parse().ok()).unwrap_or(default);
    let (scenes, seed, threads) = (number("--scenes", 200), number("--seed", 1), number("--threads", 2));
    let only = option("--relation");
    let runner = Runner { program: option("--dem-run").map_or_else(|| program("dem-run"), PathBuf::from) };
    let found = Mutex::new(Findings::default());
    let next = AtomicU64::new(number("--from", 0));
    let end = next.load(Ordering::Relaxed) + scenes;
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let k = next.fetch_add(1, Ordering::Relaxed);
                    if k >= end {
                        break;
                    }
                    let part = campaign::ask(&runner, seed * 1_000_000 + k, &|r| only.as_ref().is_none_or(|o| r.name.contains(o)));
                    for failure in &part.failures {
                        eprintln!("seed {k}, {}: {}", failure.relation.name, failure.words);
                    }
                    found.lock().expect("no thread panicked").add(part);
                }
            });
        }
    });
    let mut found = found.into_inner().expect("no thread panicked");
    if let Some(folder) = option("--keep") {
        for failure in &mut found.failures {
            shrink::shrink(&runner, failure);
            let name = failure.relation.name.replace(|c: char| !c.is_alphanumeric(), "-");
            let folder = PathBuf::from(&folder).join(format!("{name}-{}", failure.seed));
            failure.scene.write(&folder, "scene.toml")?;
            let words = format!("{}\n{}\n", failure.relation.name, failure.words);
            fs::write(folder.join("difference.txt"), words)?;
            eprintln!("{}: {}", folder.display(), failure.words);
        }
    }
    println!("{} scenes, {} refused", found.scenes, found.refusals());
    for (words, count) in &found.refused {
        println!("  {count} × {words}");
    }
    println!("{}", page::table(&found));
    Ok(())
}
