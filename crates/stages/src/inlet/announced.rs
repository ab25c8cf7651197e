//! Whether the rows of a stream are in order, and among those that its records announce.

use crate::outlet::crossing::CrossingRow;
use geom::Shown;
use record::RecordError;
use scene::input::InletSource;
use scene::plan::SCALE_SLACK;

/// Refuses a row that the records do not announce.
pub(super) fn announced(source: &InletSource, row: &CrossingRow) -> Result<(), RecordError> {
    let id = row.particle.id;
    let wrong = |why: String| Err(RecordError::new(&source.name, why, "write the stream again"));
    if let Some((clump, _)) = row.clump {
        let scales = source.clumps.get(clump.shape as usize).and_then(|shape| shape.scales);
        let fits = scales.is_some_and(|(low, high)| {
            low * (1.0 - SCALE_SLACK) <= clump.scale && clump.scale <= high * (1.0 + SCALE_SLACK)
        });
        return match fits {
            true => Ok(()),
            false => wrong(format!(
                "clump {id} has shape {} and scale {}, which its record 'clumps' does not announce",
                clump.shape, clump.scale
            )),
        };
    }
    let (radius, sizes) = (row.particle.radius, source.sizes);
    if (sizes.smallest..=sizes.largest).contains(&radius) {
        return Ok(());
    }
    let range = format!("{} to {} m", Shown(sizes.smallest), Shown(sizes.largest));
    wrong(format!(
        "particle {id} has a radius of {} m, outside the {range} of its record 'sizes'",
        Shown(radius)
    ))
}

/// Refuses a row that is earlier than the row before it, or than a watermark [s].
pub(super) fn in_time(name: &str, row: &CrossingRow, before: f64) -> Result<(), RecordError> {
    if row.time >= before {
        return Ok(());
    }
    let (id, time, before) = (row.particle.id, Shown(row.time), Shown(before));
    let why = format!("particle {id} passes at {time} s, after {before} s was reached");
    Err(RecordError::new(name, why, "crossings must come in time order: run stage-replay again"))
}
