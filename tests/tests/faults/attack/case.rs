//! One case: a call of a tool with bounded memory and time, and what became of it.

use grainpipe_tests::tools::program;
use std::fmt::{Display, Formatter};
use std::fs::{self, File};
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Address space that a tool may take [kB]; the inputs have a few kilobytes.
const MEMORY: u32 = 1_500_000;
/// Processor time that a tool may take [s]: other work on the machine does not count.
const TIME: u32 = 20;
/// Time on the clock after which a tool counts as one that waits for ever.
pub const WAIT: Duration = Duration::from_secs(300);
/// The signal at the end of the processor time.
const SIGXCPU: i32 = 24;

/// Names that calls give their output.
const OUTPUTS: [&str; 5] = ["out.ply", "out.mcap", "out.png", "out.csv", "out.toml"];

/// A call of a tool.
pub struct Case {
    /// Kind of case, as the page lists it.
    pub group: &'static str,
    /// The tool.
    pub tool: &'static str,
    /// Its arguments.
    pub args: Vec<String>,
    /// Files that it may read.
    pub files: Vec<(String, Vec<u8>)>,
    /// What was done to them.
    pub change: String,
    /// Address space that it may take [kB]; `None`: [`MEMORY`].
    pub memory: Option<u32>,
}

/// What became of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outcome {
    /// Exit 0, and whole output with finite numbers.
    Accepted,
    /// Exit 1 to 3 with a message.
    Refused,
    /// It panicked.
    Panicked,
    /// A signal ended it: out of memory, stack overflow.
    Killed,
    /// It did not end in time.
    TimedOut,
    /// It failed without a message.
    Mute,
    /// It failed and left output that looks whole.
    LeftOutput,
    /// It succeeded with output that is not finite.
    NotFinite,
    /// Its message has control characters.
    RawText,
    /// What was added changed nothing, and nothing said so.
    Silent,
    /// A name became a command, or broke the output.
    Unquoted,
    /// What a message said to do did not help.
    NoRemedy,
    /// A result of other inputs was used again.
    Stale,
}

impl Outcome {
    /// Every outcome, in the order of the page's columns.
    pub const ALL: [Outcome; 13] = [
        Outcome::Accepted,
        Outcome::Refused,
        Outcome::Panicked,
        Outcome::Killed,
        Outcome::TimedOut,
        Outcome::Mute,
        Outcome::LeftOutput,
        Outcome::NotFinite,
        Outcome::RawText,
        Outcome::Silent,
        Outcome::Unquoted,
        Outcome::NoRemedy,
        Outcome::Stale,
    ];

    /// Whether this must not happen.
    pub fn is_bad(self) -> bool {
        !matches!(self, Outcome::Accepted | Outcome::Refused)
    }
}

/// An outcome and the message that came with it.
#[derive(Debug)]
pub struct Verdict {
    /// What became of the case.
    pub outcome: Outcome,
    /// The first line on stderr.
    pub message: String,
}

impl Display for Case {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.tool, self.args.join(" "))?;
        if self.change.is_empty() { Ok(()) } else { write!(f, "   # {}", self.change) }
    }
}

impl Case {
    /// Runs the case in a separate folder.
    ///
    /// # Panics
    /// When the folder cannot be made or bash cannot be started.
    pub fn run(self) -> (Case, Verdict) {
        let folder = tempfile::tempdir().expect("a folder");
        write(folder.path(), &self.files);
        let (status, stderr) = bounded(folder.path(), "", self.memory, self.tool, &self.args);
        let outcome = judge(status, &stderr, folder.path());
        (self, Verdict::new(outcome, &stderr))
    }
}

impl Verdict {
    /// With the first line of what was printed.
    pub fn new(outcome: Outcome, stderr: &str) -> Verdict {
        let message = stderr.lines().find(|l| !l.trim().is_empty()).unwrap_or_default();
        Verdict { outcome, message: message.escape_debug().take(300).collect() }
    }
}

/// Calls a tool in a folder with bounded memory [kB] and time, behind words of the shell; its exit status, none of a tool that waits for ever, and what
/// it printed.
///
/// # Panics
/// When bash cannot be started.
pub fn bounded(
    folder: &Path,
    before: &str,
    memory: Option<u32>,
    tool: &str,
    args: &[String],
) -> (Option<ExitStatus>, String) {
    let create = |name: &str| File::create(folder.join(name)).expect("created");
    let mut command = Command::new("bash");
    // No core dumps: an abort would take longer to write one than to run. A hard limit of time would end it with the signal of too little memory.
    let limits = format!("ulimit -c 0; ulimit -S -t {TIME}; ulimit -v {}", memory.unwrap_or(MEMORY));
    command.args(["-c", &format!("{limits}; {before} exec \"$0\" \"$@\"")]);
    command.arg(program(tool)).args(args).args(["--threads", "2"]);
    command.current_dir(folder).stdin(Stdio::null());
    command.stdout(create("stdout")).stderr(create("stderr"));
    let status = wait(&mut command);
    let stderr = fs::read(folder.join("stderr")).expect("written");
    (status, String::from_utf8_lossy(&stderr).into_owned())
}

/// Writes files into a folder.
///
/// # Panics
/// Where they cannot be written.
pub fn write(folder: &Path, files: &[(String, Vec<u8>)]) {
    for (name, bytes) in files {
        let to = folder.join(name);
        fs::create_dir_all(to.parent().expect("a folder")).expect("made");
        fs::write(to, bytes).expect("written");
    }
}

/// The exit status; none of a tool that waits for ever.
fn wait(command: &mut Command) -> Option<ExitStatus> {
    let mut child = command.spawn().expect("bash starts");
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait().expect("a child") {
            return Some(status);
        }
        if start.elapsed() > WAIT {
            let _ = child.kill();
            let _ = child.wait();
            return None;
        }
        std::thread::sleep(Duration::from_millis(if start.elapsed().as_millis() < 50 { 1 } else { 20 }));
    }
}

/// What became of a call, by what it left in its folder.
pub fn judge(status: Option<ExitStatus>, stderr: &str, folder: &Path) -> Outcome {
    let Some(status) = status.filter(|s| s.signal() != Some(SIGXCPU)) else { return Outcome::TimedOut };
    if stderr.contains("panicked at") {
        return Outcome::Panicked;
    }
    if status.signal().is_some() {
        return Outcome::Killed;
    }
    if stderr
        .chars()
        .any(|c| c.is_control() && c != '\n' && c != '\t' || ('\u{202a}'..='\u{202e}').contains(&c))
    {
        return Outcome::RawText;
    }
    let output = OUTPUTS.iter().map(|name| folder.join(name)).find(|f| f.exists());
    match status.code() {
        Some(0) => match output.and_then(|f| fs::read(f).ok()) {
            Some(bytes) if bytes.starts_with(b"ply") && !finite(&bytes) => Outcome::NotFinite,
            _ => Outcome::Accepted,
        },
        Some(1..=3) if stderr.trim().is_empty() => Outcome::Mute,
        // The system cannot start a program in so little memory: its loader says so.
        Some(126 | 127) if stderr.contains("cannot") => Outcome::Refused,
        // A guard stops a run with whole output.
        Some(1 | 2) if output.is_some() => Outcome::LeftOutput,
        Some(1..=3) => Outcome::Refused,
        _ => Outcome::Panicked,
    }
}

/// Whether the coordinates of a cloud or mesh are finite.
fn finite(ply: &[u8]) -> bool {
    let Ok(cloud) = cloud::from_bytes(ply.to_vec()) else { return false };
    cloud.points.iter().all(|p| p.iter().all(|c| c.is_finite()))
}
