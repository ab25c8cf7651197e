//! Names of columns of text as PLY can hold them, and the units that they give.

use super::words::pieces;
use crate::points::LengthUnit;

/// Brackets that hold a unit behind a name.
const BRACKETS: [(char, char); 2] = [('[', ']'), ('(', ')')];
/// Units of length that a header may name, in lower case [m].
const LENGTHS: [(&[&str], f64); 6] = [
    (&["m", "metre", "metres", "meter", "meters"], 1.0),
    (&["mm", "millimetre", "millimetres", "millimeter", "millimeters"], 1e-3),
    (&["cm", "centimetre", "centimetres", "centimeter", "centimeters"], 1e-2),
    (&["km"], 1e3),
    (&["in", "inch", "inches"], 0.0254),
    (&["ft", "foot", "feet", "ift"], 0.3048),
];
/// Feet of surveys [m].
const SURVEY_FOOT: (&[&str], f64) = (&["ftus", "us-ft", "usft", "us ft", "us survey foot"], 1200.0 / 3937.0);

/// A name and the unit in brackets behind it.
fn parts(name: &str) -> (&str, Option<&str>) {
    let split = |&(open, close): &(char, char)| {
        let (bare, unit) = name.strip_suffix(close)?.split_once(open)?;
        let is_apart = bare.ends_with(' ');
        // "v[0]", "f(x)": a place or an argument, and no unit.
        let is_place =
            unit.parse::<f64>().is_ok() || ["x", "y", "z"].contains(&unit.to_ascii_lowercase().as_str());
        (is_apart || !is_place && !bare.is_empty() && !unit.is_empty())
            .then_some((bare.trim(), Some(unit.trim())))
    };
    BRACKETS.iter().find_map(split).unwrap_or((name, None))
}

/// A name without a unit in brackets.
pub(crate) fn without_unit(name: &str) -> &str {
    parts(name).0
}

/// Names that PLY can hold; colours in the spelling of PLY, small letters only if all three are there. Names that differ only in their units keep these.
pub(crate) fn for_ply(names: &[String]) -> Vec<String> {
    let bare: Vec<&str> = names.iter().map(|name| without_unit(name)).collect();
    let has_all = ["r", "g", "b"].iter().all(|color| bare.contains(color));
    let plain = |(k, name): (usize, &&str)| match *name {
        "R" | "Red" => "red".to_owned(),
        "G" | "Green" => "green".to_owned(),
        "B" | "Blue" => "blue".to_owned(),
        "r" if has_all => "red".to_owned(),
        "g" if has_all => "green".to_owned(),
        "b" if has_all => "blue".to_owned(),
        name => {
            let is_alone = bare.iter().filter(|other| **other == name).count() == 1;
            let name = if is_alone { name } else { names[k].as_str() };
            name.chars().map(|c| if c.is_ascii_graphic() { c } else { '_' }).collect()
        }
    };
    bare.iter().enumerate().map(plain).collect()
}

/// Whether a line gives units only, as some programs write under the names.
pub(crate) fn is_units(line: &str) -> bool {
    pieces(line, None)
        .all(|word| word.len() > 2 && word.starts_with(['[', '(']) && word.ends_with([']', ')']))
}

/// The units of x, y and z in a line of units, if they are all lengths.
pub(crate) fn units_below(line: &str, axes: &[usize; 3]) -> Option<[LengthUnit; 3]> {
    let units: Vec<&str> = pieces(line, None).map(|word| &word[1..word.len() - 1]).collect();
    three(axes.map(|axis| units.get(axis).and_then(|unit| length(unit))))
}

/// The units that the names of x, y and z give, if they are all lengths.
pub(crate) fn length_units(names: &[&str; 3]) -> Option<[LengthUnit; 3]> {
    three(names.map(|name| parts(name).1.and_then(length)))
}

fn three(units: [Option<LengthUnit>; 3]) -> Option<[LengthUnit; 3]> {
    let [x, y, z] = units;
    Some([x?, y?, z?])
}

fn length(unit: &str) -> Option<LengthUnit> {
    let lower = unit.trim().to_ascii_lowercase();
    let is_it = |(names, _): &&(&[&str], f64)| names.contains(&lower.as_str());
    let (_, metres) = LENGTHS.iter().chain([&SURVEY_FOOT]).find(is_it)?;
    Some(LengthUnit { name: unit.trim().to_owned(), metres: *metres })
}
