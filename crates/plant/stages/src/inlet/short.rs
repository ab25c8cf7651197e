//! A record that is shorter than the run.

use geom::Shown;

/// The warning for a record of `[[inlet]]` number `index` that ends at `last` [s], while particles still come in and before the run ends at `end` [s].
///
/// It names the key instead of the file: the output holds this text too, and has to be the same for a file and a pipe.
pub fn short(index: usize, last: f64, end: f64) -> Option<String> {
    (last < end * (1.0 - 1e-6)).then(|| {
        let (last, end) = (Shown(last), Shown(end));
        format!(
            "inlet.{index}: the record ends at t = {last} s while grains still came in, and this run at {end} s: nothing comes in after it; \
             let the stage upstream run longer, or end this one there (--until)"
        )
    })
}
