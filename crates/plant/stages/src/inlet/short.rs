//! A record that is shorter than the run.

use geom::Shown;

/// The warning where the record of `[[inlet]]` `index` ended at `last` [s] while particles still came in, before the run does, at `end` [s].
///
/// It has the key, not the name of the file: the text is also in the output, whose bytes are the same for a file and a pipe.
pub fn short(index: usize, last: f64, end: f64) -> Option<String> {
    (last < end * (1.0 - 1e-6)).then(|| {
        let (last, end) = (Shown(last), Shown(end));
        format!(
            "inlet.{index}: the record ends at t = {last} s while grains still came in, and this run at {end} s: nothing comes in after it; \
             let the stage upstream run longer, or end this one there (--until)"
        )
    })
}
