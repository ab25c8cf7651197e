//! The file that the name of an output stands for: a link stands for its target.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

/// Most links that follow each other, as in Linux.
const LINKS: usize = 40;

/// The file that is written for a name: at the end of links, also where it does not exist yet.
///
/// # Errors
/// Links in a circle.
pub(crate) fn target(path: &Path) -> io::Result<PathBuf> {
    if let Ok(found) = fs::canonicalize(path) {
        return Ok(found);
    }
    let mut path = path.to_owned();
    for _ in 0..LINKS {
        match fs::read_link(&path) {
            Ok(to) => path = folder(&path).join(to),
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("its links lead in a circle"))
}

/// The folder of a file.
pub(crate) fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}
