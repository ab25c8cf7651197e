//! Files that were cut or changed: an error or, where the bytes still mean something, a clean result; never a panic.
//!
//! Seeds are fixed, so that a run of the tests is the same every time; `make -C pipelines fuzz` goes on from the same files with
//! a million inputs for each parser.

use crate::samples::{self, Sample};
use grainpipe_tests::findings::{Case, case};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::io::Cursor;

const CUT: Case = case("Faults", "a truncated file is refused, wherever it ends");
const FLIPPED: Case = case("Faults", "a changed byte in a run, walls or a checkpoint is refused");
const SOUND: Case = case("Faults", "no changed byte in any format causes a panic");

/// What reads a file; whether it took it for whole.
type Parser = fn(&[u8]) -> bool;

fn events(bytes: &[u8]) -> bool {
    let events = stream::mcap::Reader::new(bytes).all(|event| event.is_ok());
    let checkpoint = run::Checkpoint::last("run", bytes).is_ok();
    let input = scene::Input::open("input", Box::new(Cursor::new(bytes.to_vec()))).is_ok();
    events || (checkpoint && input)
}

fn cloud(bytes: &[u8]) -> bool {
    cloud::from_bytes(bytes.to_vec()).is_ok()
}

fn mesh(bytes: &[u8]) -> bool {
    cloud::read_mesh(&mut &bytes[..]).is_ok()
}

fn text(bytes: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else { return false };
    let (set, toml) = text.split_once('\n').unwrap_or(("", text));
    let here = std::path::Path::new("");
    let none = |_: &str| Err("no meshes here".to_owned());
    let material = record::MaterialRecord { name: "steel".to_owned(), ..Default::default() };
    let mut rules = cloud::crop::Rules::default();
    scene::Scene::new("s.toml", toml.to_owned(), &[set.to_owned()], here).is_ok()
        | geom::prism::Prism::from_json(text).is_ok()
        | cloud::crop::add_regions(&mut rules, text, here).is_ok()
        | wall::Regions::parse(text, material, geom::Vec3::zeros(), &none, &|_| Ok(text.to_owned())).is_ok()
        | geom::Shape::parse(text, &none).is_ok()
        | text.parse::<geom::Plane>().is_ok()
}

/// Every sample with what reads it.
fn all() -> Vec<(Parser, Sample)> {
    let with = |parser: Parser, samples: Vec<Sample>| samples.into_iter().map(move |s| (parser, s));
    let clouds = [samples::ply(), samples::las(), samples::e57(), samples::pcd(), samples::xyz()].concat();
    let meshes = samples::ply().into_iter().filter(|s| s.0.contains("mesh")).collect();
    let mut texts = samples::texts();
    texts.retain(|s| s.0 != "grains.csv");
    with(cloud, clouds)
        .chain(with(mesh, meshes))
        .chain(with(events, samples::mcap()))
        .chain(with(text, texts))
        .collect()
}

fn runner(cases: u32) -> TestRunner {
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
}

/// Each sample is read as it is, so that what follows is no test of empty files.
#[test]
fn every_sample_is_whole() {
    for (parser, (name, bytes)) in all() {
        assert!(parser(&bytes), "{name}");
    }
}

/// MCAP, LAS, E57, binary PLY and PCD; a text that is cut may still mean something.
#[test]
fn binary_files_that_are_cut_anywhere_are_refused() {
    let binary = ["mcap", "las", "laz", "e57", "binary.ply", "big.ply", "binary.pcd", "packed.pcd"];
    let samples: Vec<_> =
        all().into_iter().filter(|(_, s)| binary.iter().any(|b| s.0.ends_with(b))).collect();
    let mut taken = Vec::new();
    for (parser, (name, bytes)) in &samples {
        let step = (bytes.len() / 150).max(1);
        let cuts = (0..bytes.len()).step_by(step).chain(bytes.len().saturating_sub(20)..bytes.len());
        taken.extend(
            cuts.filter(|&at| parser(&bytes[..at]))
                .map(|at| format!("{name} cut at {at} of {}", bytes.len())),
        );
    }
    println!("{taken:?}");
    CUT.within(&format!("{} files of all binary formats", samples.len()), taken.len() as f64, "cuts", 0.0);
}

#[test]
fn a_changed_byte_in_mcap_is_refused() {
    let mut taken = 0u32;
    let files: Vec<Sample> = samples::mcap();
    for (name, bytes) in &files {
        let flips = (0..bytes.len(), 0..8u8);
        let result = runner(400).run(&flips, |(at, bit)| {
            let mut bad = bytes.clone();
            bad[at] ^= 1 << bit;
            let whole = stream::mcap::Reader::new(&bad[..]).all(|event| event.is_ok());
            prop_assert!(!whole || same(&bad, bytes), "{name}: bit {bit} of byte {at}");
            Ok(())
        });
        if let Err(error) = result {
            println!("{error}");
            taken += 1;
        }
    }
    FLIPPED.within("400 changes in each of 4 files", f64::from(taken), "files", 0.0);
}

/// Whether two streams hold the same: some bytes, such as those of an index, are never looked at.
fn same(a: &[u8], b: &[u8]) -> bool {
    let events = |bytes| stream::mcap::Reader::new(bytes).map(|e| e.ok()).collect::<Vec<_>>();
    events(a) == events(b)
}

/// Up to four changes at once: single bits, whole bytes, numbers that are as large as they can be, cuts.
#[test]
fn no_changed_file_ends_in_a_panic() {
    let mut panics = Vec::new();
    let samples = all();
    let count = samples.len();
    for (parser, (name, bytes)) in samples {
        let edits = prop::collection::vec((0..bytes.len(), 0..4u8, any::<u8>()), 1..5);
        let result = runner(80).run(&edits, |edits| {
            let mut bad = bytes.clone();
            edits.into_iter().for_each(|edit| change(&mut bad, edit));
            let ended = std::panic::catch_unwind(|| parser(&bad));
            prop_assert!(ended.is_ok(), "{name}");
            Ok(())
        });
        panics.extend(result.err().map(|e| e.to_string()));
    }
    println!("{panics:?}");
    SOUND.within(&format!("80 changed copies of each of {count} files"), panics.len() as f64, "files", 0.0);
}

fn change(bytes: &mut Vec<u8>, (at, how, value): (usize, u8, u8)) {
    let at = at.min(bytes.len().saturating_sub(1));
    match how {
        0 => bytes.iter_mut().skip(at).take(1).for_each(|b| *b ^= 1 << (value % 8)),
        1 => bytes.iter_mut().skip(at).take(1).for_each(|b| *b = value),
        2 => bytes.iter_mut().skip(at).take(4).for_each(|b| *b = if value % 2 == 0 { 0xff } else { 0 }),
        _ => bytes.truncate(at + usize::from(value)),
    }
}
