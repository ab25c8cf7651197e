//! The box around all grains of the frames of a profile: a look through the file before it is measured.

use crate::args::Args;
use cli::Source;
use geom::Vec3;
use measure::profile::{BoxOfFrames, Turn};
use measure::{MeasureError, Run, Which};
use stream::mcap::Reader;

/// Its corners along the axes of the grid [m]; `None` for a pipe, which can be read only once.
///
/// # Errors
/// Messages that a run cannot have.
pub fn corners(args: &Args, which: Which, turn: Option<Turn>) -> Result<Option<(Vec3, Vec3)>, MeasureError> {
    let is_file = matches!(&args.run, Source::File(path) if path.is_file());
    if !is_file {
        return Ok(None);
    }
    let (mut run, mut around) = (Run::default(), BoxOfFrames::new(which, turn));
    // An error of the file is reported when it is measured.
    let Ok(file) = args.run.open() else { return Ok(None) };
    for event in Reader::new(file) {
        let Ok(event) = event else { break };
        if let Some(message) = run.take(event)? {
            around.take(&run, &message);
        }
    }
    Ok(around.corners())
}
