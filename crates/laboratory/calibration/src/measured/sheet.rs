//! Tables of numbers: columns with a header, or a report (JSON).

use crate::error::{CalibrateError, Location, Result, hint};
use sheet::Column;
use std::collections::BTreeMap;

/// A table of a file.
#[derive(Debug)]
pub struct Sheet {
    file: String,
    columns: Vec<Column>,
    /// Line in the file, and cells.
    rows: Vec<sheet::Row>,
}

impl Sheet {
    /// Reads a table ([`sheet::Sheet`]).
    ///
    /// # Errors
    /// No header, rows of other lengths.
    pub fn parse(file: &str, text: &str) -> Result<Sheet> {
        let sheet = sheet::Sheet::parse(text)
            .map_err(|e| CalibrateError::Data { place: Location::line(file, e.line), message: e.message })?;
        Ok(Sheet { file: file.to_owned(), columns: sheet.columns, rows: sheet.rows })
    }

    /// Index and unit of a column.
    ///
    /// # Errors
    /// There is none of this name.
    pub fn column(&self, name: &str) -> Result<(usize, Option<&str>)> {
        let wanted = Column::new(name);
        let known = self.columns.iter().map(|c| c.name.as_str());
        match known.clone().position(|k| k == wanted.name) {
            Some(k) => Ok((k, wanted.unit.is_none().then_some(self.columns[k].unit.as_deref()).flatten())),
            None => Err(self.refuse(1, format!("no column '{name}'{}", hint(name, known)))),
        }
    }

    /// Index of a column, and the factor from its unit to another one (absent: SI). The unit is what the name asks for, or what the header says; without one the
    /// numbers are in the other unit.
    ///
    /// # Errors
    /// There is none of this name; a unit that is unknown, or of another dimension.
    pub fn in_unit(&self, name: &str, to: Option<&str>) -> Result<(usize, f64)> {
        let (column, header) = self.column(name)?;
        let own = Column::new(name).unit.or(header.map(str::to_owned)).unwrap_or_default();
        let to = to.filter(|to| !to.is_empty());
        if ["", "-", "–"].contains(&own.as_str()) || to == Some(&own) {
            return Ok((column, 1.0));
        }
        let factor = match to {
            Some(to) => geom::units::ratio(&own, to).ok_or_else(|| {
                format!("column '{name}' is in '{own}', the test in '{to}': they have other dimensions, or one is unknown")
            }),
            None => geom::units::in_si(&own).ok_or_else(|| format!("column '{name}': unknown unit '{own}'")),
        };
        Ok((column, factor.map_err(|message| self.refuse(1, message))?))
    }

    /// Whether it has a column.
    pub fn has(&self, name: &str) -> bool {
        self.columns.iter().any(|c| c.name == name)
    }

    /// Lines and numbers of columns, of the rows that have these values.
    ///
    /// # Errors
    /// A cell that is empty or no number; no row.
    pub fn numbers(&self, columns: &[usize], of: &BTreeMap<String, f64>) -> Result<Vec<(usize, Vec<f64>)>> {
        let filters =
            of.iter().map(|(name, value)| Ok((self.column(name)?.0, *value))).collect::<Result<Vec<_>>>()?;
        let mut found = Vec::new();
        for (line, cells) in &self.rows {
            let mut keep = true;
            for (column, value) in &filters {
                keep &= (self.number(*line, &cells[*column], *column)? - value).abs() <= 1e-6 * value.abs();
            }
            if keep {
                let row: Result<Vec<f64>> =
                    columns.iter().map(|c| self.number(*line, &cells[*c], *c)).collect();
                found.push((*line, row?));
            }
        }
        if found.is_empty() {
            let what = if of.is_empty() { "has no rows".to_owned() } else { format!("no row has {of:?}") };
            return Err(self.refuse(self.rows.last().map_or(1, |r| r.0), what));
        }
        Ok(found)
    }

    fn number(&self, line: usize, cell: &str, column: usize) -> Result<f64> {
        let name = &self.columns[column].name;
        match cell.parse::<f64>() {
            Ok(value) if value.is_finite() && value.abs() < 1e100 => Ok(value),
            _ if cell.is_empty() => {
                Err(self.refuse(line, format!("column '{name}' has a gap: delete the row, or fill the cell")))
            }
            _ => Err(self.refuse(
                line,
                format!(
                    "column '{name}': '{cell}' is not a finite number: delete the row, or correct the cell"
                ),
            )),
        }
    }

    fn refuse(&self, line: usize, message: String) -> CalibrateError {
        CalibrateError::Data { place: Location::line(&self.file, line), message }
    }
}

/// The number of a report (JSON) at a dotted key.
///
/// # Errors
/// Text that is no JSON, a key that is missing or no number.
pub fn of_report(file: &str, text: &str, key: &str) -> Result<f64> {
    let refuse = |message: String| CalibrateError::Data {
        place: Location { file: file.to_owned(), at: None },
        message,
    };
    let all: serde_json::Value =
        serde_json::from_str(text).map_err(|e| refuse(format!("is not a report: {e}")))?;
    let mut at = &all;
    for part in key.split('.') {
        let known: Vec<&str> =
            at.as_object().map(|o| o.keys().map(String::as_str).collect()).unwrap_or_default();
        at = at.get(part).ok_or_else(|| {
            refuse(format!("no '{part}' in the report{}", hint(part, known.iter().copied())))
        })?;
    }
    at.as_f64()
        .or_else(|| at.get("value")?.as_f64())
        .ok_or_else(|| refuse(format!("'{key}' is not a number: {at}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn why(text: &str, columns: &[&str]) -> String {
        let read = || {
            let sheet = Sheet::parse("c.csv", text)?;
            let at = columns.iter().map(|c| Ok(sheet.column(c)?.0)).collect::<Result<Vec<_>>>()?;
            sheet.numbers(&at, &BTreeMap::new())
        };
        read().unwrap_err().to_string()
    }

    #[test]
    fn columns_have_units_and_rows_are_chosen() {
        let sheet = Sheet::parse("c.csv", "# shear\nload,u [mm], tau (kPa)\n1,0,0\n2,0,5\n2,1,7\n").unwrap();
        assert_eq!(sheet.column("tau").unwrap(), (2, Some("kPa")));
        assert_eq!(sheet.column("tau [Pa]").unwrap(), (2, None));
        let rows = sheet.numbers(&[1, 2], &BTreeMap::from([("load".to_owned(), 2.0)])).unwrap();
        assert_eq!(rows, [(4, vec![0.0, 5.0]), (5, vec![1.0, 7.0])]);
    }

    #[test]
    fn the_unit_of_a_header_counts() {
        let sheet = Sheet::parse("c.csv", "x [mm],y [kPa],n\n1,2,3\n").unwrap();
        let factor = |name: &str, to: Option<&str>| sheet.in_unit(name, to).map(|(_, factor)| factor);
        assert_eq!(factor("x", None).unwrap(), 1e-3);
        assert_eq!(factor("y", Some("Pa")).unwrap(), 1e3);
        assert_eq!(factor("y", Some("MPa")).unwrap(), 1e-3);
        assert_eq!((factor("y", Some("kPa")).unwrap(), factor("n", Some("Pa")).unwrap()), (1.0, 1.0));
        assert_eq!(factor("y [Pa]", None).unwrap(), 1.0, "what is asked for goes before the header");
        let why = factor("y", Some("mm")).unwrap_err().to_string();
        assert!(why.contains("c.csv:1: column 'y' is in 'kPa', the test in 'mm'"), "{why}");
    }

    #[test]
    fn errors_name_line_and_cure() {
        assert_eq!(
            why("x,y\n1,2\n2,\n", &["x", "y"]),
            "c.csv:3: column 'y' has a gap: delete the row, or fill the cell"
        );
        assert!(why("x,y\n1,nan\n", &["y"]).contains("c.csv:2: column 'y': 'nan' is not a finite number"));
        assert!(
            why("x,y\n1,2,3\n", &["x"])
                .contains("c.csv:2: 3 cells between commas, but the header has 2 columns")
        );
        assert!(why("u,stres\n1,2\n", &["stress"]).contains("did you mean 'stres'?"));
        assert!(why("1,2\n3,4\n", &["x"]).contains("c.csv:1: its first line has numbers"));
        assert!(why("", &["x"]).contains("is empty") && why("x\n", &["x"]).contains("has no rows"));
    }

    #[test]
    fn reports_are_read_by_key() {
        let text = "{\"angle\": 31.5, \"fit\": {\"rate\": {\"value\": 2}}, \"name\": \"x\"}";
        assert_eq!(of_report("r.json", text, "angle").unwrap(), 31.5);
        assert_eq!(of_report("r.json", text, "fit.rate").unwrap(), 2.0);
        assert!(
            of_report("r.json", text, "angel").unwrap_err().to_string().contains("did you mean 'angle'?")
        );
        assert!(of_report("r.json", text, "name").unwrap_err().to_string().contains("not a number"));
    }
}
