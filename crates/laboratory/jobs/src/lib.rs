//! Folders in which several processes and machines work: one makes a file, and the others wait for it or make another.
//!
//! [`Lock`] says which of them makes it; [`replace`] writes a file that appears when it is whole; [`clear_parts`] removes what killed processes have left.

mod lock;
mod part;

pub use lock::Lock;
pub use part::{clear_parts, replace};

use rustix::io::Errno;
use rustix::process::{Pid, test_kill_process};

/// Machine and process, as part of names.
pub fn here() -> String {
    format!("{}-{}", host(), std::process::id())
}

/// The name of this machine.
pub fn host() -> String {
    let system = rustix::system::uname();
    let name: String = system
        .nodename()
        .to_string_lossy()
        .chars()
        .filter(|c| c.is_ascii_alphanumeric() || *c == '.')
        .collect();
    if name.is_empty() { "host".to_owned() } else { name }
}

/// Whether a process of this machine, by its number, is at work.
pub fn is_at_work(process: &str) -> bool {
    let number = process.parse().ok().and_then(Pid::from_raw);
    // A process of another user is there, too: it only may not be signalled.
    number.is_some_and(|number| test_kill_process(number) != Err(Errno::SRCH))
}
