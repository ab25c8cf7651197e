//! Writes what fuzzing begins with: `fuzz_seeds FOLDER` makes a folder for each target of `fuzz/`.

#[path = "../../../../tests/tests/faults/samples.rs"]
mod samples;

use samples::Sample;
use std::path::Path;
use std::{env, fs, io};

/// Folders of the targets, and what each begins with.
fn corpora() -> Vec<(&'static str, Vec<Sample>)> {
    let texts = |words: &[&str]| {
        samples::texts().into_iter().filter(|s| words.iter().any(|w| s.0.contains(w))).collect::<Vec<_>>()
    };
    let mcap = samples::mcap();
    let of = |names: &[&str]| mcap.iter().filter(|s| names.contains(&s.0)).cloned().collect::<Vec<_>>();
    let mut meshes = samples::ply();
    meshes.retain(|s| s.0.contains("mesh"));
    let mut particles = [texts(&[".csv"]), of(&["run.mcap"]), samples::ply()].concat();
    particles.retain(|s| s.1.len() < 1 << 16);
    vec![
        ("ply", samples::ply()),
        ("las", samples::las()),
        ("e57", samples::e57()),
        ("pcd", samples::pcd()),
        ("xyz", samples::xyz()),
        ("checkpoint", vec![("body", body(&of(&["run.mcap"])))]),
        ("replay", of(&["run.mcap", "bonded.mcap"])),
        ("measures", of(&["run.mcap"])),
        ("scene", texts(&["scene.toml"])),
        ("regions", texts(&["regions", "roughness", "prism"])),
        ("options", texts(&[".txt"])),
        ("mesh", meshes),
        ("particles", particles),
        ("mcap", mcap),
    ]
}

/// The body of the last checkpoint of a run: pieces behind their first byte, joined, without the head.
fn body(runs: &[Sample]) -> Vec<u8> {
    let mut state = Vec::new();
    for event in stream::mcap::Reader::new(&runs[0].1[..]).flatten() {
        let stream::mcap::Event::Bytes { topic, data, .. } = event else { continue };
        if topic == record::topic::CHECKPOINT {
            if state.starts_with(b"GRNSTATE") && data.get(1..9) == Some(b"GRNSTATE") {
                state.clear();
            }
            state.extend_from_slice(&data[1..]);
        }
    }
    state.split_off(52)
}

fn main() -> io::Result<()> {
    let to = env::args().nth(1).unwrap_or_else(|| "fuzz/corpus".to_owned());
    for (target, samples) in corpora() {
        let folder = Path::new(&to).join(target);
        fs::create_dir_all(&folder)?;
        for (name, bytes) in samples {
            println!("{target}/{name}: {} B", bytes.len());
            fs::write(folder.join(name), bytes)?;
        }
    }
    Ok(())
}
