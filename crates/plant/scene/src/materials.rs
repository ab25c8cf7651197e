//! Starting values of materials: ranges from the literature, each with its source.

use crate::check::Check;
use crate::error::{Result, nearest};
use crate::text::Text;
use geom::Shown;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};
use toml_edit::Item;

/// The table, as it is shipped.
pub const TABLE: &str = include_str!("materials.toml");

/// A range of values.
#[derive(Debug, Clone, PartialEq)]
pub struct Range {
    /// Lowest and highest.
    pub ends: [f64; 2],
    /// Author, year, DOI.
    pub source: String,
    /// What no value of the key can pass: 1 of a restitution, 0.5 of Poisson's ratio.
    pub most: f64,
}

impl Range {
    /// Bounds around it: half as wide again on both sides, not below a fifth of the lowest, and not above what is possible.
    pub fn wide(&self) -> [f64; 2] {
        let more = 0.5 * (self.ends[1] - self.ends[0]);
        [(self.ends[0] - more).max(0.2 * self.ends[0]), (self.ends[1] + more).min(self.most)]
    }
}

/// A material of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Its name.
    pub name: String,
    /// Other names.
    pub also: Vec<String>,
    /// Ranges by scene key.
    pub ranges: BTreeMap<String, Range>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TableKeys {
    source: BTreeMap<String, String>,
    material: Vec<MaterialKeys>,
}

#[derive(Deserialize)]
struct MaterialKeys {
    name: String,
    #[serde(default)]
    also: Vec<String>,
    #[serde(flatten)]
    ranges: BTreeMap<String, RangeKeys>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RangeKeys {
    range: [f64; 2],
    source: String,
    note: Option<String>,
}

/// All materials of the table.
///
/// # Errors
/// A table that is damaged.
pub fn all() -> std::result::Result<Vec<Material>, String> {
    let keys: TableKeys = toml::from_str(TABLE).map_err(|e| format!("materials.toml: {e}"))?;
    let range = |key: &str, r: RangeKeys| {
        let words: Option<Vec<&str>> =
            r.source.split(", ").map(|s| keys.source.get(s).map(String::as_str)).collect();
        let source = words.ok_or_else(|| format!("materials.toml: no source '{}'", r.source))?.join("; ");
        let note = r.note.map_or(String::new(), |note| format!(" ({note})"));
        let most = match key {
            "restitution" => 1.0,
            "poisson" => 0.5,
            _ => f64::INFINITY,
        };
        Ok::<Range, String>(Range { ends: r.range, source: source + &note, most })
    };
    let material = |m: MaterialKeys| {
        let ranges = m
            .ranges
            .into_iter()
            .map(|(key, r)| range(&key, r).map(|range| (key, range)))
            .collect::<std::result::Result<_, String>>()?;
        Ok(Material { name: m.name, also: m.also, ranges })
    };
    keys.material.into_iter().map(material).collect()
}

/// The material of a name.
///
/// # Errors
/// There is none.
pub fn find(name: &str) -> std::result::Result<Material, String> {
    let all = all()?;
    let plain = |text: &str| text.to_lowercase().replace(['_', '-'], " ");
    let of = |m: &&Material| plain(&m.name) == plain(name) || m.also.iter().any(|a| plain(a) == plain(name));
    match all.iter().find(of) {
        Some(m) => Ok(m.clone()),
        None => {
            let names = all
                .iter()
                .flat_map(|m| std::iter::once(m.name.as_str()).chain(m.also.iter().map(String::as_str)));
            let hint = nearest(name, names).map_or(String::new(), |near| format!(", did you mean '{near}'?"));
            Err(format!("no material '{name}' in the table{hint}"))
        }
    }
}

/// Numbers that a `[[material]]` may leave out, in the order of the scene.
const KEYS: [&str; 3] = ["density", "young", "poisson"];

/// A number that was taken from the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Taken {
    /// The key, such as `material.0.density`.
    pub key: String,
    /// Name of the material.
    pub material: String,
    /// The middle of the range.
    pub value: f64,
    /// The range, with its source.
    pub range: Range,
}

impl Display for Taken {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let [low, high] = self.range.ends.map(Shown);
        let (value, key, name) = (Shown(self.value), &self.key, &self.material);
        write!(f, "{key} = {value} for '{name}', the middle of {low} to {high}: {}", self.range.source)
    }
}

/// The numbers that the materials of a scene leave out, from the table. A density that is not in it stays out: walls need none.
///
/// # Errors
/// A material or a number that the table does not have.
pub(crate) fn missing(text: &Text) -> Result<Vec<Taken>> {
    let document = text.document()?;
    let list = document.get("material").and_then(Item::as_array_of_tables);
    let mut taken = Vec::new();
    for (k, entry) in list.into_iter().flat_map(|list| list.iter()).enumerate() {
        let name = entry.get("name").and_then(Item::as_str).unwrap_or_default();
        let wanted: Vec<&str> = KEYS.into_iter().filter(|key| !entry.contains_key(key)).collect();
        if wanted.is_empty() || name.is_empty() {
            continue;
        }
        let refuse = |key: &str, why: String| {
            let cure = "give it in the scene, or use the name of another material";
            Check { text }.wrong(&format!("material.{k}.{key}"), "(missing)", &why, cure)
        };
        let found = find(name).map_err(|why| refuse(wanted[0], why))?;
        for key in wanted {
            let Some(range) = found.ranges.get(key) else {
                if key == "density" {
                    continue;
                }
                return Err(refuse(key, format!("the table has no {key} of '{name}'")));
            };
            let (key, value) = (format!("material.{k}.{key}"), 0.5 * (range.ends[0] + range.ends[1]));
            taken.push(Taken { key, material: name.to_owned(), value, range: range.clone() });
        }
    }
    Ok(taken)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_range_of_the_table_has_a_source_and_a_width() {
        let all = all().unwrap();
        assert!(all.len() >= 6);
        for m in &all {
            for (key, range) in &m.ranges {
                assert!(
                    range.ends[0] > 0.0 && range.ends[0] < range.ends[1] && range.source.len() > 10,
                    "{} {key}",
                    m.name
                );
            }
        }
    }

    #[test]
    fn bounds_around_a_range_stay_within_what_is_possible() {
        let restitution = find("steel").unwrap().ranges["restitution"].clone();
        assert_eq!(restitution.wide()[1], 1.0);
        let range = Range { ends: [2.0, 3.0], source: String::new(), most: f64::INFINITY };
        assert_eq!(range.wide(), [1.5, 3.5]);
    }

    #[test]
    fn numbers_that_are_left_out_come_from_the_table() {
        let text = "[[material]]\nname = \"quartz sand\"\npoisson = 0.2\n[[material]]\nname = \"steel\"\ndensity = 7800\nyoung = 2e9\npoisson = 0.3\n";
        let taken = missing(&Text::new("s", text.to_owned())).unwrap();
        let keys: Vec<&str> = taken.iter().map(|t| t.key.as_str()).collect();
        assert_eq!(keys, ["material.0.density", "material.0.young"]);
        assert_eq!(taken[0].value, 2650.0);
        assert!(taken[0].to_string().contains("Rock Physics Handbook"), "{}", taken[0]);
        for (name, why) in [("sandd", "did you mean 'sand'?"), ("maize", "of 'maize'")] {
            let error = missing(&Text::new("s", format!("[[material]]\nname = \"{name}\"\n"))).unwrap_err();
            assert!(error.to_string().contains(why), "{error}");
        }
    }
}
