//! Whether the rows of a stream are among those that its records announce.

use crate::outlet::crossing::CrossingRow;
use dem::setup::EntryClump;
use geom::Shown;
use record::RecordError;
use scene::input::InletSource;
use scene::plan::SCALE_SLACK;

/// Refuses a row that the records do not announce.
pub(super) fn check(source: &InletSource, row: &CrossingRow) -> Result<(), RecordError> {
    let id = row.particle.id;
    let wrong = |why: String| Err(RecordError::new(&source.name, why, "write the stream again"));
    if let Some((clump, _)) = row.clump {
        let scales = source.clumps.get(clump.shape as usize).and_then(|shape| shape.scales);
        let fits = scales.is_some_and(|(low, high)| {
            low * (1.0 - SCALE_SLACK) <= clump.scale && clump.scale <= high * (1.0 + SCALE_SLACK)
        });
        let EntryClump { shape, scale, .. } = clump;
        return match fits {
            true => Ok(()),
            false => wrong(format!(
                "clump {id} has shape {shape} and scale {scale}, which its record 'clumps' does not contain"
            )),
        };
    }
    let (radius, sizes) = (row.particle.radius, source.sizes);
    if (sizes.smallest..=sizes.largest).contains(&radius) {
        return Ok(());
    }
    let (radius, low, high) = (Shown(radius), Shown(sizes.smallest), Shown(sizes.largest));
    wrong(format!(
        "particle {id} has a radius of {radius} m, outside the {low} to {high} m of its record 'sizes'"
    ))
}
