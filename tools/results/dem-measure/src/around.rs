//! The box around all grains of the frames of a profile: a look through the file before it is measured.

use crate::args::Args;
use anyhow::Context;
use cli::Source;
use geom::Vec3;
use measure::Run;
use measure::Which;
use measure::profile::{BoxOfFrames, Turn};
use stream::mcap::Reader;

/// Its corners along the axes of the grid [m]; `None` for a pipe, which can be read only once.
///
/// # Errors
/// A run that cannot be read.
pub fn corners(args: &Args, which: Which, turn: Option<Turn>) -> anyhow::Result<Option<(Vec3, Vec3)>> {
    let is_file = matches!(&args.run, Source::File(path) if path.is_file());
    if !is_file {
        return Ok(None);
    }
    let (mut run, mut around) = (Run::default(), BoxOfFrames::new(which, turn));
    // An error of the file is reported when it is measured.
    for event in Reader::new(args.run.open()?) {
        let Ok(event) = event else { break };
        if let Some(message) = run.take(event).with_context(|| args.run.to_string())? {
            around.take(&run, &message);
        }
    }
    Ok(around.corners())
}
