//! The table of a campaign.

use super::campaign::Findings;
use super::relations::RELATIONS;
use std::fmt::Write;

/// Rows for each relation.
pub fn table(found: &Findings) -> String {
    let mut all = String::from("| relation | must give | compared | differ | refused |\n|---|---|---:|---:|---:|\n");
    for relation in RELATIONS {
        let count = found.counts.get(relation.name).copied().unwrap_or_default();
        let _ = writeln!(
            all,
            "| {} | {} | {} | {} | {} |",
            relation.name, relation.exact, count.compared, count.differ, count.refused
        );
    }
    all
}
