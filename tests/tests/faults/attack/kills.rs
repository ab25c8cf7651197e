//! Pipes whose partners are killed: what is left under a final name must be the whole output.

use super::case::{Outcome, Verdict, WAIT};
use super::{Findings, files};
use crate::samples;
use grainpipe_tests::tools::program;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Pipes; the last program writes `out`.
const PIPES: &[&[&str]] = &[
    &[
        "cloud-crop cloud.xyz --keep box:-9,-9,-9,9,9,9",
        "cloud-fill",
        "bluenoise-sample --spacing 0.02",
        "wallgen --roughness 0.001 -o out",
    ],
    &["dem-run long.toml --threads 1", "stage-replay", "dem-run inlet.toml - --until 0.2 --threads 1 -o out"],
];

/// A pipe at work.
fn start(folder: &Path, pipe: &[&str]) -> Vec<Child> {
    let mut children: Vec<Child> = Vec::new();
    for (k, call) in pipe.iter().enumerate() {
        let mut words = call.split(' ');
        let mut command = Command::new(program(words.next().expect("a tool")));
        command.args(words).arg("-q").current_dir(folder);
        let input = children.last_mut().and_then(|c| c.stdout.take());
        command.stdin(input.map_or_else(Stdio::null, Stdio::from));
        command.stdout(if k + 1 < pipe.len() { Stdio::piped() } else { Stdio::null() });
        command.stderr(File::create(folder.join(format!("stderr.{k}"))).expect("created"));
        children.push(command.spawn().expect("the tool starts"));
    }
    children
}

/// A folder with the inputs of the pipes.
fn inputs(folder: &Path) {
    for (name, bytes) in files::others() {
        fs::write(folder.join(name), bytes).expect("written");
    }
    let long = samples::scene().replace("count = 3", "count = 9").replace("until = 0.012", "until = 0.2");
    fs::write(folder.join("long.toml"), long.replace("0.035\"", "0.3\"")).expect("written");
    let point = |k: u32| format!("{} {} 0\n", 0.002 * f64::from(k % 300), 0.002 * f64::from(k / 300));
    fs::write(folder.join("cloud.xyz"), (0..90_000).map(point).collect::<String>()).expect("written");
}

/// Kills one partner of a pipe, `count` times for each pipe, at times spread over the pipe's own.
///
/// # Panics
/// When a pipe that is left alone fails.
pub fn run(seed: u64, count: usize, found: &mut Findings) {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    for pipe in PIPES {
        let folder = tempfile::tempdir().expect("a folder");
        inputs(folder.path());
        let begun = Instant::now();
        let well = start(folder.path(), pipe).iter_mut().all(|c| c.wait().is_ok_and(|s| s.success()));
        assert!(well, "{pipe:?}: {:?}", fs::read_to_string(folder.path().join("stderr.0")));
        let (whole, lasts) = (fs::read(folder.path().join("out")).expect("written"), begun.elapsed());
        for _ in 0..count {
            let _ = fs::remove_file(folder.path().join("out"));
            let (victim, share) = (rng.random_range(0..pipe.len()), rng.random_range(0.0..1.0));
            let mut children = start(folder.path(), pipe);
            std::thread::sleep(lasts.mul_f64(share));
            let _ = children[victim].kill();
            let (ends, done) = finish(&mut children);
            let left = fs::read(folder.path().join("out")).ok();
            let outcome = match left {
                _ if !done => Outcome::TimedOut,
                Some(bytes) if bytes != whole => Outcome::LeftOutput,
                None if ends.iter().all(|ok| *ok) => Outcome::Mute,
                Some(_) => Outcome::Accepted,
                None => Outcome::Refused,
            };
            let name = format!("{} after {share:.3} of its time: {}", pipe.join(" | "), pipe[victim]);
            found.add("kills of a pipe's partner", name, Verdict { outcome, message: String::new() });
        }
    }
}

/// Whether each program succeeded, and whether all ended in time.
fn finish(children: &mut [Child]) -> (Vec<bool>, bool) {
    let start = Instant::now();
    while start.elapsed() < WAIT {
        if children.iter_mut().all(|c| c.try_wait().is_ok_and(|s| s.is_some())) {
            return (children.iter_mut().map(|c| c.wait().is_ok_and(|s| s.success())).collect(), true);
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    children.iter_mut().for_each(|c| drop(c.kill()));
    (Vec::new(), false)
}
