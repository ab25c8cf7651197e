//! What the running tool was started with, and its warnings.

use crate::stderr::say;
use std::sync::{Mutex, OnceLock};
use stream::mcap::Provenance;

/// What the running tool was started with.
pub(crate) struct Invocation {
    pub tool: &'static str,
    pub arguments: Vec<String>,
    pub quiet: bool,
}

pub(crate) static INVOCATION: OnceLock<Invocation> = OnceLock::new();

/// Name of the running tool.
pub(crate) fn tool() -> &'static str {
    INVOCATION.get().map_or("grainpipe", |i| i.tool)
}

/// Whether `-q` was given.
pub fn quiet() -> bool {
    INVOCATION.get().is_some_and(|i| i.quiet)
}

/// All warnings so far, for the report.
pub(crate) static WARNINGS: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Prints a warning on stderr, unless `-q` was given. The report has it in any case.
pub fn warn(message: &str) {
    if let Ok(mut all) = WARNINGS.lock() {
        all.push(message.to_owned());
    }
    if let Some(i) = INVOCATION.get().filter(|i| !i.quiet) {
        say(&format!("{}: warning: {message}", i.tool));
    }
}

/// The arguments that can change the result, in one spelling: `--radius=solve`.
/// Inputs (which provenance names by hash) and outputs are left out, so that a pipe and a file give the same bytes.
pub fn arguments() -> Vec<String> {
    INVOCATION.get().map(|i| i.arguments.clone()).unwrap_or_default()
}

/// Provenance of the running tool; `inputs` are roles and SHA-256 (`("cloud", "9f86…")`).
pub fn provenance(inputs: Vec<(String, String)>) -> Provenance {
    Provenance {
        tool: INVOCATION.get().map_or("", |i| i.tool).to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        arguments: arguments(),
        inputs,
    }
}
