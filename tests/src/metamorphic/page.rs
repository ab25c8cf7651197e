//! The table of a campaign.

use super::campaign::Findings;
use super::relations::{AUTOMATIC, RELATIONS};
use std::fmt::Write;

/// What a page says of a campaign.
pub fn summary(found: &Findings, seed: u64) -> String {
    let (scenes, refused) = (found.scenes, found.refusals());
    format!("{scenes} scenes, seed {seed}, of which {refused} were refused:\n\n{}", table(found))
}

/// Rows for each relation.
pub fn table(found: &Findings) -> String {
    let mut all =
        String::from("| relation | must give | compared | differ | refused |\n|---|---|---:|---:|---:|\n");
    for relation in std::iter::once(&AUTOMATIC).chain(RELATIONS) {
        let count = found.counts.get(relation.name).copied().unwrap_or_default();
        let _ = writeln!(
            all,
            "| {} | {} | {} | {} | {} |",
            relation.name, relation.exact, count.compared, count.differ, count.refused
        );
    }
    all
}
