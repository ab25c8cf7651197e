//! What was changed, in words.

use geom::Shown;
use stones::{Changes, CleanSettings};

/// Holes of more than this share of the area are a warning.
const HOLES: f64 = 0.05;
/// Volume may change by this share.
const VOLUME: f64 = 0.005;

fn percent(share: f64) -> Shown {
    // Not minus zero.
    Shown((10_000.0 * share).round() / 100.0 + 0.0)
}

/// Doubtful results.
pub fn warn(input: &cli::Source, changes: &Changes, settings: &CleanSettings) {
    if let Some(share) = changes.closed_area.filter(|s| *s > HOLES) {
        cli::warn(&format!(
            "{input}: {} % of the surface is not in the input: holes were closed there; scan the missing sides if that is too much",
            percent(share)
        ));
    }
    if changes.islands_area > HOLES {
        cli::warn(&format!(
            "{input}: {} removed with {} % of the area, apart from the largest: if the stone lies in several pieces, join them before",
            geom::counted_as(changes.islands, "piece", ["is", "are"]),
            percent(changes.islands_area)
        ));
    }
    if changes.hollows > 0 {
        cli::warn(&format!(
            "{input}: {} inside, of {} m³, {} filled: the stone is solid",
            geom::counted(changes.hollows, "hollow"),
            Shown(changes.hollow_volume),
            if changes.hollows == 1 { "is" } else { "are" }
        ));
    }
    if changes.normals_turned > 0 {
        cli::warn(&format!(
            "{input}: normals of neighbours look to opposite sides: {} turned, by passing on the side from point to point; compare the volume",
            geom::counted_as(changes.normals_turned, "normal", ["was", "were"])
        ));
    }
    let Some(faces) = settings.faces else { return };
    let change = changes.volume / changes.volume_before - 1.0;
    if change.abs() > VOLUME {
        cli::warn(&format!(
            "{input}: --faces {faces} changes the volume by {} %: give more faces",
            percent(change)
        ));
    }
    if changes.faces > faces {
        cli::warn(&format!(
            "{input}: --faces {faces}: fewer than {} would make the mesh cross itself or flip faces",
            changes.faces
        ));
    }
    if changes.faces < faces - 1 {
        cli::warn(&format!(
            "{input}: --faces {faces}: the mesh has only {}, and none are added",
            changes.faces
        ));
    }
}

/// One line.
pub fn summary(changes: &Changes) -> String {
    let mut said = Vec::new();
    if let Some(within) = changes.welded_within {
        said.push(format!(
            "{} joined with others up to {} m away",
            geom::counted(changes.welded, "corner"),
            Shown(within)
        ));
    }
    if changes.turned > 0 {
        said.push(format!("{} turned", geom::counted(changes.turned, "face")));
    }
    if changes.islands > 0 {
        said.push(format!(
            "{} removed ({} % of the area)",
            geom::counted(changes.islands, "piece"),
            percent(changes.islands_area)
        ));
    }
    match (&changes.rebuilt, changes.cells) {
        (Some(why), Some(cells)) => said.push(format!("surface rebuilt with {cells} cells because {why}")),
        _ => said.push("the surface was closed and is kept".to_owned()),
    }
    let change = changes.volume / changes.volume_before - 1.0;
    let thinned = if (10_000.0 * change).round() == 0.0 {
        String::new()
    } else {
        format!(" (thinning changed it by {} %)", percent(change))
    };
    said.push(format!("{} faces, {} m³{thinned}", changes.faces, Shown(changes.volume)));
    said.join("; ")
}
