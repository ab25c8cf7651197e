//! What every tool's main shares: streams, progress, errors, exit codes.
//!
//! A main parses, opens streams, calls a library once, and returns a [`Report`]:
//!
//! ```no_run
//! #[derive(clap::Parser)]
//! struct Args {
//!     /// File to copy, - for stdin
//!     #[arg(value_name = "FILE", default_value = "-")]
//!     input: cli::Source,
//!     #[command(flatten)]
//!     output: cli::Output,
//! }
//!
//! fn main() -> std::process::ExitCode {
//!     cli::run("copy", |args: Args| {
//!         let bytes = args.input.read_all()?;
//!         let mut out = args.output.open()?;
//!         std::io::Write::write_all(&mut out, &bytes)?;
//!         out.commit()?;
//!         Ok(cli::Report::new(format!("{} bytes", bytes.len())).with("bytes", bytes.len()))
//!     })
//! }
//! ```
//!
//! `-q`, `--threads` and `--report` are added to every tool by [`run`]; exit codes are in [`exit`].

mod clash;
mod describe;
pub mod exit;
mod input;
mod invocation;
mod length;
mod memory;
mod output;
mod part;
mod paths;
mod placing;
mod progress;
mod report;
mod run;
mod signals;
mod stderr;
mod stdout;
mod target;
mod time;

pub use clash::also_reads;
pub use exit::{Stopped, Usage, stopped_by_signal, usage};
pub use input::{Lengths, Source};
pub use invocation::{arguments, provenance, quiet, warn};
pub use length::length;
pub use output::{Output, OutputStream};
pub use part::{Keep, is_part, is_written, parts_of, with_part};
pub use paths::{MaybeFile, OutPath};
pub use placing::{Placing, read_mesh};
pub use progress::Progress;
pub use report::Report;
pub use run::{Common, Seed, run};
pub use signals::{folder_removed_on_signal, stop_in_order, stop_requested};
pub use stderr::{escaped, say};
pub use time::{seconds, span};
