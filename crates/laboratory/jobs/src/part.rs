//! Files that appear when they are whole.

use crate::{here, host, is_at_work};
use std::fs;
use std::io;
use std::path::Path;

/// Writes a file that appears when it is whole.
///
/// # Errors
/// A full disk, a folder that cannot be written to.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let part = path.with_added_extension(format!("part-{}", here()));
    let written = fs::write(&part, bytes).and_then(|()| fs::rename(&part, path));
    if written.is_err() {
        let _ = fs::remove_file(&part);
    }
    written
}

/// Removes files that killed processes of this machine have begun to write.
pub fn clear_parts(folder: &Path) {
    let mark = format!(".part-{}-", host());
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let process = name.rsplit_once(&mark).map(|(_, process)| process.to_owned());
        if process.is_some_and(|p| !is_at_work(&p)) && entry.path().is_file() {
            let _ = fs::remove_file(entry.path());
        }
    }
}
