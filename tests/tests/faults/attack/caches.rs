//! Results that are kept: an input that was changed is never answered with the result of the old one.

use super::Findings;
use super::case::{Outcome, Verdict, bounded, write};
use crate::samples;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;
use std::fs;
use std::path::Path;

/// Files of a study: a scene, and grains that it names by a name with a blank.
fn files() -> Vec<(String, Vec<u8>)> {
    let scene = samples::scene();
    let (scene, _) = scene.split_once("[[outlet]]").unwrap_or((&scene, ""));
    let (head, rest) = scene.split_once("[[fill]]").unwrap_or((scene, ""));
    let wall = rest.split_once("[[wall]]").map_or("", |(_, wall)| wall);
    let scene =
        format!("{head}[[particles]]\nsource = \"my grains.csv\"\nmaterial = \"sinter\"\n[[wall]]{wall}");
    let grains = "x,y,z,radius,vz\n0.010,0.010,0.021,0.002,-0.5\n0.016,0.010,0.031,0.002,-0.5\n0.013,0.015,0.027,0.002,-0.5\n";
    vec![("s.toml".into(), scene.into_bytes()), ("my grains.csv".into(), grains.into())]
}

const CALL: &str = "s.toml --vary safety=0.3 --measure bed-height --ground 0 --exact 0.01 --work steps --dir kept -o out.svg";

fn answer(folder: &Path) -> (bool, String, String) {
    let args: Vec<String> = CALL.split(' ').map(str::to_owned).collect();
    let (status, stderr) = bounded(folder, "", None, "cost-curve", &args);
    (
        status.is_some_and(|s| s.success()),
        fs::read_to_string(folder.join("stdout")).unwrap_or_default(),
        stderr,
    )
}

/// `count` changes of one digit of an input between two calls: the second must say what a call in a new folder says.
pub fn run(seed: u64, count: usize, found: &mut Findings) {
    let verdicts = (0..count as u64).into_par_iter().map(|k| one(seed.wrapping_mul(1000) + k)).collect();
    found.all("caches", verdicts);
}

fn one(seed: u64) -> (String, Verdict) {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let [first, fresh] = [0; 2].map(|_| tempfile::tempdir().expect("a folder"));
    let mut files = files();
    write(first.path(), &files);
    let before = answer(first.path());
    let which = rng.random_range(0..files.len());
    let bytes = &mut files[which].1;
    let digits: Vec<usize> = (0..bytes.len()).filter(|&k| bytes[k].is_ascii_digit()).collect();
    let at = digits[rng.random_range(0..digits.len())];
    bytes[at] = b'0' + (bytes[at] - b'0' + rng.random_range(1..10u8)) % 10;
    for folder in [&first, &fresh] {
        write(folder.path(), &files);
    }
    let (again, anew) = (answer(first.path()), answer(fresh.path()));
    let outcome = match (&again, &anew) {
        // A call that fails has kept nothing.
        (a, b) if !a.0 && !b.0 => Outcome::Refused,
        (a, b) if a.0 == b.0 && a.1 == b.1 => Outcome::Accepted,
        _ => Outcome::Stale,
    };
    let name = format!("cost-curve {CALL}   # byte {at} of {} changed (before {})", files[which].0, before.0);
    (name, Verdict::new(outcome, &again.2))
}
