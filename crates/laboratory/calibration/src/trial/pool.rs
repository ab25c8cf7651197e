//! Runs many jobs, several at a time, beside other processes that may work on the same folder.

use super::TrialRun;
use super::lock;
use super::run::{self, Ended, execute, is_done};
use crate::error::{CalibrateError, Result};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst};
use std::time::Duration;

/// How jobs are run.
#[derive(Clone, Copy)]
pub struct Pool<'a> {
    /// At the same time.
    pub jobs: usize,
    /// Whether a signal asked to stop.
    pub stop: fn() -> bool,
    /// Failures after this time [s since 1970] count.
    pub since: u64,
    /// Called after each run of this process.
    pub ended: &'a (dyn Fn(&TrialRun, &Ended) + Sync),
    /// Set: no further run begins.
    pub give_up: &'a AtomicBool,
}

impl Pool<'_> {
    /// Runs what is not done, and waits until all is done.
    ///
    /// # Errors
    /// A signal, a folder that cannot be written to.
    pub fn run(&self, runs: &[TrialRun]) -> Result<()> {
        let (next, failed) = (AtomicUsize::new(0), AtomicBool::new(false));
        let trouble = Mutex::new(None);
        let worker = || {
            while let Some(run) = runs.get(next.fetch_add(1, SeqCst)) {
                if let Err(e) = self.one(run, &failed) {
                    failed.store(true, SeqCst);
                    if let Ok(mut trouble) = trouble.lock() {
                        trouble.get_or_insert(e);
                    }
                }
            }
        };
        std::thread::scope(|threads| {
            for _ in 1..self.jobs.min(runs.len()) {
                // Where there is no memory for a thread, fewer do.
                let _ = std::thread::Builder::new().spawn_scoped(threads, worker);
            }
            worker();
        });
        match trouble.into_inner().unwrap_or(None) {
            Some(e) => Err(e),
            None if (self.stop)() => Err(CalibrateError::Signal {
                done: runs.iter().filter(|r| is_done(&r.file, &r.job, self.since)).count(),
            }),
            None => Ok(()),
        }
    }

    /// One run: done here, or waited for where another process does it.
    fn one(&self, run: &TrialRun, failed: &AtomicBool) -> Result<()> {
        while !(self.stop)()
            && !failed.load(SeqCst)
            && !self.give_up.load(SeqCst)
            && !is_done(&run.file, &run.job, self.since)
        {
            let Some(mut lock) = lock::take(&run.file)? else {
                std::thread::sleep(Duration::from_millis(100));
                continue;
            };
            if is_done(&run.file, &run.job, self.since) {
                break;
            }
            if let Some(ended) = execute(&run.file, &run.job, &mut lock, self.stop)? {
                (self.ended)(run, &ended);
            }
        }
        Ok(())
    }
}

/// Runs the job of one file: a line of `--jobs-file`.
///
/// # Errors
/// A file that is no job, a folder that cannot be written to, a signal.
pub fn one(job_file: &std::path::Path, stop: fn() -> bool) -> Result<Option<Ended>> {
    let text =
        std::fs::read_to_string(job_file).map_err(crate::error::file(job_file, "cannot read the job"))?;
    let job: run::TrialJob = serde_json::from_str(&text).map_err(|e| CalibrateError::Folder {
        folder: job_file.to_owned(),
        message: format!("is not a job of --jobs-file: {e}"),
    })?;
    if is_done(job_file, &job, u64::MAX) {
        return Ok(run::ended(job_file, &job));
    }
    let Some(mut lock) = lock::take(job_file)? else {
        return Err(CalibrateError::Folder {
            folder: job_file.to_owned(),
            message: "another process runs it".to_owned(),
        });
    };
    let ended = execute(job_file, &job, &mut lock, stop)?;
    ended.map(Some).ok_or(CalibrateError::Signal { done: 0 })
}
