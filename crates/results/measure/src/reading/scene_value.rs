//! Numbers and vectors of a scene, as its author may have written them.

use geom::Vec3;

/// A number of a scene, plain or as text with a unit.
fn number(value: &toml::Value, unit: &'static str) -> Option<f64> {
    match value {
        toml::Value::String(text) => in_unit(text, unit),
        v => v.as_float().or_else(|| v.as_integer().map(|i| i as f64)),
    }
}

fn in_unit(text: &str, unit: &'static str) -> Option<f64> {
    text.trim().parse().ok().or_else(|| geom::units::parse(text, unit).ok())
}

/// A vector of a scene: three numbers, or texts with units, or one text with commas.
pub(super) fn vector(value: &toml::Value, unit: &'static str) -> Option<Vec3> {
    let list: Vec<f64> = match value {
        toml::Value::String(text) => text.split(',').filter_map(|text| in_unit(text, unit)).collect(),
        list => list.as_array()?.iter().filter_map(|v| number(v, unit)).collect(),
    };
    (list.len() == 3).then(|| Vec3::from_column_slice(&list))
}
