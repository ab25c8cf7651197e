//! The files of the repository: its root, its rooms of crates and tools, and the sources below a folder.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder that holds everything.
///
/// # Panics
/// When it is no longer where the tests were built.
pub fn root() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    root.canonicalize().expect("the repository stands where the tests were built")
}

/// The packages of `crates` or `tools`, each as `room/name`, sorted.
///
/// # Panics
/// When the folder is missing.
pub fn packages(of: &str) -> BTreeSet<String> {
    let below = |folder: &Path| {
        let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
        entries.filter(|path| path.is_dir()).collect::<Vec<PathBuf>>()
    };
    let all = root().join(of);
    let packages = below(&all).iter().flat_map(|room| below(room)).collect::<Vec<_>>();
    let packages = packages.iter().filter(|path| path.join("Cargo.toml").exists());
    packages.map(|path| path.strip_prefix(&all).expect("below").display().to_string()).collect()
}

/// The names of all tools.
///
/// # Panics
/// When the folder is missing.
pub fn tools() -> BTreeSet<String> {
    packages("tools").iter().filter_map(|path| path.rsplit('/').next()).map(str::to_owned).collect()
}

/// All Rust files under a folder, without what is built.
///
/// # Panics
/// When the folder is missing.
pub fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        if entry.is_dir() && entry.file_name() != Some("target".as_ref()) {
            found.extend(sources(&entry));
        } else if entry.extension() == Some("rs".as_ref()) {
            found.push(entry);
        }
    }
    found.sort();
    found
}
