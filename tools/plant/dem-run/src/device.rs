//! `--device`: what makes the steps.

use dem::device::{Device, Local};
use std::str::FromStr;

/// A device as the command line names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Accelerator {
    /// A GPU by CUDA, and its number.
    Cuda(usize),
    /// What a GPU runs, by this processor.
    Local,
}

impl FromStr for Accelerator {
    type Err = String;

    fn from_str(text: &str) -> Result<Accelerator, String> {
        if text == "local" {
            return Ok(Accelerator::Local);
        }
        let number = match text.split_once(':') {
            None if text == "cuda" => Some(0),
            Some(("cuda", number)) => number.parse().ok(),
            _ => None,
        };
        number
            .map(Accelerator::Cuda)
            .ok_or_else(|| "give cuda, cuda:1 for the second GPU, or local".to_owned())
    }
}

impl Accelerator {
    /// Opens it.
    ///
    /// # Errors
    /// There is none.
    pub fn open(self) -> anyhow::Result<Box<dyn Device>> {
        let Accelerator::Cuda(number) = self else { return Ok(Box::new(Local::default())) };
        let gpu = cuda::Gpu::new(number)
            .map_err(|e| anyhow::anyhow!("--device cuda:{number}: {e}; run without --device"))?;
        Ok(Box::new(gpu))
    }
}
