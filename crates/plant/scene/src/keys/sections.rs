//! The keys of scenes as people read them: sections of docs/reference/scene.md, and the text of `dem-run --keys`.

use super::SceneKeys;
use super::table::{Row, TableShape, dotted};
use super::value::KeyValue;
use std::fmt::Write;

/// A table of keys, and those of the small tables in it.
#[derive(Debug, Clone)]
pub struct Section {
    /// Dotted key of the table; "" for the top level.
    pub path: String,
    /// Whether there may be many of it: `[[fill]]`.
    pub many: bool,
    /// Its keys.
    pub rows: Vec<Row>,
}

/// Every key of a scene.
pub fn sections() -> Vec<Section> {
    let mut all = Vec::new();
    SceneKeys::table().into_iter().for_each(|shape| add(&mut all, "", false, &shape));
    all
}

/// Every key with its dotted path, without indices: `wall.motion.rotate.about`.
pub fn rows() -> Vec<(String, Row)> {
    let of = |section: Section| {
        let path = section.path;
        section.rows.into_iter().map(move |row| (dotted(&path, &row.name), row))
    };
    sections().into_iter().flat_map(of).collect()
}

/// Adds a section, and those of the tables in it.
fn add(all: &mut Vec<Section>, path: &str, many: bool, shape: &TableShape) {
    let (mut rows, mut below) = (Vec::new(), Vec::new());
    flatten(&mut rows, &mut below, "", shape);
    if path.is_empty() {
        // A table of the top level is a section, and no key.
        rows.retain(|row: &Row| row.table.is_none());
    }
    all.push(Section { path: path.to_owned(), many, rows });
    for (name, kind, shape) in below {
        add(all, &dotted(path, &name), kind.starts_with("list"), &shape);
    }
}

/// The keys of a table with those of the small tables in it, and the tables that have sections of their own; where several keys hold one
/// shape (`strain.x`, `strain.y`, `strain.z`), the first gets the section.
fn flatten(rows: &mut Vec<Row>, below: &mut Vec<(String, String, TableShape)>, at: &str, shape: &TableShape) {
    for row in &shape.rows {
        let (name, table) = (dotted(at, &row.name), row.table.clone());
        rows.push(Row { name: name.clone(), ..row.clone() });
        match table {
            Some(table) if !table.section => flatten(rows, below, &name, &table),
            Some(table) if below.iter().all(|(.., other)| other.name != table.name) => {
                below.push((name, row.kind.clone(), table));
            }
            _ => {}
        }
    }
}

impl Section {
    /// Its head in a scene: `[time]`, `[[fill]]`; "" for the top level.
    pub fn head(&self) -> String {
        match (&self.path[..], self.many) {
            ("", _) => String::new(),
            (path, true) => format!("[[{path}]]"),
            (path, false) => format!("[{path}]"),
        }
    }

    /// Its table in Markdown.
    pub fn markdown(&self) -> String {
        let mut out = String::from("| key | type | unit | default | meaning |\n|---|---|---|---|---|\n");
        for row in &self.rows {
            let unit = if row.unit.is_empty() { "–" } else { row.unit };
            let kind =
                if row.range.is_empty() { row.kind.clone() } else { format!("{}, {}", row.kind, row.range) };
            // Writing to a string does not fail.
            let _ = writeln!(out, "| `{}` | {kind} | {unit} | {} | {} |", row.name, row.default, row.doc);
        }
        out
    }
}

/// The sizes that numbers of each unit may have, in Markdown; keys of one unit have one size, unless they say otherwise.
pub fn sizes() -> String {
    let mut out = String::from("| unit | from | to |\n|---|---|---|\n");
    let mut units: Vec<&str> = rows().into_iter().map(|(_, row)| row.unit).collect();
    units.sort_unstable();
    units.dedup();
    for unit in units {
        let [least, most] = dem::magnitudes(unit);
        let least = if least <= f64::MIN_POSITIVE { "0".to_owned() } else { format!("{least:e}") };
        // Writing to a string does not fail.
        let _ = writeln!(out, "| {} | {least} | {most:e} |", if unit.is_empty() { "–" } else { unit });
    }
    out
}

/// The reference as a text: a scene with an example of each key, which a comment explains.
pub fn reference() -> String {
    let mut out = String::new();
    for section in sections() {
        let head = section.head();
        let lead = if out.is_empty() { "" } else { "\n" };
        if !head.is_empty() {
            out += &format!("{lead}{head}\n");
        }
        for row in section.rows.iter().filter(|row| !row.example.is_empty()) {
            let unit = if row.unit.is_empty() { String::new() } else { format!(" [{}]", row.unit) };
            let range = if row.range.is_empty() { String::new() } else { format!(", {}", row.range) };
            let line = format!("{} = {}", row.name, row.example);
            let default = match &row.default[..] {
                "–" => String::new(),
                words if ["required", "this ", "with "].iter().any(|w| words.starts_with(w)) => {
                    format!("; {words}")
                }
                value => format!("; default: {value}"),
            };
            let _ = writeln!(out, "{line:<34} # {}{unit}{range}{default}. {}", row.kind, row.doc);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::value::KeyUnit;
    use crate::keys::{MOST_FRAMES, MOST_STEPS, SAFETY, SAFETY_ELASTIC, Sampling};
    use crate::text::{Text, parse};

    /// The least that a section needs around one key to be read: its required keys.
    fn with(section: &Section, row: &Row) -> String {
        let inside =
            |row: &Row| row.name.rsplit_once('.').map_or(String::new(), |(table, _)| table.to_owned());
        let own = inside(row);
        let needed = |other: &&Row| {
            // A law has a restitution, or its dashpot.
            let required = other.is_required() || section.path == "contact" && other.name == "restitution";
            other.name != row.name && required && (inside(other).is_empty() || inside(other) == own)
        };
        let lines = section.rows.iter().filter(needed).chain([row]).filter(|row| !row.example.is_empty());
        let lines: Vec<String> = lines.map(|row| format!("{} = {}", row.name, row.example)).collect();
        let outer = section.path.split_once('.').filter(|(outer, _)| *outer == "wall");
        let before = outer.map_or("", |_| "[[wall]]\n");
        format!("{before}{}\n{}\n", section.head(), lines.join("\n"))
    }

    #[test]
    fn every_example_is_read() {
        for section in sections() {
            for row in section.rows.iter().filter(|row| !row.example.is_empty()) {
                let scene = with(&section, row);
                if let Err(e) = parse(&Text::new("scene.toml", scene.clone())) {
                    panic!("{}.{}: {e}\n{scene}", section.path, row.name);
                }
            }
        }
    }

    /// A default that is a value in TOML is the value that holds without the key.
    #[test]
    fn defaults_are_those_of_the_keys() {
        let mut compared = 0;
        for section in sections().iter().filter(|section| section.path != "contact") {
            for row in section.rows.iter().filter(|row| !row.example.is_empty() && !row.is_required()) {
                let read = |row: &Row| parse(&Text::new("scene.toml", with(section, row)));
                let default = Row { example: row.default.clone(), ..row.clone() };
                let without = Row { example: String::new(), ..row.clone() };
                let (Ok(given), Ok(set), Ok(absent)) = (read(&default), read(row), read(&without)) else {
                    continue;
                };
                // Without an optional key other code says what holds: see the next test.
                let field = row.name.rsplit('.').next().unwrap_or_default();
                if format!("{absent:?}").contains(&format!("{field}: None")) {
                    continue;
                }
                assert_eq!(given, absent, "{}.{} = {}", section.path, row.name, row.default);
                assert_ne!(set, absent, "{}.{}: the example is the default", section.path, row.name);
                compared += 1;
            }
        }
        assert!(compared > 20, "{compared}");
    }

    /// Defaults of optional keys are what the code takes that uses them.
    #[test]
    fn defaults_of_optional_keys_are_those_of_the_engine() {
        let guards = dem::setup::Guards::default();
        let most = [Sampling::Averaged, Sampling::Sampled].map(Sampling::most_energy);
        let wanted = [
            ("time.safety", format!("{SAFETY}; {SAFETY_ELASTIC} for elastic grains: see below")),
            ("guards.overlap", guards.overlap.to_string()),
            ("guards.motion", guards.motion.to_string()),
            ("guards.steps", format!("{MOST_STEPS:e}")),
            ("guards.frames", format!("{MOST_FRAMES:e}")),
            (
                "guards.energy",
                format!(
                    "{} ({} with `contacts = \"sampled\"`) with the energy ledger, else off",
                    most[0], most[1]
                ),
            ),
        ];
        let rows = rows();
        for (path, default) in wanted {
            let row = rows.iter().find(|row| row.0 == path).expect(path);
            assert_eq!(row.1.default, default, "{path}");
        }
    }

    /// What a message proposes for a unit is of that unit.
    #[test]
    fn examples_of_units_are_of_them() {
        for (path, row) in rows() {
            let such = KeyUnit::of(row.unit).such;
            assert!(geom::units::parse(such, row.unit).is_ok(), "{path} [{}]: {such}", row.unit);
        }
    }

    #[test]
    fn the_text_has_every_key() {
        let text = reference();
        for section in sections() {
            for row in section.rows.iter().filter(|row| !row.example.is_empty()) {
                assert!(
                    text.contains(&format!("\n{} = {}", row.name, row.example))
                        || text.starts_with(&row.name)
                );
            }
        }
    }
}
