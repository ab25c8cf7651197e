//! Starting values of materials: ranges from the literature, each with its source.

use crate::error::hint;
use serde::Deserialize;
use std::collections::BTreeMap;

/// The table, as it is shipped.
pub const TABLE: &str = include_str!("materials.toml");

/// A range of values.
#[derive(Debug, Clone, PartialEq)]
pub struct Range {
    /// Lowest and highest.
    pub ends: [f64; 2],
    /// Author, year, DOI.
    pub source: String,
}

impl Range {
    /// Bounds around it: half as wide again on both sides, not below a fifth of the lowest.
    pub(crate) fn wide(&self) -> [f64; 2] {
        let more = 0.5 * (self.ends[1] - self.ends[0]);
        [(self.ends[0] - more).max(0.2 * self.ends[0]), self.ends[1] + more]
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
pub fn all() -> Result<Vec<Material>, String> {
    let keys: TableKeys = toml::from_str(TABLE).map_err(|e| format!("materials.toml: {e}"))?;
    let range = |r: RangeKeys| {
        let words: Option<Vec<&str>> =
            r.source.split(", ").map(|s| keys.source.get(s).map(String::as_str)).collect();
        let source = words.ok_or_else(|| format!("materials.toml: no source '{}'", r.source))?.join("; ");
        let note = r.note.map_or(String::new(), |note| format!(" ({note})"));
        Ok::<Range, String>(Range { ends: r.range, source: source + &note })
    };
    let material = |m: MaterialKeys| {
        let ranges =
            m.ranges.into_iter().map(|(key, r)| Ok((key, range(r)?))).collect::<Result<_, String>>()?;
        Ok(Material { name: m.name, also: m.also, ranges })
    };
    keys.material.into_iter().map(material).collect()
}

/// The material of a name.
///
/// # Errors
/// There is none.
pub fn find(name: &str) -> Result<Material, String> {
    let all = all()?;
    let plain = |text: &str| text.to_lowercase().replace(['_', '-'], " ");
    let of = |m: &&Material| plain(&m.name) == plain(name) || m.also.iter().any(|a| plain(a) == plain(name));
    match all.iter().find(of) {
        Some(m) => Ok(m.clone()),
        None => {
            let names = all
                .iter()
                .flat_map(|m| std::iter::once(m.name.as_str()).chain(m.also.iter().map(String::as_str)));
            Err(format!("no material '{name}' in the table{}", hint(name, names)))
        }
    }
}

/// The range that a prior such as `material:sand` or `material:sand:sliding_friction` stands for.
///
/// # Errors
/// Another word, an unknown material or key.
pub(crate) fn prior(word: &str, parameter: &str) -> Result<Range, String> {
    let Some(rest) = word.strip_prefix("material:") else {
        return Err(format!(
            "prior = \"{word}\": give \"uniform\", \"material:NAME\", or {{ mean = …, deviation = … }}"
        ));
    };
    let (name, key) = rest.split_once(':').unwrap_or((rest, parameter));
    let material = find(name.trim())?;
    match material.ranges.get(key.trim()) {
        Some(range) => Ok(range.clone()),
        None => {
            let hint = hint(key, material.ranges.keys().map(String::as_str));
            Err(format!(
                "prior = \"{word}\": the table has no '{key}' of {name}{hint}; write material:{name}:KEY"
            ))
        }
    }
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
    fn priors_are_found_by_name_and_key() {
        assert_eq!(prior("material:quartz sand:sliding_friction", "mu").unwrap().ends, [0.12, 0.52]);
        assert_eq!(prior("material:sand", "sliding_friction").unwrap().ends, [0.12, 0.52]);
        assert!(
            prior("material:sand", "slidingfriction")
                .unwrap_err()
                .contains("did you mean 'sliding_friction'?")
        );
        assert!(prior("uniformm", "mu").unwrap_err().contains("give \"uniform\""));
    }
}
