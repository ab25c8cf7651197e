//! Names and units of columns.

use crate::cells::{Layout, Separator};
use crate::{SheetError, refuse};

/// A column's name and unit: `stress [kPa]`, `stress (kPa)` or `stress`.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    pub name: String,
    pub unit: Option<String>,
}

/// Brackets around units.
const BRACKETS: [(char, char); 2] = [('[', ']'), ('(', ')')];

impl Column {
    /// Of a head, or of what asks for a column.
    pub fn new(text: &str) -> Column {
        let text = text.trim();
        for (open, close) in BRACKETS {
            if let Some((name, unit)) = text.strip_suffix(close).and_then(|t| t.rsplit_once(open)) {
                return Column { name: name.trim().to_owned(), unit: Some(unit.trim().to_owned()) };
            }
        }
        Column { name: text.to_owned(), unit: None }
    }
}

/// Words of a header between blanks, where a unit in brackets belongs to the name before it.
fn words(text: &str) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let mut open = None;
    for word in text.split_whitespace() {
        let begins = BRACKETS.iter().find(|(open, _)| word.starts_with(*open));
        match names.last_mut() {
            Some(last) if open.is_some() || begins.is_some() => *last += &format!(" {word}"),
            _ => names.push(word.to_owned()),
        }
        let close = open.or(begins.map(|b| b.1)).or_else(|| unclosed(word));
        open = close.filter(|close| !word.ends_with(*close));
    }
    names
}

/// The bracket that a word leaves open.
fn unclosed(word: &str) -> Option<char> {
    BRACKETS.iter().find(|(open, close)| word.contains(*open) && !word.contains(*close)).map(|b| b.1)
}

/// The columns of a header, as many as rows have cells, where there are rows. A header that is a comment may be another remark.
pub(crate) fn columns(
    (line, text): (usize, &str),
    count: Option<usize>,
    layout: &Layout,
    is_comment: bool,
) -> Result<Vec<Column>, SheetError> {
    let text = text.trim();
    let filled = |names: Vec<String>| names.into_iter().filter(|n| !n.is_empty()).collect::<Vec<_>>();
    let own = match layout.separator {
        Separator::Blanks => words(text),
        other => other.split(text),
    };
    let others = || {
        let all = [Separator::Tab, Separator::Semicolon, Separator::Comma];
        all.into_iter().map(|s| filled(s.split(text))).chain([words(text)])
    };
    let names = match count {
        None => own,
        Some(n) if own.len() == n => own,
        // A header between other separators than the numbers. One that has some of the separator of the rows is taken by it: a name is missing, or a number.
        Some(n) => others().find(|names| names.len() == n && n > 1).unwrap_or(own),
    };
    let as_rows = count.is_none_or(|n| n == names.len());
    if !as_rows && (is_comment || names.len() == 1) {
        let count = count.unwrap_or(0);
        return refuse(
            line,
            format!(
                "the header '{text}' and the rows differ: {} and {count} numbers between {}: write a name for each column, such as '# strain stress'",
                geom::counted(names.len(), "name"),
                layout.separator.name()
            ),
        );
    }
    let columns: Vec<Column> = names.iter().map(|name| Column::new(name)).collect();
    let twice = |k: &usize| columns[..*k].iter().any(|c| c.name == columns[*k].name);
    match (0..columns.len()).find(twice) {
        Some(k) if !columns[k].name.is_empty() => {
            refuse(line, format!("two columns are called '{}': give each a name of its own", columns[k].name))
        }
        _ => Ok(columns),
    }
}

/// Takes a row as units of the columns, where all of its cells are units or empty, and one is a unit.
pub(crate) fn take_units(columns: &mut [Column], cells: &[String]) -> bool {
    let bare = |cell: &str| {
        let column = Column::new(cell);
        if column.name.is_empty() { column.unit.unwrap_or_default() } else { column.name }
    };
    let units: Vec<String> = cells.iter().map(|cell| bare(cell)).collect();
    let none = |unit: &str| ["", "-", "–", "1"].contains(&unit);
    let known = |unit: &String| geom::units::in_si(unit).is_some() && unit.parse::<f64>().is_err();
    let is_units = units.iter().any(known) && units.iter().all(|unit| none(unit) || known(unit));
    if is_units {
        columns.iter_mut().zip(units).filter(|(_, unit)| !unit.is_empty()).for_each(|(column, unit)| {
            column.unit.get_or_insert(unit);
        });
    }
    is_units
}
