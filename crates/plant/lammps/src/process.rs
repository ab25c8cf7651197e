//! LAMMPS as a process: how it is started, stopped, and what it said last.

use crate::error::{LammpsError, Result};
use crate::files::{DUMPS, INPUT};
use crate::folder::Start;
use crate::version::Version;
use rustix::process::{Pid, Signal};
use std::collections::VecDeque;
use std::io::{BufRead, BufReader, PipeReader, PipeWriter, Read};
use std::os::fd::AsRawFd;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Lines of output that are kept.
const KEPT: usize = 12;
/// How long LAMMPS has to end after it was asked to.
const PATIENCE: Duration = Duration::from_secs(5);
/// How long its streams are read after its end.
const LISTENED: Duration = Duration::from_secs(1);
/// Time between looks at the process.
const LOOK: Duration = Duration::from_millis(20);

/// Which LAMMPS, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Engine {
    /// The program and its options, such as `lmp -sf omp`.
    pub lmp: Vec<String>,
    /// MPI ranks; 1 without MPI's launcher.
    pub ranks: usize,
    /// MPI's launcher and its options.
    pub mpirun: Vec<String>,
}

impl Engine {
    fn program(&self) -> &str {
        self.lmp.first().map_or("lmp", String::as_str)
    }

    /// The version of the program.
    ///
    /// # Errors
    /// A program that is missing or is not LAMMPS.
    pub fn version(&self) -> Result<Version> {
        let program = self.program().to_owned();
        let asked = Command::new(&program).arg("-h").stdin(Stdio::null()).output();
        let output = asked.map_err(|error| LammpsError::Start { program: program.clone(), error })?;
        let text = String::from_utf8_lossy(&output.stdout);
        Version::of_help(&text).ok_or(LammpsError::NotLammps { program })
    }

    fn command(&self) -> Command {
        let mut words = self.lmp.clone();
        if self.ranks > 1 {
            let ranks = ["-np".to_owned(), self.ranks.to_string()];
            words = self.mpirun.iter().cloned().chain(ranks).chain(words).collect();
        }
        let mut words = words.into_iter();
        let mut command = Command::new(words.next().unwrap_or_default());
        command.args(words);
        command
    }
}

/// LAMMPS at work.
pub struct Running {
    watcher: JoinHandle<std::io::Result<ExitStatus>>,
    said: Arc<Mutex<VecDeque<String>>>,
    listeners: Vec<JoinHandle<()>>,
    abandoned: Arc<AtomicBool>,
    ended: Arc<AtomicBool>,
}

/// Where LAMMPS works.
#[derive(Clone, Copy)]
pub enum Place<'a> {
    /// In a folder that is gone with the run.
    Passing(&'a Path),
    /// In a folder that keeps what a later start goes on from.
    Kept(&'a Start),
}

impl Running {
    /// Whether it has ended, as it becomes true.
    pub fn ended(&self) -> Arc<AtomicBool> {
        self.ended.clone()
    }

    /// Starts the deck; in a folder that is gone with the run, its dumps come from pipes, in the order of [`DUMPS`]. `stop` is asked now and then whether it is to end.
    ///
    /// # Errors
    /// A program that cannot be started.
    pub fn start(engine: &Engine, place: &Place, stop: fn() -> bool) -> Result<(Running, Vec<PipeReader>)> {
        let program = if engine.ranks > 1 { &engine.mpirun } else { &engine.lmp };
        let program = program.first().cloned().unwrap_or_default();
        let failed = |error| LammpsError::Start { program: program.clone(), error };
        let mut command = engine.command();
        command.args(["-in", INPUT, "-log", "log.lammps"]);
        let (folder, stdin) = match place {
            Place::Passing(folder) => {
                command.args(["-var", "keep", "0"]);
                (*folder, Stdio::null())
            }
            Place::Kept(start) => {
                command.args(start.state.iter().flat_map(|state| ["-var", "state", state]));
                // It holds the lock as long as it lives, and reads nothing.
                (start.folder.as_path(), Stdio::from(start.lock.try_clone().map_err(failed)?))
            }
        };
        let mut pipes = Vec::new();
        // The frames come last.
        for dump in DUMPS.into_iter().rev() {
            let to = match place {
                Place::Kept(start) => start.dump(dump).display().to_string(),
                Place::Passing(_) => {
                    let pipe = std::io::pipe().map_err(failed)?;
                    // LAMMPS opens the pipe by this name; no rank needs to inherit it.
                    let name = format!("/proc/{}/fd/{}", std::process::id(), pipe.1.as_raw_fd());
                    pipes.insert(0, pipe);
                    name
                }
            };
            command.args(["-var", dump.trim_end_matches(".dump"), &to]);
        }
        // A group of its own: all of it is ended, and an interrupt of the terminal comes to this program first.
        command.process_group(0);
        command.current_dir(folder).stdin(stdin).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(failed)?;
        let said = Arc::new(Mutex::new(VecDeque::new()));
        let mut listeners = Vec::new();
        if let Some(out) = child.stdout.take() {
            listeners.push(listen(out, said.clone()));
        }
        if let Some(err) = child.stderr.take() {
            listeners.push(listen(err, said.clone()));
        }
        let abandoned = Arc::new(AtomicBool::new(false));
        let ends = {
            let abandoned = abandoned.clone();
            move || stop() || abandoned.load(SeqCst)
        };
        let (readers, writers): (Vec<_>, Vec<_>) = pipes.into_iter().unzip();
        let ended = Arc::new(AtomicBool::new(false));
        let watcher = {
            let ended = ended.clone();
            std::thread::spawn(move || {
                let status = watch(child, writers, ends);
                ended.store(true, SeqCst);
                status
            })
        };
        Ok((Running { watcher, said, listeners, abandoned, ended }, readers))
    }

    /// Ends it: its frames are no longer read.
    pub fn abandon(&self) {
        self.abandoned.store(true, SeqCst);
    }

    /// Waits for its end: how it ended, and its last words.
    pub fn end(self) -> (Option<ExitStatus>, String) {
        let status = self.watcher.join().ok().and_then(Result::ok);
        // Processes that it has left behind may hold its streams open.
        let since = Instant::now();
        while self.listeners.iter().any(|l| !l.is_finished()) && since.elapsed() < LISTENED {
            std::thread::sleep(LOOK);
        }
        let said = self.said.lock().unwrap_or_else(PoisonError::into_inner);
        (status, last_words(said.iter().map(String::as_str)))
    }
}

/// Waits for the end of the process, and then closes the pipes, so that their readers see the end.
fn watch(mut child: Child, pipes: Vec<PipeWriter>, stop: impl Fn() -> bool) -> std::io::Result<ExitStatus> {
    let mut asked: Option<Instant> = None;
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        match asked {
            None if stop() => {
                asked = Some(Instant::now());
                signal_all(&child, Signal::TERM);
            }
            Some(since) if since.elapsed() > PATIENCE => signal_all(&child, Signal::KILL),
            _ => {}
        }
        std::thread::sleep(LOOK);
    };
    drop(pipes);
    Ok(status)
}

/// Sends a signal to a process and to those that it has started: a launcher ends its ranks then.
fn signal_all(child: &Child, signal: Signal) {
    if let Some(id) = Pid::from_raw(child.id() as i32) {
        let _ = rustix::process::kill_process_group(id, signal);
    }
}

/// Keeps the last lines of a stream.
fn listen(stream: impl Read + Send + 'static, said: Arc<Mutex<VecDeque<String>>>) -> JoinHandle<()> {
    std::thread::spawn(move || {
        for line in BufReader::new(stream).split(b'\n').map_while(Result::ok) {
            let line = String::from_utf8_lossy(&line).trim().to_owned();
            if line.is_empty() {
                continue;
            }
            let mut said = said.lock().unwrap_or_else(PoisonError::into_inner);
            // An error is the last word, whatever a launcher says after it.
            if said.len() == KEPT && !said.front().is_some_and(|l| is_error(l)) {
                said.pop_front();
            }
            if said.len() < 2 * KEPT {
                said.push_back(line);
            }
        }
    })
}

fn is_error(line: &str) -> bool {
    line.starts_with("ERROR")
}

/// The error and the command that it came from; else the last lines.
fn last_words<'a>(lines: impl Iterator<Item = &'a str>) -> String {
    let lines: Vec<&str> = lines.collect();
    let error = lines.iter().position(|line| is_error(line));
    match error {
        Some(first) => {
            let command = lines[first..].iter().find(|line| line.starts_with("Last command"));
            std::iter::once(lines[first]).chain(command.copied()).collect::<Vec<_>>().join("; ")
        }
        None if lines.is_empty() => "it said nothing".to_owned(),
        None => lines[lines.len().saturating_sub(3)..].join("; "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_words_are_the_error_and_its_command() {
        let lines = [
            "Step KinEng",
            "ERROR: Lost atoms: original 3 current 2 (src/thermo.cpp:438)",
            "Last command: run 100",
            "MPI_ABORT was invoked",
        ];
        assert_eq!(
            last_words(lines.into_iter()),
            "ERROR: Lost atoms: original 3 current 2 (src/thermo.cpp:438); Last command: run 100"
        );
        assert_eq!(last_words(["a", "b", "c", "d"].into_iter()), "b; c; d");
        assert_eq!(last_words(std::iter::empty()), "it said nothing");
    }
}
