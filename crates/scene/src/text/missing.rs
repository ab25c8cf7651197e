//! What a table of a scene lacks: which table, and what to write.

use crate::text::Text;
use toml_edit::{Item, TableLike};

/// Keys that tables need, as they may be written.
const EXAMPLES: [(&str, &str); 29] = [
    ("about", "about = [0, 0, 1] (the axis)"),
    ("amplitude", "amplitude = [0, 0, 0.001] (m)"),
    ("between", "between = [\"*\", \"*\"] (names of materials)"),
    ("clump", "clump = \"…\" (the name of a [[clump]])"),
    ("direction", "direction = [0, 0, -1]"),
    ("dynamic", "dynamic = 0.4"),
    ("frequency", "frequency = 50 (Hz)"),
    ("gap", "gap = 1e-4 (m)"),
    ("law", "law = \"stokes\""),
    ("material", "material = \"…\" (the name of a [[material]])"),
    ("name", "name = \"…\""),
    ("plane", "plane = \"0,0,0,0,0,1\" (a point [m] and the normal)"),
    ("poisson", "poisson = 0.25"),
    ("position", "position = [0, 0, 0.1] (m)"),
    ("restitution", "restitution = 0.5"),
    ("rpm", "rpm = 8 (turns per minute)"),
    ("shape", "shape = \"box:0,0,0,0.1,0.1,0.1\" (m)"),
    ("source", "source = \"FILE\""),
    ("speed", "speed = 0.01 (m/s)"),
    ("speed_limit", "speed_limit = 0.1 (m/s)"),
    ("static", "static = 0.6"),
    ("through", "through = [0, 0, 0] (m)"),
    ("time", "time = 0.02 (s)"),
    ("until", "until = 1 (s)"),
    ("velocity", "velocity = [0, 0, -1] (m/s)"),
    ("viscosity", "viscosity = 1.8e-5 (Pa·s, air)"),
    ("wake", "wake = 0.1 (share of the weight)"),
    ("young", "young = 1e7 (Pa)"),
    ("density", "density = 2500 (kg/m³)"),
];

/// What to say of a key that is missing in the table that begins at a byte.
pub(crate) fn missing(text: &Text, key: &str, offset: Option<usize>) -> String {
    let table = offset.and_then(|offset| table_at(text, offset));
    let where_ = table.map_or(String::new(), |path| format!("{path}: "));
    let example = EXAMPLES.iter().find(|e| e.0 == key).map_or(key, |e| e.1);
    format!("{where_}'{key}' is missing: add it, such as {example}")
}

/// The dotted name of the innermost table that holds a byte of the text, or whose head does.
fn table_at(text: &Text, offset: usize) -> Option<String> {
    let document = toml_edit::Document::parse(text.toml.as_str()).ok()?;
    let mut found = None;
    search(document.as_table(), "", offset, &mut found);
    found
}

fn search(table: &dyn TableLike, path: &str, offset: usize, found: &mut Option<String>) {
    let holds = |span: Option<std::ops::Range<usize>>| span.is_some_and(|s| s.contains(&offset));
    for (key, item) in table.iter() {
        let path = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        if let Item::ArrayOfTables(list) = item {
            for (n, entry) in list.iter().enumerate() {
                let path = format!("{path}.{n}");
                if holds(entry.span()) {
                    *found = Some(path.clone());
                }
                search(entry, &path, offset, found);
            }
            continue;
        }
        if let Some(inner) = item.as_table_like() {
            if holds(item.span()) {
                *found = Some(path.clone());
            }
            search(inner, &path, offset, found);
        }
        for (n, entry) in item.as_array().into_iter().flat_map(|list| list.iter().enumerate()) {
            if let Some(inner) = entry.as_inline_table() {
                let path = format!("{path}.{n}");
                if holds(entry.span()) {
                    *found = Some(path.clone());
                }
                search(inner, &path, offset, found);
            }
        }
    }
}
