//! Runs the tools as a user would: built beside this test, in a folder of their own.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// The program of a tool.
///
/// # Panics
/// When it was not built.
pub fn program(tool: &str) -> PathBuf {
    let exe = std::env::current_exe().expect("the test has a path");
    // Tests lie in target/debug/deps, studies in target/debug.
    let program = exe.ancestors().skip(1).take(2).map(|folder| folder.join(tool)).find(|p| p.exists());
    program.unwrap_or_else(|| {
        panic!("{tool} is missing beside {}: build the tools first, cargo build --bins", exe.display())
    })
}

/// What a tool did.
pub struct Done {
    /// Exit code.
    pub code: i32,
    /// Its words.
    pub stderr: String,
    /// Its output.
    pub stdout: Vec<u8>,
}

impl From<Output> for Done {
    fn from(output: Output) -> Done {
        Done {
            code: output.status.code().unwrap_or(-1),
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
            stdout: output.stdout,
        }
    }
}

/// Runs a tool in a folder.
///
/// # Panics
/// When it cannot be started.
pub fn tool(folder: &Path, tool: &str, arguments: &[&str]) -> Done {
    let mut command = Command::new(program(tool));
    command.current_dir(folder).args(arguments);
    command.output().expect("the tool starts").into()
}

/// Runs a tool in a folder with bytes on its stdin.
///
/// # Panics
/// When it cannot be started.
pub fn with_stdin(folder: &Path, tool: &str, arguments: &[&str], bytes: &[u8]) -> Done {
    let mut command = Command::new(program(tool));
    command.current_dir(folder).args(arguments);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the tool starts");
    let to = child.stdin.take();
    let bytes = bytes.to_vec();
    // In a thread of its own: a tool may write before it has read everything, or read nothing at all.
    let writer = std::thread::spawn(move || to.map(|mut to| to.write_all(&bytes)));
    let done = child.wait_with_output().expect("the tool ends").into();
    let _ = writer.join();
    done
}

/// Runs a tool that must succeed.
///
/// # Panics
/// When it fails.
pub fn succeed(folder: &Path, name: &str, arguments: &[&str]) -> Done {
    let done = tool(folder, name, arguments);
    assert_eq!(done.code, 0, "{name} {arguments:?}: {}", done.stderr);
    done
}

/// Runs a shell line with the tools on its path; fails when any part of the pipe does.
///
/// # Panics
/// When it cannot be started.
pub fn line(folder: &Path, line: &str) -> Done {
    let tools = program("dem-run").parent().expect("a folder").display().to_string();
    let mut command = Command::new("bash");
    command.current_dir(folder).args(["-c", &format!("set -o pipefail; PATH='{tools}':$PATH; {line}")]);
    command.output().expect("bash starts").into()
}
