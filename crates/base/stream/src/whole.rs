//! Files and pipes that are read whole: in bounded memory, whatever the path names.
//!
//! A file takes as much memory as it is long. A pipe may take half of the memory that is free when it is opened; one that is longer, or
//! endless, is refused. Devices have no end and are refused at once.

use std::fs::{File, FileType};
use std::io::{self, Read};
use std::os::unix::fs::FileTypeExt;
use std::path::Path;

/// Longest text [B].
pub const TEXT: u64 = 256 << 20;

/// Memory of a pipe where the free memory is unknown [B].
const UNKNOWN: u64 = 8 << 30;

/// Opens a file, or a named pipe.
///
/// # Errors
/// A path that cannot be opened; a device, a folder.
pub fn open(path: &Path) -> io::Result<File> {
    let file = File::open(path)?;
    match no_file(file.metadata()?.file_type()) {
        Some(what) => {
            let why = format!("is a {what}, and a file is needed");
            Err(io::Error::new(io::ErrorKind::InvalidInput, why))
        }
        None => Ok(file),
    }
}

/// Reads a file, or a named pipe to its end.
///
/// # Errors
/// As [`open`]; a read that fails; a pipe that is too long.
pub fn file(path: &Path) -> io::Result<Vec<u8>> {
    let mut file = open(path)?;
    let about = file.metadata()?;
    let mut bytes = Vec::new();
    if about.is_file() {
        bytes.try_reserve_exact(usize::try_from(about.len()).unwrap_or(usize::MAX))?;
    }
    rest(&mut file, &mut bytes)?;
    Ok(bytes)
}

/// The same, as text.
///
/// # Errors
/// As [`open`]; more than [`TEXT`] bytes; bytes that are not UTF-8, with the place.
pub fn text(path: &Path) -> io::Result<String> {
    rest_of_text(&mut open(path)?)
}

/// What is left of a stream, as text: a scene, a recipe, a table.
///
/// # Errors
/// A read that fails; more than [`TEXT`] bytes; bytes that are not UTF-8, with the place.
pub fn rest_of_text(from: &mut impl Read) -> io::Result<String> {
    let mut bytes = Vec::new();
    if from.take(TEXT + 1).read_to_end(&mut bytes)? as u64 > TEXT {
        let why = format!("more than {} MiB of text: is it the right file?", TEXT >> 20);
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, why));
    }
    String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        io::Error::new(io::ErrorKind::InvalidData, format!("byte {at} is not UTF-8 text"))
    })
}

/// Adds what is left of a stream to `bytes`.
///
/// # Errors
/// A read that fails; more than half of the free memory.
pub fn rest(from: &mut impl Read, bytes: &mut Vec<u8>) -> io::Result<()> {
    up_to(from, bytes, half_of_the_free_memory())
}

fn up_to(from: &mut impl Read, bytes: &mut Vec<u8>, most: u64) -> io::Result<()> {
    let room = most.saturating_sub(bytes.len() as u64);
    // What was reserved for a file is there already.
    let room = room.max((bytes.capacity() - bytes.len()) as u64);
    let read = from.take(room.saturating_add(1)).read_to_end(bytes)? as u64;
    if read <= room {
        return Ok(());
    }
    let mib = most >> 20;
    let why = format!("more than {mib} MiB, half of the free memory: is the stream endless? give a file");
    Err(io::Error::new(io::ErrorKind::FileTooLarge, why))
}

/// What a path names that has no end, or no bytes.
fn no_file(kind: FileType) -> Option<&'static str> {
    match kind {
        kind if kind.is_dir() => Some("folder"),
        kind if kind.is_char_device() || kind.is_block_device() => Some("device"),
        _ => None,
    }
}

/// [B].
fn half_of_the_free_memory() -> u64 {
    let about = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let line = about.lines().find_map(|line| line.strip_prefix("MemAvailable:"));
    let kib = line.and_then(|rest| rest.split_whitespace().next()?.parse::<u64>().ok());
    kib.map_or(UNKNOWN, |kib| kib * 512)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn devices_and_endless_streams_are_refused() {
        for (path, part) in [("/dev/zero", "device"), ("/dev/null", "device"), ("/tmp", "folder")] {
            let why = file(Path::new(path)).unwrap_err().to_string();
            assert!(why.contains(part) && why.contains("a file is needed"), "{path}: {why}");
        }
        let mut bytes = b"begun".to_vec();
        let why = up_to(&mut io::repeat(7), &mut bytes, 1 << 20).unwrap_err().to_string();
        assert!(why.contains("more than 1 MiB") && bytes.len() <= (1 << 20) + 1, "{why}");
        assert!(half_of_the_free_memory() > 1 << 20);
        let why = rest_of_text(&mut io::repeat(b'a')).unwrap_err().to_string();
        assert!(why.contains("more than 256 MiB of text"), "{why}");
    }

    #[test]
    fn what_fits_is_read() {
        let mut bytes = b"ab".to_vec();
        up_to(&mut &b"cd"[..], &mut bytes, 4).unwrap();
        assert_eq!(bytes, b"abcd");
        let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
        assert_eq!(text(&here).unwrap(), std::fs::read_to_string(&here).unwrap());
    }
}
