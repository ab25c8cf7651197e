//! What walls and the domain follow over time, and the domain that a run ended with.

use super::csv;
use crate::error::{Result, SceneError};
use record::{DomainRecord, topic};
use std::io::Cursor;
use std::path::Path;
use stream::mcap::{Event, Reader, in_order};

/// The last domain of a run: lowest and highest coordinate [m] of its periodic axes.
///
/// # Errors
/// A file of another kind; a run whose domain does not change.
pub fn read_domain(path: &Path) -> Result<[Option<(f64, f64)>; 3]> {
    let name = path.display().to_string();
    let bytes = stream::whole::file(path).map_err(|e| SceneError::read(path, e))?;
    let mut last = None;
    let from = in_order(Cursor::new(&bytes)).map_err(|e| SceneError::read(path, e))?;
    for event in Reader::new(from) {
        if let Event::Bytes { topic, data, .. } = event.map_err(|e| SceneError::content(&name, "a run", e))?
            && topic == topic::DOMAIN
        {
            last = Some(data);
        }
    }
    let none = || {
        let why = "has no message on /domain: its domain is not strained";
        SceneError::file(&name, why, "give low and high instead, as in the scene of that run")
    };
    let data = last.ok_or_else(none)?;
    let read = DomainRecord::read(&data)
        .map_err(|e| SceneError::file(&name, &e, "give a run that dem-run wrote"))?;
    Ok(read.range())
}

/// A column of a load: its name, and its unit with brackets.
pub type LoadColumn = (&'static str, &'static str);

/// What a servo follows.
pub const LOAD_COLUMNS: [LoadColumn; 2] = [("force", "[N]"), ("stress", "[Pa]")];
/// What an axis of the domain follows.
pub const STRAIN_COLUMNS: [LoadColumn; 2] = [("strain", "[–]"), ("stress", "[Pa]")];

/// Reads a table over time: rows of t [s] and one of two columns, which of them, and a hash.
///
/// # Errors
/// Another column, none or both of the two, a stress or force below 0.
pub fn read_load(path: &Path, columns: &[LoadColumn; 2]) -> Result<(Vec<[f64; 2]>, usize, String)> {
    let name = path.display().to_string();
    let bytes = stream::whole::file(path).map_err(|e| SceneError::read(path, e))?;
    let table = csv::csv(&name, &bytes, |_| false)?;
    let [(first, _), (second, _)] = *columns;
    let [one, other] = columns.map(|(name, unit)| format!("{name} {unit}"));
    let wanted = format!("wanted: t [s], and {one} or {other}");
    let wrong = |why: String| SceneError::file(&name, why, &wanted);
    if let Some(column) = table.columns().iter().find(|c| !["t", first, second].contains(&c.name.as_str())) {
        return Err(wrong(format!("has the column '{}', which is not used", column.name)));
    }
    let time = table.get("t").ok_or_else(|| wrong("has no column 't'".to_owned()))?;
    let (value, column) = match (table.get(first), table.get(second)) {
        (Some(value), None) => (value, 0),
        (None, Some(value)) => (value, 1),
        (Some(_), Some(_)) => return Err(wrong(format!("has {first} and {second}"))),
        (None, None) => return Err(wrong(format!("has no column '{first}' or '{second}'"))),
    };
    let rows: Vec<[f64; 2]> = (0..table.rows()).map(|k| [time.get(k), value.get(k)]).collect();
    let pulls = |row: &[f64; 2]| row[1] < 0.0 && columns[column].0 != "strain";
    if let Some((k, [_, x])) = rows.iter().enumerate().find(|(_, row)| pulls(row)) {
        let why = format!("row {}: {x} pulls, and compression is positive", k + 1);
        return Err(SceneError::file(&name, why, "give values of 0 or more"));
    }
    Ok((rows, column, record::hash(&table)))
}
