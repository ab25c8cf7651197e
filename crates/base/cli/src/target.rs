//! The file that the name of an output stands for: a link stands for its target.

use std::{
    fs::{self, File},
    io,
    os::fd::AsFd,
    path::{Path, PathBuf},
};

/// Longest chain of links that is followed, as in Linux.
const LINKS: usize = 40;

/// The file that is written for a name: the one at the end of its links, which need not exist yet.
///
/// # Errors
/// Links in a circle.
pub(crate) fn target(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..LINKS {
        match fs::read_link(&path) {
            Ok(to) if !is_descriptor(&path) => path = folder(&path).join(to),
            _ => return Ok(fs::canonicalize(&path).ok().filter(|_| !is_descriptor(&path)).unwrap_or(path)),
        }
    }
    Err(io::Error::other("its links lead in a circle"))
}

/// Whether a name stands for an open file of this process, such as /dev/stdout. It is written to in place: if it were replaced, what other programs write
/// there would have no name any more.
pub(crate) fn is_descriptor(path: &Path) -> bool {
    let own = format!("/proc/{}/fd", std::process::id());
    fs::canonicalize(folder(path)).is_ok_and(|folder| folder == Path::new(&own))
}

/// Opens a device, a pipe or an open file for writing. Stdout and stderr keep the position of the program that opened them; other open files cannot, and
/// are refused.
///
/// # Errors
/// Whatever the system says.
pub(crate) fn open_as_it_is(path: &Path) -> io::Result<File> {
    let number = path.file_name().and_then(|name| name.to_str()).filter(|_| is_descriptor(path));
    match number {
        Some("1") => Ok(io::stdout().as_fd().try_clone_to_owned()?.into()),
        Some("2") => Ok(io::stderr().as_fd().try_clone_to_owned()?.into()),
        Some("0") => Err(io::Error::other("stdin is read, not written: use /dev/stdout")),
        Some(_) if path.is_file() => Err(io::Error::other("is an open file: use /dev/stdout, or its name")),
        _ => File::options().append(true).open(path),
    }
}

/// The folder of a file.
pub(crate) fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}
