//! Exit codes: 0 done (also when the reader closed the pipe), 1 failed, 2 wrong usage, 3 stopped by a guard.

use crate::Report;
use record::StopCause;
use std::{error::Error, fmt, io};

/// Exit code of wrong usage.
pub const USAGE: u8 = 2;
/// The tool failed.
pub(crate) const FAILED: u8 = 1;
/// Exit code of a run that a guard stopped; its output is valid.
pub const STOPPED: u8 = 3;

/// Wrong usage: exit code 2.
#[derive(Debug)]
pub struct Usage(pub String);

impl fmt::Display for Usage {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.0)
    }
}
impl Error for Usage {}

/// An error that ends the tool with exit code 2.
pub fn usage(message: impl Into<String>) -> anyhow::Error {
    anyhow::Error::new(Usage(message.into()))
}

/// A guard stopped the run: exit code 3. Output that was committed stays, and the report is written.
#[derive(Debug)]
pub struct Stopped {
    /// Which guard, where, when, at what value.
    pub reason: String,
    /// What stopped the run; `None` where no run was stopped, such as for the answer of a check.
    pub cause: Option<StopCause>,
    /// What was done until then.
    pub report: Option<Report>,
}

impl Stopped {
    /// An error that ends the tool with exit code 3 after writing `report`; a `cause` is its field `stop`.
    pub fn error(reason: impl Into<String>, cause: Option<StopCause>, report: Report) -> anyhow::Error {
        let report = if cause.is_some() { report.with("stop", cause) } else { report };
        anyhow::Error::new(Stopped { reason: reason.into(), cause, report: Some(report) })
    }
}

/// An error that ends the tool with exit code 3 because a signal asked it to end; the same command resumes its work.
pub fn stopped_by_signal(reason: impl Into<String>) -> anyhow::Error {
    Stopped::error(reason, Some(StopCause::Signal), Report::new("").with("stopped", record::SIGNAL))
}

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.reason)
    }
}
impl Error for Stopped {}

/// Whether the reader has closed the output of the tool. This is no failure: the reader wants no more.
pub(crate) fn reader_closed_the_pipe(error: &anyhow::Error) -> bool {
    error
        .chain()
        .filter_map(|cause| cause.downcast_ref::<io::Error>())
        .any(|cause| cause.kind() == io::ErrorKind::BrokenPipe)
}

/// The exit code of an error.
pub(crate) fn code(error: &anyhow::Error) -> u8 {
    if reader_closed_the_pipe(error) {
        0
    } else if error.chain().any(|cause| cause.is::<Usage>()) {
        USAGE
    } else if error.chain().any(|cause| cause.is::<Stopped>()) {
        STOPPED
    } else {
        1
    }
}

/// The error and its causes on one line, without causes that the text before already quotes.
pub(crate) fn one_line(error: &anyhow::Error) -> String {
    let mut line = String::new();
    for cause in error.chain() {
        let text = cause.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
        if line.is_empty() {
            line = text;
        } else if !line.contains(&text) {
            line = format!("{line}: {text}");
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::{Context, anyhow};

    #[test]
    fn the_kind_of_error_sets_the_exit_code_through_any_context() {
        let broken = Err::<(), _>(io::Error::from(io::ErrorKind::BrokenPipe)).context("stdout").unwrap_err();
        assert_eq!(code(&broken), 0);
        assert_eq!(code(&usage("no").context("option --x")), 2);
        assert_eq!(code(&Stopped::error("overlap", None, Report::new("")).context("dem")), 3);
        assert_eq!(code(&anyhow!("disk")), 1);
    }

    #[test]
    fn an_error_is_one_line_and_says_nothing_twice() {
        let error = anyhow!("byte 7").context("scan.ply: byte 7").context("cannot\nread");
        assert_eq!(one_line(&error), "cannot read: scan.ply: byte 7");
    }
}
