//! Locks of runs: several processes and machines may share a folder.
//!
//! A lock is a file with machine and process, rewritten every few seconds. It is stale when its process is gone (on this machine), or when
//! it was not rewritten for [`STALE`]. If two processes should ever run the same job, both results are the same, and one is kept.

use super::run::{host, kill_group};
use crate::error::{Result, file};
use std::fs::{self, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

/// After this time without a sign of life a lock is stale.
const STALE: Duration = Duration::from_secs(120);
/// Between signs of life.
const BEAT: Duration = Duration::from_secs(10);

/// A lock that is held; dropped, it is gone.
#[derive(Debug)]
pub struct Lock {
    path: PathBuf,
    beaten: Instant,
}

impl Lock {
    /// Takes the lock of a job; `None` if another process holds it.
    ///
    /// # Errors
    /// A folder that cannot be written to.
    pub fn take(job_file: &Path) -> Result<Option<Lock>> {
        let path = job_file.with_extension("lock");
        for _ in 0..2 {
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(mut new) => {
                    new.write_all(text().as_bytes())
                        .map_err(file(&path, "cannot write (is the disk full?)"))?;
                    clear_left_over(job_file);
                    return Ok(Some(Lock { path, beaten: Instant::now() }));
                }
                Err(e) if e.kind() == ErrorKind::AlreadyExists => {
                    if !is_stale(&path) {
                        return Ok(None);
                    }
                    // The first process that renames it has it; a fresh one that was caught goes back.
                    let old = path.with_extension(format!("lock.stale-{}", super::run::here()));
                    if fs::rename(&path, &old).is_ok() && !is_stale(&old) {
                        let _ = fs::hard_link(&old, &path);
                    }
                    let _ = fs::remove_file(&old);
                }
                Err(e) => return Err(file(&path, "cannot write")(e)),
            }
        }
        Ok(None)
    }

    /// A sign of life.
    pub(super) fn beat(&mut self) {
        if self.beaten.elapsed() > BEAT {
            self.beaten = Instant::now();
            let _ = fs::write(&self.path, text());
        }
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

fn text() -> String {
    format!("{} {}\n", host(), std::process::id())
}

fn is_stale(path: &Path) -> bool {
    let Ok(content) = fs::read_to_string(path) else { return false };
    let mut words = content.split_whitespace();
    let (machine, process) = (words.next(), words.next());
    if machine == Some(host().as_str()) && process.is_some_and(|p| !Path::new("/proc").join(p).exists()) {
        return true;
    }
    let age = fs::metadata(path)
        .and_then(|m| m.modified())
        .ok()
        .and_then(|t| SystemTime::now().duration_since(t).ok());
    // An empty lock is one that is being written, or that a full disk left.
    age.is_some_and(|age| age > STALE)
}

/// Ends and removes what killed processes of this machine left of a run.
fn clear_left_over(job_file: &Path) {
    let Some((folder, stem)) = job_file.parent().zip(job_file.file_stem()) else { return };
    let start = format!("{}.part-{}-", stem.to_string_lossy(), host());
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let Some(process) = name.strip_prefix(&start) else { continue };
        if process == std::process::id().to_string() || Path::new("/proc").join(process).exists() {
            continue;
        }
        let id =
            fs::read_to_string(entry.path().join("process")).ok().and_then(|t| t.trim().parse::<u32>().ok());
        // Only a process that still works in this folder.
        if let Some(id) =
            id.filter(|id| fs::read_link(format!("/proc/{id}/cwd")).is_ok_and(|cwd| cwd.ends_with(&name)))
        {
            kill_group(id);
        }
        let _ = fs::remove_dir_all(entry.path());
    }
}

/// Removes files that killed processes of this machine have begun to write.
pub(crate) fn clear_files(folder: &Path) {
    let mark = format!(".part-{}-", host());
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let process = name.rsplit_once(&mark).map(|(_, process)| process.to_owned());
        let gone = process.is_some_and(|p| !Path::new("/proc").join(p).exists());
        if gone && entry.path().is_file() {
            let _ = fs::remove_file(entry.path());
        }
    }
}
