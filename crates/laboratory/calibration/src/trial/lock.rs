//! Locks of runs ([`jobs::Lock`]): several processes and machines may share a folder.

use super::run::kill_group;
use crate::error::{Result, file};
use jobs::Lock;
use std::fs;
use std::path::Path;

/// Takes the lock of a job; `None` if another process holds it.
///
/// # Errors
/// A folder that cannot be written to.
pub fn take(job_file: &Path) -> Result<Option<Lock>> {
    let path = job_file.with_extension("lock");
    let lock = Lock::take(&path).map_err(file(&path, "cannot write (is the disk full?)"))?;
    if lock.is_some() {
        clear_left_over(job_file);
    }
    Ok(lock)
}

/// Ends and removes what killed processes of this machine left of a run.
fn clear_left_over(job_file: &Path) {
    let Some((folder, stem)) = job_file.parent().zip(job_file.file_stem()) else { return };
    let start = format!("{}.part-{}-", stem.to_string_lossy(), jobs::host());
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let Some(process) = name.strip_prefix(&start) else { continue };
        if process == std::process::id().to_string() || jobs::is_at_work(process) {
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
