//! How many grains are shown, where some of them are clumps of spheres, and how many are outside of a picture.

use serde_json::{Value, json};
use view::GrainCount;

/// For the end of a summary: ", 120 clumps of 840 spheres, 30 spheres"; nothing without clumps.
pub fn words(grains: GrainCount) -> String {
    if grains.clumps == 0 { String::new() } else { format!(", {grains}") }
}

/// For the report; nothing without clumps.
pub fn fields(grains: GrainCount) -> Value {
    match grains {
        GrainCount { clumps: 0, .. } => json!({}),
        GrainCount { spheres, clumps, members } => {
            json!({ "clumps": clumps, "clump_spheres": members, "single_spheres": spheres })
        }
    }
}

/// Warns of grains that are not in the picture.
pub fn warn_of_outside([outside, all]: [usize; 2], what: &str) {
    if outside > 0 {
        let are = if outside == 1 { "is" } else { "are" };
        cli::warn(&format!(
            "{outside} of {all} grains {are} outside {what}, fallen past all walls or far from the others: a --camera x,y,z farther away shows all"
        ));
    }
}
