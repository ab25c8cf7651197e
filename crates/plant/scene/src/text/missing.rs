//! Keys that a table of a scene lacks: which table, and what to write.

use crate::keys::rows;

/// The message for a key that the table at a dotted path lacks.
pub(super) fn missing(table: &str, key: &str) -> String {
    let place = if table.is_empty() { String::new() } else { format!("{table}: ") };
    // `domain.strain` has one description for its three axes.
    let names = table.split('.').filter(|name| name.parse::<usize>().is_err());
    let path = names
        .chain([key])
        .collect::<Vec<_>>()
        .join(".")
        .replace("strain.y", "strain.x")
        .replace("strain.z", "strain.x");
    let row = rows().into_iter().find(|(of, _)| *of == path).map(|(_, row)| row);
    let example = row.filter(|row| !row.example.is_empty()).map_or(key.to_owned(), |row| {
        let unit = if row.unit.is_empty() { String::new() } else { format!(" ({})", row.unit) };
        format!("{key} = {}{unit}", row.example)
    });
    format!("{place}'{key}' is missing: add it, such as {example}")
}
