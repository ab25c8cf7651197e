//! Columns of a table as vectors, with errors that name what is missing.

use crate::RecordError;
use crate::column::{DIAMETER, RADIUS};
use geom::{LARGEST, Vec3};
use sha2::{Digest, Sha256};
use stream::Table;

/// Digits that a file may have rounded a diameter to, as a share.
const ROUNDED: f64 = 1e-3;

/// A table and the stream it came from.
pub struct Columns<'a> {
    /// Name of the stream, for messages.
    pub name: &'a str,
    /// The table.
    pub table: &'a Table,
}

impl Columns<'_> {
    /// The column, when there is one.
    pub fn optional(&self, column: &str) -> Option<Vec<f64>> {
        self.table.get(column).map(|v| v.to_f64())
    }

    /// The column; its numbers must be finite.
    pub fn numbers(&self, column: &str) -> Result<Vec<f64>, RecordError> {
        let Some(values) = self.optional(column) else {
            let has: Vec<&str> = self.table.columns().iter().map(|c| c.name.as_str()).collect();
            let other = has.iter().find(|name| name.eq_ignore_ascii_case(column));
            let why = match other {
                Some(other) => format!(
                    "the column '{column}' is missing, and '{other}' is there: did you mean '{column}'?"
                ),
                None => format!("the column '{column}' is missing"),
            };
            return Err(RecordError::new(self.name, why, format!("it has {}", has.join(", "))));
        };
        match values.iter().position(|v| !(v.abs() <= LARGEST)) {
            None => Ok(values),
            Some(row) => {
                let value = values[row];
                let wrong = if value.is_finite() { "too large" } else { "not finite" };
                let why = format!("row {row}: {column} = {value:e} is {wrong}");
                Err(RecordError::new(self.name, why, "take the row out, or write the file again"))
            }
        }
    }

    /// Three columns as vectors.
    pub fn vectors(&self, columns: [&str; 3]) -> Result<Vec<Vec3>, RecordError> {
        let [x, y, z] = columns.map(|c| self.numbers(c));
        let (x, y, z) = (x?, y?, z?);
        Ok((0..x.len()).map(|i| Vec3::new(x[i], y[i], z[i])).collect())
    }

    /// Three columns as vectors; a component whose column is missing is zero.
    pub fn vectors_or_zero(&self, columns: [&str; 3]) -> Result<Vec<Vec3>, RecordError> {
        let mut vectors = vec![Vec3::zeros(); self.table.rows()];
        for (axis, column) in columns.into_iter().enumerate() {
            if self.table.get(column).is_some() {
                let values = self.numbers(column)?;
                vectors.iter_mut().zip(values).for_each(|(vector, value)| vector[axis] = value);
            }
        }
        Ok(vectors)
    }

    /// The warning about columns that are none of `known`.
    pub fn unused(&self, known: &[&str]) -> Option<String> {
        let names = || self.table.columns().iter().map(|c| c.name.as_str()).filter(|n| !known.contains(n));
        let unused: Vec<String> = names().map(|n| format!("'{n}'")).collect();
        let what = match &unused[..] {
            [] => return None,
            [one] => format!("column {one} is not used"),
            _ => format!("columns {} are not used", unused.join(", ")),
        };
        let near = names().flat_map(|n| known.iter().find(|k| k.eq_ignore_ascii_case(n)));
        let near: Vec<&str> = near.copied().collect();
        let hint =
            if near.is_empty() { String::new() } else { format!("; did you mean {}?", near.join(" ")) };
        Some(format!("{}: {what}; known: {}{hint}", self.name, known.join(" ")))
    }

    /// The column `radius`, or half of `diameter`; above zero.
    pub fn radii(&self) -> Result<Vec<f64>, RecordError> {
        let radii = match (self.table.get(RADIUS), self.optional(DIAMETER)) {
            (None, Some(d)) => d.iter().map(|d| d / 2.0).collect(),
            (_, diameters) => self.of_diameters(self.numbers(RADIUS)?, diameters)?,
        };
        match radii.iter().position(|r| !(*r > 0.0 && *r <= LARGEST)) {
            None => Ok(radii),
            Some(row) => {
                let bound =
                    if radii[row] > 0.0 { format!("at most {LARGEST:e}") } else { "above 0".to_owned() };
                let why = format!("row {row}: radius {} m must be {bound}", radii[row]);
                Err(RecordError::new(self.name, why, "take the row out, or write the file again"))
            }
        }
    }

    /// Radii beside a column of diameters, which must be twice as large.
    fn of_diameters(&self, radii: Vec<f64>, diameters: Option<Vec<f64>>) -> Result<Vec<f64>, RecordError> {
        let both = || radii.iter().zip(diameters.iter().flatten());
        match both().position(|(r, d)| !((2.0 * r - d).abs() <= ROUNDED * d.abs())) {
            None => Ok(radii),
            Some(row) => {
                let (r, d) = (radii[row], diameters.iter().flatten().nth(row).copied().unwrap_or(f64::NAN));
                let why = format!("row {row}: radius {r} m and diameter {d} m contradict each other");
                Err(RecordError::new(self.name, why, "leave one of the columns out"))
            }
        }
    }

    /// A column of whole numbers that are at most `most`; it must be there.
    pub fn needed(&self, column: &str, most: f64) -> Result<Vec<u32>, RecordError> {
        let why = || format!("the column '{column}' is missing");
        let missing = || RecordError::new(self.name, why(), "run stage-replay again");
        self.indices(column, most)?.ok_or_else(missing)
    }

    /// A column of whole numbers that are at most `most`.
    pub fn indices(&self, column: &str, most: f64) -> Result<Option<Vec<u32>>, RecordError> {
        if self.table.get(column).is_none() {
            return Ok(None);
        }
        let values = self.numbers(column)?;
        match values.iter().position(|v| v.fract() != 0.0 || *v < 0.0 || *v > most) {
            None => Ok(Some(values.iter().map(|v| *v as u32).collect())),
            Some(row) => {
                let why =
                    format!("row {row}: {column} = {} is not a whole number from 0 to {most}", values[row]);
                Err(RecordError::new(self.name, why, "write the file again"))
            }
        }
    }
}

/// SHA-256 over names and values of columns, in hexadecimal digits.
pub fn hash(table: &Table) -> String {
    let mut sum = Sha256::new();
    for column in table.columns() {
        sum.update(column.name.as_bytes());
        (0..table.rows()).for_each(|row| sum.update(column.values.get(row).to_le_bytes()));
    }
    sum.finalize().iter().map(|b| format!("{b:02x}")).collect()
}
