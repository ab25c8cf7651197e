//! Tables of numbers by name: what dem-measure prints, and the curves of a test.

use crate::error::{LabError, Result};
use std::path::Path;

/// Share of the end of a curve that is its residual [–].
const RESIDUAL: f64 = 0.2;

/// A column of a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    pub name: &'static str,
    /// Its unit; "" for none.
    pub unit: &'static str,
    /// A value in each row; NaN where there is none.
    pub values: Vec<f64>,
}

/// The curve of one specimen: columns of the same length.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Curve {
    /// The columns; the first is time [s], or the number of the row.
    pub columns: Vec<Column>,
}

impl Curve {
    /// Adds a column.
    pub(crate) fn with(mut self, name: &'static str, unit: &'static str, values: Vec<f64>) -> Curve {
        self.columns.push(Column { name, unit, values });
        self
    }

    /// The values of a column; none where there is no such column.
    pub fn column(&self, name: &str) -> &[f64] {
        self.columns.iter().find(|c| c.name == name).map_or(&[], |c| &c.values)
    }

    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |c| c.values.len())
    }
}

/// A table that dem-measure has printed.
#[derive(Debug, Clone)]
pub(crate) struct Series {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
    file: std::path::PathBuf,
}

impl Series {
    /// Reads a CSV file with names and units in its first line; an empty cell is NaN.
    pub(crate) fn read(file: &Path) -> Result<Series> {
        let wrong = |what: String| LabError::Content { file: file.to_owned(), what };
        let text = std::fs::read_to_string(file).map_err(LabError::file(file, "cannot read it"))?;
        let sheet = sheet::Sheet::parse(&text).map_err(|e| wrong(format!("line {}: {e}", e.line)))?;
        let names = sheet.columns.into_iter().map(|column| column.name).collect();
        let number = |cell: &String| cell.parse().unwrap_or(f64::NAN);
        let rows = sheet.rows.iter().map(|(_, cells)| cells.iter().map(number).collect()).collect();
        Ok(Series { names, rows, file: file.to_owned() })
    }

    pub(crate) fn column(&self, name: &str) -> Result<Vec<f64>> {
        let wrong = || LabError::Content {
            file: self.file.clone(),
            what: format!("has no column {name}: its columns are {}", self.names.join(", ")),
        };
        let at = self.names.iter().position(|n| n == name).ok_or_else(wrong)?;
        Ok(self.rows.iter().map(|row| row.get(at).copied().unwrap_or(f64::NAN)).collect())
    }
}

/// Means over so many neighbours: half of them before and half after, fewer at the ends.
pub(crate) fn smooth(values: &[f64], window: usize) -> Vec<f64> {
    let half = window / 2;
    let mean = |i: usize| {
        let near = half.min(i).min(values.len() - 1 - i);
        let part = &values[i - near..=i + near];
        part.iter().sum::<f64>() / part.len() as f64
    };
    (0..values.len()).map(mean).collect()
}

/// Slope of the least-squares line y(x); NaN for fewer than two points.
pub(crate) fn slope(x: &[f64], y: &[f64]) -> f64 {
    line(x, y).1
}

/// Intercept and slope of the least-squares line y(x).
pub(crate) fn line(x: &[f64], y: &[f64]) -> (f64, f64) {
    let n = x.len().min(y.len()) as f64;
    let (mx, my) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let (xx, xy) =
        x.iter().zip(y).fold((0.0, 0.0), |s, (a, b)| (s.0 + (a - mx).powi(2), s.1 + (a - mx) * (b - my)));
    (my - xy / xx * mx, xy / xx)
}

/// Index of the largest value; `None` without a number.
pub(crate) fn peak(values: &[f64]) -> Option<usize> {
    (0..values.len()).filter(|i| !values[*i].is_nan()).max_by(|a, b| values[*a].total_cmp(&values[*b]))
}

/// Where the values first reach a level, between two rows: index of the row after it, and the share of the way to it.
pub(crate) fn reaches(values: &[f64], level: f64) -> Option<(usize, f64)> {
    let at = values.iter().position(|v| *v >= level)?;
    let before = *values.get(at.checked_sub(1)?)?;
    Some((at, (level - before) / (values[at] - before)))
}

pub(crate) fn at(values: &[f64], (row, share): (usize, f64)) -> f64 {
    values[row - 1] + share * (values[row] - values[row - 1])
}

/// A smooth curve: means over a fortieth of its rows.
pub(crate) fn smoothed(values: &[f64]) -> Vec<f64> {
    if values.is_empty() { Vec::new() } else { smooth(values, (values.len() / 40).max(1)) }
}

/// Mean over the last fifth of the rows; NaN of none.
pub(crate) fn residual(values: &[f64]) -> f64 {
    let from = values.len() - (RESIDUAL * values.len() as f64).ceil() as usize;
    let last = &values[from..];
    last.iter().sum::<f64>() / last.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_levels() {
        let (x, y) = ([0.0, 1.0, 2.0, 3.0], [1.0, 3.0, 5.0, 7.0]);
        assert_eq!(line(&x, &y), (1.0, 2.0));
        let found = reaches(&y, 4.0).unwrap();
        assert_eq!((found, at(&x, found)), ((2, 0.5), 1.5));
        assert_eq!(peak(&[1.0, f64::NAN, 3.0, 2.0]), Some(2));
        assert_eq!(smooth(&[0.0, 3.0, 6.0, 0.0], 3), [0.0, 3.0, 3.0, 0.0]);
        assert!(reaches(&y, 0.5).is_none() && slope(&x[..1], &y[..1]).is_nan());
    }
}
