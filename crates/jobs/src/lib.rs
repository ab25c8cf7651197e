//! Folders in which several processes and machines work: one makes a file, and the others wait for it or make another.
//!
//! [`Lock`] says which of them makes it; [`replace`] writes a file that appears when it is whole; [`clear_parts`] removes what killed processes have left.

mod lock;
mod part;

pub use lock::Lock;
pub use part::{clear_parts, replace};

use std::fs;
use std::path::Path;

/// Machine and process, as part of names.
pub fn here() -> String {
    format!("{}-{}", host(), std::process::id())
}

/// The name of this machine.
pub fn host() -> String {
    let name = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    let name: String = name.trim().chars().filter(|c| c.is_ascii_alphanumeric() || *c == '.').collect();
    if name.is_empty() { "host".to_owned() } else { name }
}

/// Whether a process of this machine, by its number, is at work.
pub fn is_at_work(process: &str) -> bool {
    Path::new("/proc").join(process).exists()
}
