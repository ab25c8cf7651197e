//! Arguments of the tools that read or write point clouds.
//!
//! ```no_run
//! #[derive(clap::Parser)]
//! struct Args {
//!     #[command(flatten)]
//!     input: cloud_cli::Input,
//!     #[command(flatten)]
//!     output: cloud_cli::CloudOutput,
//! }
//!
//! fn main() -> std::process::ExitCode {
//!     cli::run("cloud-copy", |args: Args| {
//!         let cloud = args.input.read_cloud()?;
//!         args.output.write_cloud(&cloud)?;
//!         Ok(cli::Report::new(format!("{} points", cloud.points.len())).with("points", cloud.points.len()))
//!     })
//! }
//! ```

mod columns;
mod input;
mod output;

pub use columns::Columns;
pub use input::{Input, place};
pub use output::CloudOutput;
