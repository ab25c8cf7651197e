//! Where a tool writes a cloud.

use anyhow::Context;
use cli::{Output, OutputStream, usage};
use cloud::Cloud;
use stream::ply::Encoding;

/// Where a tool writes a cloud: flatten it into the arguments of a tool that writes PLY.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct CloudOutput {
    /// The file, or stdout where none is named.
    #[command(flatten)]
    pub to: Output,
    /// Write PLY as text
    #[arg(long)]
    pub ascii: bool,
}

impl CloudOutput {
    /// Writes a cloud as PLY and commits it.
    ///
    /// # Errors
    /// As [`cli::Output::open`]; a write that fails.
    pub fn write_cloud(&self, cloud: &Cloud) -> anyhow::Result<()> {
        let encoding = if self.ascii { Encoding::Ascii } else { Encoding::BinaryLittleEndian };
        let mut out = if self.ascii { self.to.open_text()? } else { self.to.open()? };
        cloud::write_ply(&mut out, cloud, encoding)
            .with_context(|| format!("{}: cannot write", self.to.name()))?;
        out.commit()
    }

    /// Opens a stream for something else than PLY.
    ///
    /// # Errors
    /// As [`cli::Output::open`]; `--ascii`, which only PLY has.
    pub fn open_binary(&self, what: &str) -> anyhow::Result<OutputStream> {
        if self.ascii {
            return Err(usage(format!(
                "--ascii: {what} has no text form: leave --ascii out, or write PLY with -o FILE.ply"
            )));
        }
        self.to.open()
    }
}
