//! The colour key, and the colours of a table by it.

use crate::Map;
use crate::appearance::{classes::Classes, colour, field, scale::Range};
use crate::things::bodies::even_out;
use record::column::BODY;
use stream::{Table, Values};

/// What the colours mean.
pub(crate) enum Key {
    /// A range of a field.
    Bar(BarKey),
    /// Kinds that are there, by number, with their names. There are no names where there are more kinds than colours; colours then repeat.
    Kinds { field: String, names: Vec<(usize, String)> },
    /// Classes of size.
    Classes { classes: Classes, map: Map },
    /// The colours of the scan itself.
    None,
}

/// A range of values and their colours.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BarKey {
    /// What it is of: the name of a field, or words.
    pub title: String,
    pub unit: &'static str,
    /// The ends, in that unit.
    pub range: Range,
    /// Whether there are values below, and above.
    pub beyond: [bool; 2],
    /// Whether colours go by the logarithm.
    pub log: bool,
    pub map: Map,
}

impl Key {
    /// A colour for each row, parts 0 to 1; a table without the field has the colour of walls. On a scale, the rows of one of the
    /// `bodies` have the colour of their mean.
    pub fn colours(&self, table: &Table, bodies: &[Vec<u32>]) -> Vec<[f32; 3]> {
        let found = match self {
            Key::None => scan_colours(table),
            Key::Kinds { field, names } if field == BODY && names.is_empty() => {
                field::values(table, field).map(|v| by_kind(v, colour::scattered))
            }
            Key::Kinds { field, .. } => field::values(table, field).map(|v| by_kind(v, colour::kind)),
            Key::Classes { classes, map } => {
                field::values(table, field::SIZE).map(|v| by_class(v, classes, *map))
            }
            Key::Bar(BarKey { title, range, map, .. }) => field::values(table, title).map(|mut values| {
                even_out(&mut values, bodies);
                by_value(values, *range, *map)
            }),
        };
        found.unwrap_or_else(|| plain(table.rows()))
    }
}

fn by_value(values: Vec<f64>, range: Range, map: Map) -> Vec<[f32; 3]> {
    let steps: Vec<[f32; 3]> = (0..=1023).map(|i| map.at(f64::from(i) / 1023.0)).collect();
    values.into_iter().map(|v| steps[(1023.0 * range.share(v)) as usize]).collect()
}

fn by_class(diameters: Vec<f64>, classes: &Classes, map: Map) -> Vec<[f32; 3]> {
    let colours: Vec<[f32; 3]> = (0..classes.names.len()).map(|k| map.at(classes.share(k))).collect();
    diameters.into_iter().map(|d| colours[classes.of(d)]).collect()
}

fn by_kind(values: Vec<f64>, kind: fn(usize) -> colour::Rgb) -> Vec<[f32; 3]> {
    values.into_iter().map(|v| colour::fraction(kind(v as usize))).collect()
}

/// The colour of walls.
pub(crate) fn plain(rows: usize) -> Vec<[f32; 3]> {
    vec![colour::fraction(colour::WALL); rows]
}

/// The scan's own colours, when it has them as bytes.
pub(crate) fn scan_colours(table: &Table) -> Option<Vec<[f32; 3]>> {
    let byte = |name| match table.get(name) {
        Some(Values::U8(v)) => Some(v),
        _ => None,
    };
    let (r, g, b) = (byte("red")?, byte("green")?, byte("blue")?);
    Some((0..table.rows()).map(|i| colour::fraction([r[i], g[i], b[i]])).collect())
}
