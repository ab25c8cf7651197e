//! Columns of a table as vectors, with errors that name what is missing.

use crate::error::SceneError;
use geom::Vec3;
use stream::Table;

/// Digits that a file may have rounded a diameter to, as a share.
const ROUNDED: f64 = 1e-3;

/// A table and the stream it came from.
pub(crate) struct Columns<'a> {
    pub name: &'a str,
    pub table: &'a Table,
}

impl Columns<'_> {
    /// The column, when there is one.
    pub(crate) fn optional(&self, column: &str) -> Option<Vec<f64>> {
        self.table.get(column).map(|v| v.to_f64())
    }

    /// The column; its numbers must be finite.
    pub(crate) fn numbers(&self, column: &str) -> Result<Vec<f64>, SceneError> {
        let Some(values) = self.optional(column) else {
            let has: Vec<&str> = self.table.columns().iter().map(|c| c.name.as_str()).collect();
            let other = has.iter().find(|name| name.eq_ignore_ascii_case(column));
            let why = match other {
                Some(other) => format!(
                    "the column '{column}' is missing, and '{other}' is there: did you mean '{column}'?"
                ),
                None => format!("the column '{column}' is missing"),
            };
            return Err(SceneError::file(self.name, why, format!("it has {}", has.join(", "))));
        };
        match values.iter().position(|v| !v.is_finite()) {
            None => Ok(values),
            Some(row) => {
                let why = format!("row {row}: {column} = {} is not finite", values[row]);
                Err(SceneError::file(self.name, why, "take the row out, or write the file again"))
            }
        }
    }

    /// Three columns as vectors.
    pub(crate) fn vectors(&self, columns: [&str; 3]) -> Result<Vec<Vec3>, SceneError> {
        let [x, y, z] = columns.map(|c| self.numbers(c));
        let (x, y, z) = (x?, y?, z?);
        Ok((0..x.len()).map(|i| Vec3::new(x[i], y[i], z[i])).collect())
    }

    /// Three columns as vectors; a component whose column is missing is zero.
    pub(crate) fn vectors_or_zero(&self, columns: [&str; 3]) -> Result<Vec<Vec3>, SceneError> {
        let mut vectors = vec![Vec3::zeros(); self.table.rows()];
        for (axis, column) in columns.into_iter().enumerate() {
            if self.table.get(column).is_some() {
                let values = self.numbers(column)?;
                vectors.iter_mut().zip(values).for_each(|(vector, value)| vector[axis] = value);
            }
        }
        Ok(vectors)
    }

    /// What to tell about columns that are none of `known`.
    pub(crate) fn unused(&self, known: &[&str]) -> Option<String> {
        let names = self.table.columns().iter().map(|c| c.name.as_str());
        let unused: Vec<String> = names.filter(|n| !known.contains(n)).map(|n| format!("'{n}'")).collect();
        let what = match unused.len() {
            0 => return None,
            1 => format!("column {} is not used", unused[0]),
            _ => format!("columns {} are not used", unused.join(", ")),
        };
        let names = self.table.columns().iter().map(|c| c.name.as_str()).filter(|n| !known.contains(n));
        let meant: Vec<&str> =
            names.flat_map(|n| known.iter().find(|k| k.eq_ignore_ascii_case(n))).copied().collect();
        let hint =
            if meant.is_empty() { String::new() } else { format!("; did you mean {}?", meant.join(" ")) };
        Some(format!("{}: {what}; known: {}{hint}", self.name, known.join(" ")))
    }

    /// The column `radius`, or half of `diameter`; above zero.
    pub(crate) fn radii(&self) -> Result<Vec<f64>, SceneError> {
        let radii = match (self.table.get("radius"), self.optional("diameter")) {
            (None, Some(d)) => d.iter().map(|d| d / 2.0).collect(),
            (_, diameters) => self.of_diameters(self.numbers("radius")?, diameters)?,
        };
        match radii.iter().position(|r| !(*r > 0.0 && r.is_finite())) {
            None => Ok(radii),
            Some(row) => {
                let why = format!("row {row}: radius {} m must be above 0", radii[row]);
                Err(SceneError::file(self.name, why, "take the row out, or write the file again"))
            }
        }
    }

    /// Radii beside a column of diameters, which must be twice as large.
    fn of_diameters(&self, radii: Vec<f64>, diameters: Option<Vec<f64>>) -> Result<Vec<f64>, SceneError> {
        let both = || radii.iter().zip(diameters.iter().flatten());
        match both().position(|(r, d)| !((2.0 * r - d).abs() <= ROUNDED * d.abs())) {
            None => Ok(radii),
            Some(row) => {
                let (r, d) = (radii[row], diameters.iter().flatten().nth(row).copied().unwrap_or(f64::NAN));
                let why = format!("row {row}: radius {r} m and diameter {d} m contradict each other");
                Err(SceneError::file(self.name, why, "leave one of the columns out"))
            }
        }
    }

    /// A column of whole numbers that are at most `most`.
    pub(crate) fn indices(&self, column: &str, most: f64) -> Result<Option<Vec<u32>>, SceneError> {
        if self.table.get(column).is_none() {
            return Ok(None);
        }
        let values = self.numbers(column)?;
        match values.iter().position(|v| v.fract() != 0.0 || *v < 0.0 || *v > most) {
            None => Ok(Some(values.iter().map(|v| *v as u32).collect())),
            Some(row) => {
                let why = format!("row {row}: {column} = {} is no whole number of 0 to {most}", values[row]);
                Err(SceneError::file(self.name, why, "write the file again"))
            }
        }
    }
}
