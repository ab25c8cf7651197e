//! The program of the GPU is that of these sources, and computes as a processor does.

use super::PTX;
use dem::device::functions;
use sha2::{Digest, Sha256};
use std::fs;
use std::path::{Path, PathBuf};

/// What the head of the program says before the hash of its sources.
const HEAD: &str = "// SHA-256 of the sources: ";

/// Files that no GPU runs anything of.
const NOT_THERE: [&str; 8] =
    ["messages", "table", "contact_history", "registry", "shown", "aligned", "x86", "x86_single"];

/// The sources that the program is made of, in order.
fn sources() -> Vec<PathBuf> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    for folder in ["kernels/src", "../gpu/src", "../laws/src", "../../base/primitives/src"] {
        below(&here.join(folder), &mut files);
    }
    files.sort();
    ["kernels/Cargo.toml", "kernels/Makefile"].map(|name| here.join(name)).into_iter().chain(files).collect()
}

/// The sources in a folder and below that a GPU runs something of.
fn below(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() {
            below(&path, files);
        } else if !NOT_THERE.contains(&stem.as_str()) {
            files.push(path);
        }
    }
}

/// A hash of their code: comments, blank lines and tests do not count.
fn hash() -> String {
    let mut hash = Sha256::new();
    for file in sources() {
        let text = fs::read_to_string(&file).expect("text");
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        for line in code.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//")) {
            hash.update(line.as_bytes());
        }
    }
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
fn it_is_that_of_the_sources() {
    let head = format!("{HEAD}{}\n", hash());
    if let Some(new) = std::env::var_os("GRAINPIPE_NEW_PTX") {
        let text = fs::read_to_string(&new).expect("what the compiler made");
        let text = format!(
            "{head}// Made by `make -C crates/engine/cuda/kernels`.\n{}",
            text.trim_start_matches("//\n")
        );
        let to = Path::new(env!("CARGO_MANIFEST_DIR")).join("kernels.ptx");
        return fs::write(to, text).expect("to be written");
    }
    assert!(PTX.starts_with(&head), "the engine has changed: run make -C crates/engine/cuda/kernels");
}

#[test]
fn it_has_every_function() {
    for name in functions() {
        assert!(PTX.contains(&format!(".visible .entry {name}(")), "{name}");
    }
    assert!(!PTX.contains(".extern"), "it calls what it does not have");
}

/// Multiply-adds would round once less, and a GPU's fast roots and divisions are not those of IEEE 754.
#[test]
fn it_rounds_as_a_processor_does() {
    let words = PTX.split_whitespace().filter(|word| word.ends_with(".f64") && !word.starts_with('.'));
    let (mut rounded, mut exact) = (0, 0);
    for word in words {
        match word.split('.').next().unwrap_or_default() {
            "add" | "sub" | "mul" | "div" | "rcp" | "sqrt" => {
                assert_eq!(word.split('.').nth(1), Some("rn"), "{word}");
                rounded += 1;
            }
            "setp" | "selp" | "mov" | "neg" | "abs" | "copysign" | "max" | "min" | "cvt" => exact += 1,
            _ => panic!("{word} rounds in its own way"),
        }
    }
    assert!(rounded > 1000 && exact > 100, "{rounded}, {exact}");
}
