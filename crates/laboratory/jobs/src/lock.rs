//! Locks of jobs.
//!
//! A lock is a file with machine and process, rewritten every few seconds. It is stale when its process is gone (on this machine), or when
//! it was not rewritten for [`STALE`]. If two processes should ever run the same job, both results are the same, and one is kept.

use crate::{here, host, is_at_work};
use std::fs::{self, OpenOptions};
use std::io::{self, ErrorKind, Write};
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
    /// Takes the lock of this name; `None` if another process holds it.
    ///
    /// # Errors
    /// A folder that cannot be written to.
    pub fn take(path: &Path) -> io::Result<Option<Lock>> {
        for _ in 0..2 {
            match OpenOptions::new().write(true).create_new(true).open(path) {
                Ok(mut new) => {
                    new.write_all(text().as_bytes())?;
                    return Ok(Some(Lock { path: path.to_owned(), beaten: Instant::now() }));
                }
                Err(e) if e.kind() == ErrorKind::AlreadyExists => {
                    if !is_stale(path) {
                        return Ok(None);
                    }
                    // The first process that renames it has it; a fresh one that was caught goes back.
                    let old = path.with_added_extension(format!("stale-{}", here()));
                    if fs::rename(path, &old).is_ok() && !is_stale(&old) {
                        let _ = fs::hard_link(&old, path);
                    }
                    let _ = fs::remove_file(&old);
                }
                Err(e) => return Err(e),
            }
        }
        Ok(None)
    }

    /// Whether a process holds the lock of this name.
    pub fn is_held(path: &Path) -> bool {
        path.exists() && !is_stale(path)
    }

    /// A sign of life.
    pub fn beat(&mut self) {
        if self.beaten.elapsed() > BEAT {
            self.beat_now();
        }
    }

    fn beat_now(&mut self) {
        self.beaten = Instant::now();
        if self.is_ours() {
            let _ = fs::write(&self.path, text());
        }
    }

    /// Whether it is still ours: while this process was suspended, another may have found it stale, and have taken it.
    fn is_ours(&self) -> bool {
        fs::read_to_string(&self.path).is_ok_and(|now| now == text())
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        if self.is_ours() {
            let _ = fs::remove_file(&self.path);
        }
    }
}

fn text() -> String {
    format!("{} {}\n", host(), std::process::id())
}

fn is_stale(path: &Path) -> bool {
    let Ok(content) = fs::read_to_string(path) else { return false };
    let mut words = content.split_whitespace();
    let (machine, process) = (words.next(), words.next());
    if machine == Some(host().as_str()) && process.is_some_and(|p| !is_at_work(p)) {
        return true;
    }
    let age = fs::metadata(path)
        .and_then(|m| m.modified())
        .ok()
        .and_then(|t| SystemTime::now().duration_since(t).ok());
    // An empty lock is one that is being written, or that a full disk left.
    age.is_some_and(|age| age > STALE)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A process that has just ended.
    fn gone() -> u32 {
        let mut child = std::process::Command::new("true").spawn().unwrap();
        child.wait().unwrap();
        child.id()
    }

    #[test]
    fn a_lock_is_held_once_and_stale_when_its_process_is_gone_or_silent() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a=0.5,b.lock");
        let first = Lock::take(&path).unwrap().expect("it is free");
        assert!(Lock::is_held(&path) && Lock::take(&path).unwrap().is_none());
        drop(first);
        assert!(!path.exists());
        let mut lost = Lock::take(&path).unwrap().expect("it is free");
        fs::write(&path, "another 1\n").unwrap();
        lost.beat_now();
        drop(lost);
        assert_eq!(fs::read_to_string(&path).unwrap(), "another 1\n", "it is another's now");
        for (content, free) in [
            (format!("{} {}\n", host(), std::process::id()), false),
            (format!("{} {}\n", host(), gone()), true),
            (format!("another.{} 1\n", host()), false),
            (String::new(), false),
        ] {
            fs::write(&path, &content).unwrap();
            assert_eq!(Lock::is_held(&path), !free, "{content}");
            assert_eq!(Lock::take(&path).unwrap().is_some(), free, "{content}");
        }
        // The last one was not given a sign of life for long.
        let long_ago = SystemTime::now() - 2 * STALE;
        fs::write(&path, format!("another.{} 1\n", host())).unwrap();
        fs::File::options().write(true).open(&path).unwrap().set_modified(long_ago).unwrap();
        assert!(Lock::take(&path).unwrap().is_some());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is left");
    }
}
