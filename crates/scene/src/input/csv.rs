//! Particles as text: names on the first line, then a line of numbers for each particle.

use crate::error::{Result, SceneError};
use stream::{MOST_COLUMNS, Table, Values};

/// A table of text: names on the first line, commas or blanks between, `#` starts a comment. Names and numbers may stand in quotes.
pub(super) fn csv(name: &str, bytes: &[u8]) -> Result<Table> {
    let wrong = |why: String| {
        SceneError::file(name, why, "wanted: a line of names such as id,x,y,z,radius, then numbers")
    };
    // Spreadsheets mark UTF-8 with three bytes in front.
    let text = std::str::from_utf8(bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes));
    let text = text.map_err(|e| wrong(format!("byte {}: is not text, PLY or MCAP", e.valid_up_to())))?;
    let between = |c: char| c == ',' || c == ';' || c.is_whitespace();
    let unquoted = |field| str::strip_prefix(field, '"').and_then(|f| f.strip_suffix('"')).unwrap_or(field);
    let split = |line| str::split(line, between).filter(|f| !f.is_empty()).map(unquoted).collect::<Vec<_>>();
    let lines = text.lines().enumerate().map(|(n, l)| (n + 1, l.split('#').next().unwrap_or("").trim()));
    let mut lines = lines.filter(|(_, l)| !l.is_empty());
    let Some((_, head)) = lines.next() else { return Err(wrong("is empty".into())) };
    let names = split(head);
    if names.first().is_none_or(|name| name.parse::<f64>().is_ok()) {
        return Err(wrong("line 1: begins without a name, the line of names is missing".into()));
    }
    if names.len() > MOST_COLUMNS {
        return Err(wrong(format!("line 1: {} names are more than {MOST_COLUMNS} columns", names.len())));
    }
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    for (n, line) in lines {
        let fields = split(line);
        if fields.len() != names.len() {
            let (numbers, names) = (fields.len(), names.len());
            return Err(wrong(format!("line {n}: {numbers} numbers where there are {names} names")));
        }
        for (column, field) in columns.iter_mut().zip(&fields) {
            column.push(field.parse().map_err(|_| wrong(format!("line {n}: '{field}' is not a number")))?);
        }
    }
    let mut table = Table::default();
    for (column, values) in names.into_iter().zip(columns) {
        table.push(column, Values::F64(values)).map_err(|e| wrong(e.to_string()))?;
    }
    Ok(table)
}
