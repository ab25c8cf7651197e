//! What fuzzing has found, kept: files that claim more than they hold are refused before anybody makes room for it.

use crate::samples;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::scenes::folder;
use std::error::Error;

const CLAIMS: Case = case("Faults", "a file that claims more than it holds is refused and takes no memory");

/// An error and its causes.
fn said(error: &dyn Error) -> String {
    let (mut text, mut cause) = (error.to_string(), error.source());
    while let Some(error) = cause {
        text += &format!(": {error}");
        cause = error.source();
    }
    text
}

fn cloud(bytes: Vec<u8>) -> String {
    said(&cloud::from_bytes(bytes).expect_err("refused"))
}

fn sample(list: Vec<samples::Sample>, name: &str) -> Vec<u8> {
    list.into_iter().find(|s| s.0 == name).expect("a sample").1
}

/// The place of a text.
fn place(bytes: &[u8], text: &[u8]) -> usize {
    bytes.windows(text.len()).position(|window| window == text).expect("it is there")
}

/// Its table of chunks claimed 4 294 967 295 of them, 69 GB.
#[test]
fn laz_with_too_many_chunks() {
    let mut bytes = sample(samples::las(), "3.laz");
    let number = |at: usize| bytes[at..at + 4].iter().rev().fold(0, |n, &b| (n << 8) | usize::from(b));
    let table = number(number(96));
    bytes[table + 4..table + 8].fill(0xff);
    CLAIMS.refused("LAZ: chunks", &cloud(bytes), &["4294967295 chunks", "damaged"]);
}

/// A layer of a chunk claimed 4 GB, for each of the ten that format 7 has.
#[test]
fn laz_with_a_layer_longer_than_the_file() {
    let whole = sample(samples::las(), "7.laz");
    let points = whole[96..100].iter().rev().fold(0, |n, &b| (n << 8) | usize::from(b));
    // The place of the table, a point of 36 bytes as it is, and how many there are stand before the lengths.
    let lengths = points + 8 + 36 + 4;
    for layer in 0..10 {
        let mut bytes = whole.clone();
        bytes[lengths + 4 * layer..][..4].fill(0xff);
        CLAIMS.refused("LAZ: layers", &cloud(bytes), &["layers of 42949", "chunk 0", "damaged"]);
    }
}

/// The time of its points is for ever one of another sequence: its reader called itself until the program was ended.
#[test]
fn laz_whose_times_have_no_end() {
    let mut file = include_bytes!("times.laz").to_vec();
    // Scales that are none are refused before.
    file[131..155].copy_from_slice(&[0.01f64; 3].map(f64::to_le_bytes).concat());
    // So are more chunks than its points fill: a chunk has 1000 points, in the record behind the header.
    file[227 + 54 + 12..][..4].copy_from_slice(&1000u32.to_le_bytes());
    let said = cloud(file);
    CLAIMS.refused("LAZ: times", &said, &["does not belong to any sequence", "damaged"]);
    // The same in layers, where an overwritten sector says the same.
    let whole = sample(samples::las(), "7.laz");
    let points = whole[96..100].iter().rev().fold(0, |n, &b| (n << 8) | usize::from(b));
    let lengths = points + 8 + 36 + 4;
    let length = |layer: usize| {
        let at = lengths + 4 * layer;
        whole[at..at + 4].iter().rev().fold(0, |n, &b| (n << 8) | usize::from(b))
    };
    let times = lengths + 4 * 10 + (0..8).map(length).sum::<usize>();
    let mut bytes = whole[..times].to_vec();
    bytes[lengths + 4 * 8..][..4].copy_from_slice(&4096u32.to_le_bytes());
    bytes.extend([255; 4096]);
    bytes.extend(&whole[times + length(8)..]);
    let table = u64::from_le_bytes(whole[points..points + 8].try_into().expect("8 bytes"));
    let table = table + 4096 - length(8) as u64;
    bytes[points..points + 8].copy_from_slice(&table.to_le_bytes());
    CLAIMS.refused("LAZ: times in layers", &cloud(bytes), &["times of chunk 0", "damaged"]);
}

/// An extended record claimed 2⁶⁴ − 1 bytes: its reader ended the program.
#[test]
fn las_with_an_extended_record_longer_than_the_file() {
    for name in ["7.las", "7.laz"] {
        let mut bytes = sample(samples::las(), name);
        let start = bytes.len() as u64;
        bytes[235..243].copy_from_slice(&start.to_le_bytes());
        bytes[243..247].copy_from_slice(&1u32.to_le_bytes());
        bytes.extend([0; 60]);
        let claim = start as usize + 20;
        bytes[claim..claim + 8].fill(0xff);
        CLAIMS.refused(
            &format!("{name}: records"),
            &cloud(bytes.clone()),
            &["extended record", "0 are left", "damaged"],
        );
        bytes[claim..claim + 8].fill(0);
        assert!(cloud::from_bytes(bytes).is_ok(), "{name}: an empty record is no fault");
    }
}

/// Items of 65 535 bytes, of which each would have its own tables.
#[test]
fn laz_with_items_larger_than_its_points() {
    let mut bytes = sample(samples::las(), "7.laz");
    // Kind 11, colours of 6 bytes, version 3.
    let at = place(&bytes, &[11, 0, 6, 0, 3, 0]);
    bytes[at..at + 4].copy_from_slice(&[14, 0, 255, 255]);
    CLAIMS.refused("LAZ: items", &cloud(bytes), &["65565 bytes", "points of 36 bytes", "damaged"]);
}

#[test]
fn pcd_that_unpacks_to_more_than_it_can_hold() {
    let whole = sample(samples::pcd(), "packed.pcd");
    let at = place(&whole, b"binary_compressed\n") + 18;
    for (field, word) in [(at, "cut off"), (at + 4, "cannot hold")] {
        let mut bytes = whole.clone();
        bytes[field..field + 4].fill(0x7f);
        CLAIMS.refused("PCD: sizes of packed data", &cloud(bytes), &["PCD", word]);
    }
    let text = String::from_utf8(sample(samples::pcd(), "ascii.pcd")).expect("text");
    let text = text.replace("COUNT 1 1 1 1", "COUNT 1 1 1 4000000000");
    CLAIMS.refused("PCD: values of a field", &cloud(text.into_bytes()), &["PCD"]);
}

/// Texts of metadata, channels and schemas, in and out of chunks.
#[test]
fn mcap_with_a_text_longer_than_its_record() {
    let whole = sample(samples::mcap(), "walls.mcap");
    for (text, before) in [(&b"provenance"[..], 4), (b"arguments", 4), (b"end_of_stream", 4)] {
        let mut bytes = whole.clone();
        let at = place(&bytes, text) - before;
        bytes[at..at + 4].fill(0x7f);
        let error = stream::mcap::Reader::new(&bytes[..]).find_map(Result::err).expect("refused");
        CLAIMS.refused("MCAP: texts", &said(&error), &["a text reaches over the end of its record"]);
    }
}

/// A stream whose first chunk holds packed bytes that unpack to `whole` bytes.
fn with_a_chunk(packed: &[u8], whole: u64) -> Vec<u8> {
    let mut chunk = [0u64.to_le_bytes(), 0u64.to_le_bytes(), whole.to_le_bytes()].concat();
    chunk.extend(0u32.to_le_bytes());
    chunk.extend(4u32.to_le_bytes());
    chunk.extend(b"zstd");
    chunk.extend((packed.len() as u64).to_le_bytes());
    chunk.extend(packed);
    let walls = sample(samples::mcap(), "walls.mcap");
    // Behind the magic stands the header record: opcode, length, content.
    let header = 8 + 9 + u64::from_le_bytes(walls[9..17].try_into().expect("8 bytes")) as usize;
    let mut bytes = walls[..header].to_vec();
    bytes.push(6);
    bytes.extend((chunk.len() as u64).to_le_bytes());
    bytes.extend(chunk);
    bytes
}

/// A few bytes of Zstandard that unpack to 256 MB of zeros, and a megabyte that unpacks to a hundred.
#[test]
fn mcap_with_a_chunk_that_unpacks_without_end() {
    let zeros = std::io::Read::take(std::io::repeat(0), 1 << 28);
    let few = zstd::stream::encode_all(zeros, 1).expect("packed");
    let mut state = 1u32;
    let mut noise = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    let mut thin = Vec::new();
    for _ in 0..1000 {
        thin.extend((0..1000).map(|_| noise()));
        thin.resize(thin.len() + 99_000, 0);
    }
    let many = zstd::stream::encode_all(&thin[..], 1).expect("packed");
    assert!((1_000_000..1_500_000).contains(&many.len()), "{} bytes", many.len());
    for (packed, whole) in [(few, 1 << 28), (many, thin.len() as u64)] {
        let bytes = with_a_chunk(&packed, whole);
        let error = stream::mcap::Reader::new(&bytes[..]).find_map(Result::err).expect("refused");
        CLAIMS.refused("MCAP: a chunk of zeros", &said(&error), &["64 times its own size"]);
    }
}

/// A text in a state that claimed 21 GB, behind a hash that is right.
#[test]
fn state_with_a_text_longer_than_itself() {
    let state = stream::state::encode(&(5u64 << 32, 0u64)).expect("encoded");
    let error = stream::state::decode::<String>(&state).expect_err("refused");
    CLAIMS.refused("checkpoint: texts", &said(&error), &["state", "not what this program expects"]);
}

/// A first line of nothing but commas was a panic.
#[test]
fn particles_without_names() {
    let folder = folder(&[("p.csv", ",\n1,2\n")]);
    let toml = "[time]\nuntil = 1\n[[material]]\nname = \"a\"\ndensity = 1\nyoung = 1e7\npoisson = 0.2\n\
                [[contact]]\nbetween = [\"*\", \"*\"]\nrestitution = 0.5\n[[particles]]\nmaterial = \"a\"\nsource = \"p.csv\"\n";
    let scene = scene::Scene::new("s.toml", toml.to_owned(), &[], folder.path()).expect("sound");
    let error = scene.plan(Vec::new()).err().expect("refused");
    CLAIMS.refused("particles: a line without names", &said(&error), &["p.csv", "line of names"]);
}

/// Its reader gives up with a panic; what a user sees is one line.
#[test]
fn laz_that_its_reader_gives_up_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let whole = sample(samples::las(), "3.laz");
    let mut quiet = 0u32;
    for at in (200..whole.len()).step_by(40) {
        let mut bytes = whole.clone();
        bytes[at..(at + 4).min(whole.len())].fill(0xff);
        std::fs::write(folder.path().join("x.laz"), bytes).expect("written");
        let done = grainpipe_tests::tools::tool(folder.path(), "cloud-crop", &["x.laz", "-o", "x.ply"]);
        // What can be read all the same may be warned of besides.
        let short = done.code == 0 || done.stderr.lines().count() == 1;
        quiet += u32::from(short && !done.stderr.contains("panicked") && done.code < 2);
    }
    let files = (200..whole.len()).step_by(40).count() as u32;
    CLAIMS.within(
        "LAZ: damaged, files with a message of more than one line",
        f64::from(files - quiet),
        "files",
        0.0,
    );
}
