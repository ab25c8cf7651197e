//! One run: its command in its own folder.

use crate::error::{CalibrateError, Result, file};
use jobs::{Lock, here};
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};
use stream::reads::{self, RECORD, Stop};

/// Attempts at a run that fails, over repeated calls.
const TRIES: u32 = 3;
/// Exit code of a run that a guard stopped.
pub const STOPPED: i32 = 3;

/// What a run does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialJob {
    /// Name of the test.
    pub test: String,
    /// The shell line.
    pub command: String,
    /// SHA-256 of the line and of the files that it names.
    pub stamp: String,
    /// Longest time [s].
    pub timeout: Option<f64>,
    /// Folder of the recipe.
    #[serde(default)]
    pub here: PathBuf,
}

/// How a run ended, and its provenance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ended {
    /// That of its job.
    pub stamp: String,
    /// The shell line.
    pub command: String,
    /// Exit code; 128 and more: killed by a signal.
    pub exit: i32,
    /// Whether it took longer than it may.
    pub timed_out: bool,
    /// Wall time [s].
    pub seconds: f64,
    /// Machine and process that ran it.
    pub by: String,
    /// Start [s since 1970].
    pub started: u64,
    /// Version of this program.
    pub version: String,
    /// Which try it was.
    pub attempt: u32,
    /// Folder of the recipe then.
    #[serde(default)]
    pub here: PathBuf,
    /// Programs of the command that were stopped.
    #[serde(default)]
    pub stops: Vec<Stop>,
}

impl Ended {
    /// Whether it would end so again: done, or stopped by a guard.
    pub fn is_final(&self) -> bool {
        !self.timed_out && self.signal().is_none() && (self.exit == 0 || self.exit == STOPPED)
    }

    /// What a signal stopped, of its programs.
    pub fn signal(&self) -> Option<&Stop> {
        self.stops.iter().find(|stop| stop.signal)
    }
}

/// The folder of a run.
pub fn folder(job_file: &Path) -> PathBuf {
    job_file.with_extension("")
}

/// How a run ended, if it is the run of this job, and the files that it has read are what they were.
pub fn ended(job_file: &Path, job: &TrialJob) -> Option<Ended> {
    let text = fs::read_to_string(folder(job_file).join("result.json")).ok()?;
    let ended: Ended = serde_json::from_str(&text).ok()?;
    let record = folder(job_file).join(RECORD);
    let same = || reads::changed(&record, Some((&ended.here, &job.here))).is_empty();
    (ended.stamp == job.stamp && same()).then_some(ended)
}

/// Whether a run has ended there that was made from other files, another command or another program.
pub fn is_outdated(job_file: &Path, job: &TrialJob) -> bool {
    folder(job_file).join("result.json").exists() && ended(job_file, job).is_none()
}

/// Whether nothing is left to do; `since`: failures after this time [s since 1970] count.
pub fn is_done(job_file: &Path, job: &TrialJob, since: u64) -> bool {
    ended(job_file, job).is_some_and(|e| e.is_final() || e.started >= since || e.attempt >= TRIES)
}

/// Now [s since 1970].
pub fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs())
}

/// Runs a job whose lock is held. `None`: a signal asked to stop.
///
/// # Errors
/// A folder that cannot be written to, bash that cannot be started.
pub fn execute(
    job_file: &Path,
    job: &TrialJob,
    lock: &mut Lock,
    stop: fn() -> bool,
) -> Result<Option<Ended>> {
    let attempt = 1 + ended(job_file, job).map_or(0, |e| e.attempt);
    let place = folder(job_file);
    let part = PathBuf::from(format!("{}.part-{}", place.display(), here()));
    let _ = fs::remove_dir_all(&part);
    fs::create_dir_all(&part).map_err(file(&part, "cannot create the folder"))?;
    let (started, clock) = (now(), Instant::now());
    let mut child = start(&part, job)?;
    // A process that outlives this one is found by it.
    let _ = fs::write(part.join("process"), child.id().to_string());
    let (exit, timed_out) = match wait(&mut child, job.timeout, lock, stop) {
        Some(end) => end,
        None => {
            let _ = fs::remove_dir_all(&part);
            return Ok(None);
        }
    };
    let _ = fs::remove_file(part.join("process"));
    let seconds = clock.elapsed().as_secs_f64();
    let ended = Ended {
        stamp: job.stamp.clone(),
        command: job.command.clone(),
        exit,
        timed_out,
        seconds,
        by: here(),
        here: job.here.clone(),
        stops: reads::stops(&part.join(RECORD)),
        started,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        attempt,
    };
    let text = serde_json::to_string_pretty(&ended).map_err(|e| CalibrateError::Failed(e.to_string()))?;
    let result = part.join("result.json");
    fs::write(&result, text + "\n").map_err(file(&result, "cannot write (is the disk full?)"))?;
    let _ = fs::remove_dir_all(&place);
    if let Err(why) = fs::rename(&part, &place) {
        let _ = fs::remove_dir_all(&part);
        // Another machine was faster; otherwise the disk is full, or the folder may not be written.
        if !place.join("result.json").is_file() {
            return Err(file(&place, "cannot be written (is the disk full?)")(why));
        }
    }
    Ok(Some(ended))
}

fn start(part: &Path, job: &TrialJob) -> Result<Child> {
    let script = part.join("command.sh");
    let text = format!(
        "#!/usr/bin/env bash\nset -o pipefail\nPATH={}:\"$PATH\"\n{}\n",
        stream::quoted(&tools().display().to_string()),
        job.command
    );
    fs::write(&script, text).map_err(file(&script, "cannot write (is the disk full?)"))?;
    let create = |name: &str| {
        let path = part.join(name);
        File::create(&path).map_err(file(&path, "cannot write (is the disk full?)"))
    };
    let record = std::path::absolute(part.join(RECORD)).map_err(file(part, "cannot be found"))?;
    Command::new("bash")
        .arg("command.sh")
        .env(reads::VARIABLE, record)
        .current_dir(part)
        .stdin(Stdio::null())
        .stdout(create("stdout")?)
        .stderr(create("stderr")?)
        .process_group(0)
        .spawn()
        .map_err(file(Path::new("bash"), "cannot be started: install it"))
}

/// Exit code, and whether it took too long; `None` after a signal.
fn wait(child: &mut Child, timeout: Option<f64>, lock: &mut Lock, stop: fn() -> bool) -> Option<(i32, bool)> {
    let (clock, mut pause) = (Instant::now(), 1u64);
    loop {
        if let Ok(Some(status)) = child.try_wait() {
            return Some((status.code().unwrap_or_else(|| 128 + status.signal().unwrap_or(0)), false));
        }
        let late = timeout.is_some_and(|t| clock.elapsed().as_secs_f64() > t);
        if late || stop() {
            kill_group(child.id());
            let _ = child.wait();
            return late.then_some((124, true));
        }
        lock.beat();
        std::thread::sleep(Duration::from_millis(pause));
        pause = (2 * pause).min(50);
    }
}

/// Ends a command and all that it started.
pub(super) fn kill_group(id: u32) {
    if let Some(pid) = i32::try_from(id).ok().and_then(rustix::process::Pid::from_raw) {
        let _ = rustix::process::kill_process_group(pid, rustix::process::Signal::KILL);
    }
}

/// The stamp of a command: the line, and the files that it names; `movable` is the same line without the place of the recipe. A run of another scene or program
/// is another run.
pub fn stamp(movable: &str, command: &str) -> String {
    let mut all = format!("{movable}\n");
    let tools = tools();
    for word in stream::words(command) {
        let found = if word.contains('/') { Path::new(&word).to_owned() } else { tools.join(word) };
        // Relative files belong to the folder of the run, which is new.
        let hash = if found.is_absolute() && found.is_file() { reads::known(&found) } else { None };
        all.extend(hash.map(|h| h + "\n"));
    }
    stream::sha256(all.as_bytes())
}

/// Folder of the programs.
pub fn tools() -> PathBuf {
    std::env::current_exe().ok().and_then(|e| e.parent().map(Path::to_owned)).unwrap_or_default()
}
