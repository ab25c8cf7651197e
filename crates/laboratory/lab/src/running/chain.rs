//! The programs of one specimen, run one after the other in its folder, as a shell script would.
//!
//! The folder holds every scene, run and table, and `commands.sh` with the lines that made them. A file that is there is not made again:
//! programs write whole files only, and `stamp` tells whether they belong to the same sample, options and programs. `finished` comes last.
//! A lock beside the folder is held as long as one process works in it; others make other specimens, or wait.

use crate::error::{LabError, Result};
use crate::series::Series;
use jobs::Lock;
use record::{ReportedStop, StopCause};
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use std::cell::RefCell;
use std::fs::File;
use std::io::Write;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::Duration;
use stream::reads::{self, RECORD};

/// Where a program writes its messages.
const WORDS: &str = "words";
/// Exit code of a run that a guard or a signal has stopped: its report says why.
const GUARD: i32 = 3;
/// What the files of a specimen are made from.
const STAMP: &str = "stamp";
/// The stamp again, once the specimen has come to its end.
const FINISHED: &str = "finished";

/// How programs are run.
#[derive(Debug, Clone)]
pub struct Programs {
    /// Folder of the programs.
    pub folder: PathBuf,
    /// Threads of each of them.
    pub threads: usize,
    /// Whether a signal asks to stop.
    pub stop: fn() -> bool,
}

/// Where one specimen lies, and what it is made from.
pub(crate) struct SpecimenFolder {
    pub folder: PathBuf,
    pub specimen: String,
    pub stamp: String,
}

impl SpecimenFolder {
    fn holds(&self, name: &str) -> bool {
        std::fs::read_to_string(self.folder.join(name)).is_ok_and(|old| old == self.stamp)
    }

    /// Whether its files are made from this sample, and all that the programs have read is as it was.
    fn is_of_this(&self) -> bool {
        self.holds(STAMP) && reads::changed(&self.folder.join(RECORD), None).is_empty()
    }

    /// Whether this specimen has come to its end there.
    pub(crate) fn is_finished(&self) -> bool {
        self.is_of_this() && self.holds(FINISHED)
    }

    fn lock(&self) -> PathBuf {
        self.folder.with_added_extension("lock")
    }

    /// Refuses a folder where another process makes another specimen.
    pub(crate) fn check(&self) -> Result<()> {
        let other = Lock::is_held(&self.lock()) && self.folder.join(STAMP).exists() && !self.holds(STAMP);
        if other { Err(LabError::Busy { folder: self.folder.clone() }) } else { Ok(()) }
    }

    /// Takes the folder; `None`: another process works in it.
    pub(crate) fn take<'a>(&'a self, programs: &'a Programs) -> Result<Option<Chain<'a>>> {
        let (lock, above) = (self.lock(), self.folder.parent().unwrap_or(Path::new("")));
        std::fs::create_dir_all(above)
            .map_err(LabError::file(above, "cannot make this folder: choose another --dir"))?;
        let taken =
            Lock::take(&lock).map_err(LabError::file(&lock, "cannot write it: choose another --dir"))?;
        Ok(taken.map(|lock| Chain { place: self, programs, lock: RefCell::new(lock) }))
    }
}

/// The folder of one specimen, which is ours.
pub(crate) struct Chain<'a> {
    pub place: &'a SpecimenFolder,
    programs: &'a Programs,
    lock: RefCell<Lock>,
}

impl Chain<'_> {
    /// Makes the folder; what another sample, other options or other programs have left there is removed.
    pub(crate) fn begin(&self) -> Result<()> {
        let (kept, folder) = (self.place.is_of_this(), &self.place.folder);
        if !kept && self.file(STAMP).exists() {
            // Away at once: a process that is killed here leaves no half of it.
            let old = folder.with_added_extension(format!("part-{}", jobs::here()));
            std::fs::rename(folder, &old)
                .and_then(|()| std::fs::remove_dir_all(&old))
                .map_err(LabError::file(folder, "cannot empty it"))?;
        }
        std::fs::create_dir_all(folder)
            .map_err(LabError::file(folder, "cannot make this folder: choose another --dir"))?;
        if !kept {
            self.write(
                "commands.sh",
                "#!/bin/sh\n# The runs and tables of this specimen, in this folder.\nset -eu\n",
            )?;
            self.write(STAMP, &self.place.stamp)?;
        }
        jobs::clear_parts(folder);
        Ok(())
    }

    /// Notes that the specimen has come to its end.
    pub(crate) fn finish(&self) -> Result<()> {
        self.write(FINISHED, &self.place.stamp)
    }

    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.place.folder.join(name)
    }

    pub(crate) fn write(&self, name: &str, text: &str) -> Result<()> {
        let file = self.file(name);
        jobs::replace(&file, text.as_bytes()).map_err(LabError::file(&file, "cannot write it"))
    }

    /// Runs a scene, where its run is not there; its report.
    ///
    /// A run that a guard has stopped is whole as a file: its report tells, also when it is used again. One that a signal has stopped goes on from
    /// its checkpoint.
    pub(crate) fn dem_run(&self, name: &str) -> Result<Value> {
        let [scene, run, json] = ["toml", "mcap", "json"].map(|ending| format!("{name}.{ending}"));
        let stopped = format!("{name}.stopped.mcap");
        let by_signal = ReportedStop::is_by_signal;
        let made = self.report(&json).ok().filter(|_| self.file(&run).exists());
        if made.as_ref().is_some_and(by_signal) {
            let file = self.file(&run);
            std::fs::rename(&file, self.file(&stopped)).map_err(LabError::file(&file, "cannot rename it"))?;
        }
        if made.as_ref().is_none_or(by_signal) {
            let threads = self.programs.threads.to_string();
            let mut words = vec![&*scene, "--threads", &threads, "-q", "--report", &json, "-o", &run];
            if self.file(&stopped).exists() {
                words.extend(["--resume", &stopped, "--whole"]);
            }
            self.start("dem-run", &words)?;
            // Gone already, or never there.
            let _ = std::fs::remove_file(self.file(&stopped));
        }
        let report = self.report(&json)?;
        let stop = ReportedStop::read(&report).map_err(|e| self.no_report(&json, &e))?;
        let Some(ReportedStop { cause, text: why, time, until }) = stop else { return Ok(report) };
        if cause == StopCause::Signal {
            return Err(LabError::Interrupted);
        }
        let of = until.map_or(String::new(), |until| format!(" of {} s", geom::Shown(until)));
        let reached = format!("t = {} s{of}", geom::Shown(time.unwrap_or(f64::NAN)));
        Err(LabError::Stopped { run: name.to_owned(), reached, why, cause })
    }

    fn report(&self, name: &str) -> Result<Value> {
        let file = self.file(name);
        let text = std::fs::read_to_string(&file).map_err(LabError::file(&file, "cannot read it"))?;
        serde_json::from_str(&text).map_err(|e| self.no_report(name, &e))
    }

    fn no_report(&self, name: &str, why: &serde_json::Error) -> LabError {
        LabError::Content { file: self.file(name), what: format!("is not a report: {why}") }
    }

    pub(crate) fn measure(&self, run: &str, table: &str, options: &[&str]) -> Result<Series> {
        if !self.file(table).exists() {
            let run = format!("{run}.mcap");
            let words: Vec<&str> =
                [run.as_str()].iter().chain(options).chain(&["-q", "-o", table]).copied().collect();
            self.start("dem-measure", &words)?;
        }
        Series::read(&self.file(table))
    }

    /// Runs a program in the folder and waits for it.
    pub(crate) fn start(&self, program: &str, words: &[&str]) -> Result<()> {
        let line: Vec<String> =
            [program].into_iter().chain(words.iter().copied()).map(stream::quoted).collect();
        let script = self.file("commands.sh");
        let mut log =
            File::options().append(true).open(&script).map_err(LabError::file(&script, "cannot write it"))?;
        writeln!(log, "{}", line.join(" ")).map_err(LabError::file(&script, "cannot write it"))?;
        let said = self.file(WORDS);
        let stderr = File::create(&said).map_err(LabError::file(&said, "cannot write it"))?;
        let mut command = Command::new(self.programs.folder.join(program));
        let record =
            std::path::absolute(self.file(RECORD)).map_err(LabError::file(&said, "cannot be found"))?;
        command
            .args(words)
            .env(reads::VARIABLE, record)
            .current_dir(&self.place.folder)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(stderr);
        let child =
            command.spawn().map_err(|source| LabError::Start { program: program.to_owned(), source })?;
        let status =
            self.wait(child).map_err(LabError::file(&self.place.folder, "cannot wait for a program"))?;
        if matches!(status.code(), Some(0 | GUARD)) {
            return Ok(());
        }
        // A signal to all of them may end it before it is noticed here.
        if StopCause::of_exit(status).is_some() {
            return Err(LabError::Interrupted);
        }
        let (how, usual) = match status.signal() {
            Some(number) => (format!("was killed by signal {number}"), "is there too little memory?"),
            None => {
                (format!("failed with exit code {}", status.code().unwrap_or_default()), "is the disk full?")
            }
        };
        let said = std::fs::read_to_string(&said).unwrap_or_default();
        let last = said.lines().rev().find(|line| !line.trim().is_empty());
        let last = last.map(|line| line.strip_prefix(&format!("{program}: ")).unwrap_or(line));
        Err(LabError::Program {
            specimen: self.place.specimen.clone(),
            program: program.to_owned(),
            how,
            words: last.map_or_else(|| format!("it gave no reason; {usual}"), str::to_owned),
        })
    }

    /// How a program ended; a signal to us is passed on to it.
    fn wait(&self, mut child: Child) -> std::io::Result<ExitStatus> {
        let mut told = false;
        loop {
            if let Some(status) = child.try_wait()? {
                return Ok(status);
            }
            if (self.programs.stop)() && !told {
                // It may have ended at this instant.
                let _ = kill_process(Pid::from_child(&child), Signal::TERM);
                told = true;
            }
            self.lock.borrow_mut().beat();
            std::thread::sleep(Duration::from_millis(5));
        }
    }
}

/// SHA-256 of what the files of a specimen are made from.
pub(crate) fn stamp(text: &str, files: &[PathBuf], programs: &Path) -> Result<String> {
    let mut all = text.to_owned();
    let named = files
        .iter()
        .cloned()
        .chain(["lab-test", "dem-run", "dem-measure"].map(|program| programs.join(program)));
    for file in named {
        let bytes = std::fs::read(&file).map_err(LabError::file(&file, "cannot read it"))?;
        all.push_str(&stream::sha256(&bytes));
    }
    Ok(stream::sha256(all.as_bytes()))
}
