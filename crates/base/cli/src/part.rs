//! Unfinished outputs: files beside their final name.
//!
//! Most tools write to a hidden file, which is removed if the tool fails. A long run writes to the visible file `NAME.part`,
//! which stays if the run is killed or fails after a while. A part file is locked as long as its tool runs. This separates a
//! leftover part from one that is being written.

use crate::target::target;
use std::{
    borrow::Cow,
    error::Error,
    fmt,
    fs::{self, File, Metadata, TryLockError},
    io,
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering::SeqCst},
    },
};
use tempfile::NamedTempFile;

/// Ending of the names of unfinished outputs.
const ENDING: &str = "part";
/// Longest name that file systems take [B].
const LONGEST: usize = 255;
/// What is put around the name of an output to name its part, at most [B].
const AROUND: usize = 16;
/// Digits that tell long names apart whose beginnings are the same.
const DIGITS: usize = 8;
/// Most parts of one output: more of them are an error that the user should see.
const MOST: usize = 99;

/// Whether an unfinished output is to stay when its tool does not come to its end.
#[derive(Debug, Clone, Default)]
pub struct Keep(Arc<AtomicBool>);

impl Keep {
    /// From now on it is worth keeping.
    pub fn keep(&self) {
        self.0.store(true, SeqCst);
    }

    /// Whether it is.
    pub fn kept(&self) -> bool {
        self.0.load(SeqCst)
    }
}

/// An unfinished output: removed on drop, also while a panic unwinds, unless it is to be kept.
#[derive(Debug)]
pub(crate) struct PartFile {
    /// `None` once it has its name.
    temp: Option<NamedTempFile>,
    keep: Keep,
}

impl PartFile {
    /// A hidden file of a name that no other has.
    pub(crate) fn hidden(folder: &Path, stem: &str) -> io::Result<PartFile> {
        let prefix = format!(".{}.", shortened(stem));
        let temp = builder().prefix(&prefix).suffix(".part").tempfile_in(folder)?;
        Ok(PartFile { temp: Some(temp), keep: Keep::default() })
    }

    /// `NAME.part`, or `NAME.2.part` and so on when there are parts already.
    pub(crate) fn plain(folder: &Path, stem: &str) -> io::Result<PartFile> {
        for number in 1..=MOST {
            match builder().rand_bytes(0).prefix(&name(stem, number)).tempfile_in(folder) {
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {}
                other => {
                    let temp = other?;
                    // Where a file system has no locks, a living part looks like one that was left: no more than a warning.
                    let _ = temp.as_file().try_lock();
                    return Ok(PartFile { temp: Some(temp), keep: Keep::default() });
                }
            }
        }
        Err(io::Error::other(format!(
            "there are already {MOST} unfinished outputs of this name: remove those that you do not need"
        )))
    }

    pub(crate) fn keeper(&self) -> Keep {
        self.keep.clone()
    }

    pub(crate) fn path(&self) -> Option<&Path> {
        self.temp.as_ref().map(NamedTempFile::path)
    }

    pub(crate) fn file(&mut self) -> io::Result<&mut File> {
        let temp = self.temp.as_mut().ok_or(io::ErrorKind::NotConnected)?;
        Ok(temp.as_file_mut())
    }

    /// Gives it its name, and the mode and owner of the file that it replaces. One that is worth keeping is on the disk before: a name must
    /// not survive what it names. Gives a warning about an owner or a mode that could not be kept.
    pub(crate) fn rename(mut self, path: &Path) -> anyhow::Result<Option<String>> {
        let kept = self.keep.kept();
        let file = self.file()?;
        if kept {
            file.sync_all()?;
        }
        let old = fs::metadata(path).ok().filter(Metadata::is_file);
        let warning = old.and_then(|old| take_after(file, &old).err());
        let temp = self.temp.take().ok_or_else(|| io::Error::from(io::ErrorKind::NotConnected))?;
        let part = temp.path().to_owned();
        match temp.persist(path) {
            Ok(_) => Ok(warning),
            Err(mut failed) if kept => {
                failed.file.disable_cleanup(true);
                Err(NotRenamed { part, path: path.to_owned(), source: failed.error }.into())
            }
            Err(failed) => Err(failed.error.into()),
        }
    }
}

/// A complete output that could not be given its name.
#[derive(Debug)]
struct NotRenamed {
    part: PathBuf,
    path: PathBuf,
    source: io::Error,
}

impl fmt::Display for NotRenamed {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (part, path) = (self.part.display(), self.path.display());
        if !self.part.exists() {
            return write!(
                f,
                "{path} is lost: {part}, which held it until now, was removed, or its folder was"
            );
        }
        write!(f, "{part} is complete, but cannot be renamed to {path}: rename it yourself, nothing is lost")
    }
}

impl Error for NotRenamed {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        Some(&self.source)
    }
}

/// Adds to the error of a run that its unfinished output stays: until which time [s] it goes, and what it is good for.
pub fn with_part(
    error: anyhow::Error,
    part: Option<&Path>,
    until: f64,
    use_of: impl FnOnce(&Path) -> String,
) -> anyhow::Error {
    // A complete output that has no name says so itself.
    let whole = error.chain().any(|cause| cause.is::<NotRenamed>());
    let Some(part) = part.filter(|part| part.is_file() && !whole) else { return error };
    let (time, use_of, part) = (geom::Shown(until), use_of(part), part.display());
    error.context(format!("the run until t = {time} s is kept in {part} ({use_of})"))
}

/// Gives a file the owner and the mode of the one that it replaces.
#[cfg(unix)]
fn take_after(file: &File, old: &Metadata) -> Result<(), String> {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let (owner, mode) = (|m: &Metadata| [m.uid(), m.gid()], old.mode() & 0o777);
    let new = file.metadata().map_err(|e| e.to_string())?;
    let mut lost = None;
    if owner(&new) != owner(old) && fchown(file, Some(old.uid()), Some(old.gid())).is_err() {
        // Only root gives a file away, but a user has several groups.
        let _ = fchown(file, None, Some(old.gid()));
        lost = Some(format!(
            "it was of user {} and group {} before, and this could not be kept",
            old.uid(),
            old.gid()
        ));
    }
    let set = file.set_permissions(fs::Permissions::from_mode(mode));
    let lost = lost.or_else(|| set.err().map(|e| format!("its mode {mode:o} could not be kept: {e}")));
    lost.map_or(Ok(()), Err)
}

#[cfg(not(unix))]
fn take_after(file: &File, old: &Metadata) -> Result<(), String> {
    file.set_permissions(old.permissions()).map_err(|e| format!("its permissions could not be kept: {e}"))
}

impl Drop for PartFile {
    fn drop(&mut self) {
        if let Some(temp) = &mut self.temp {
            temp.disable_cleanup(self.keep.kept());
        }
    }
}

/// Ordinary permissions, which temporary files do not have.
fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder
}

/// A name that leaves room for what is put around it: the beginning of a long one, and digits of its hash.
fn shortened(stem: &str) -> Cow<'_, str> {
    if stem.len() <= LONGEST - AROUND {
        return Cow::Borrowed(stem);
    }
    let end = stem.floor_char_boundary(LONGEST - AROUND - DIGITS - 1);
    Cow::Owned(format!("{}~{}", &stem[..end], &stream::sha256(stem.as_bytes())[..DIGITS]))
}

fn name(stem: &str, number: usize) -> String {
    let stem = shortened(stem);
    if number == 1 { format!("{stem}.{ENDING}") } else { format!("{stem}.{number}.{ENDING}") }
}

/// Parts of an output, and whether a living tool writes them; the others were left by killed ones. Those of a link lie beside its target.
pub fn parts_of(output: &Path) -> Vec<(PathBuf, bool)> {
    let output =
        if output.is_symlink() { &target(output).unwrap_or_else(|_| output.to_owned()) } else { output };
    let Some(stem) = output.file_name() else { return Vec::new() };
    let stem = stem.to_string_lossy();
    let paths = (1..=MOST).map(|number| output.with_file_name(name(&stem, number)));
    paths.filter(|path| path.is_file()).map(|path| (path.clone(), is_written(&path))).collect()
}

/// Whether a living tool writes this unfinished output.
pub fn is_written(path: &Path) -> bool {
    // Opening a pipe would wait for its other end.
    let Some(file) = path.is_file().then(|| File::open(path).ok()).flatten() else { return false };
    // A shared lock is given back at once, with the file.
    matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock))
}

/// Whether this is the name of an unfinished output.
pub fn is_part(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == ENDING)
}
