//! Hashes of what tools write, for a change that is to change no byte: `pipelines/bytes.sh` notes them before and compares them after.

use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Notes the files of a folder, and what lines printed, as `NAME.txt` in the folder that GRAINPIPE_WRITTEN names; without it nothing.
///
/// # Panics
/// When files cannot be read or written.
pub fn note(name: &str, folder: &Path, printed: &[(String, Vec<u8>)]) {
    let Some(notes) = std::env::var_os("GRAINPIPE_WRITTEN") else { return };
    let mut files = Vec::new();
    list(folder, &mut files);
    files.sort();
    let mut text = String::new();
    for file in files {
        let bytes = std::fs::read(&file).expect("a file that was written can be read");
        let path = file.strip_prefix(folder).expect("it is in the folder").display();
        writeln!(text, "{name}/{path} {}", stream::sha256(&bytes)).expect("text");
    }
    for (line, bytes) in printed {
        writeln!(text, "{name}: {line} {}", stream::sha256(bytes)).expect("text");
    }
    std::fs::write(Path::new(&notes).join(name).with_extension("txt"), text).expect("notes can be written");
}

fn list(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let kind = entry.file_type().expect("a kind");
        if kind.is_dir() {
            list(&entry.path(), files);
        } else if kind.is_file() {
            files.push(entry.path());
        }
    }
}
