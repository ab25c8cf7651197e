//! How the cells of a row are separated, and how its numbers are written.

use crate::{SheetError, refuse};

/// Rows that tell how the table is written.
const LOOKED_AT: usize = 50;

/// What stands between cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Separator {
    Comma,
    Semicolon,
    Tab,
    Blanks,
}

/// How rows are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    pub separator: Separator,
    /// Whether commas are decimal points.
    decimal_comma: bool,
}

/// Whether a cell is a number, or `nan`, also with a decimal comma.
fn is_number(cell: &str) -> bool {
    let cell = cell.trim();
    cell.parse::<f64>().is_ok() || has_decimal_comma(cell)
}

/// Whether a cell is a number such as `-1,5e-3`.
fn has_decimal_comma(cell: &str) -> bool {
    cell.matches(',').count() == 1 && cell.replacen(',', ".", 1).parse::<f64>().is_ok()
}

impl Separator {
    /// The cells of a line; quotes hold cells with a separator.
    pub fn split(self, line: &str) -> Vec<String> {
        let delimiter = match self {
            Separator::Comma => b',',
            Separator::Semicolon => b';',
            Separator::Tab => b'\t',
            Separator::Blanks => return line.split_whitespace().map(str::to_owned).collect(),
        };
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(delimiter)
            .has_headers(false)
            .flexible(true)
            .from_reader(line.as_bytes());
        let record = reader.records().next().and_then(Result::ok).unwrap_or_default();
        record.iter().map(|cell| cell.trim().to_owned()).collect()
    }

    /// What it is called in messages.
    pub fn name(self) -> &'static str {
        match self {
            Separator::Comma => "commas",
            Separator::Semicolon => "semicolons",
            Separator::Tab => "tabs",
            Separator::Blanks => "blanks",
        }
    }
}

impl Layout {
    /// Whether a line has numbers and no names.
    pub fn is_data(line: &str) -> bool {
        let all = [Separator::Semicolon, Separator::Tab, Separator::Comma, Separator::Blanks];
        let numbers = |separator: Separator| {
            let cells = separator.split(line);
            let filled = || cells.iter().filter(|cell| !cell.is_empty());
            filled().next().is_some() && filled().all(|cell| is_number(cell))
        };
        all.into_iter().any(numbers)
    }

    /// That of the rows of a body; without any, that of the header.
    pub fn of(body: &[(usize, &str)], header: &str) -> Layout {
        let rows: Vec<&str> = body.iter().take(LOOKED_AT).map(|(_, line)| line.trim_end()).collect();
        let lines = if rows.is_empty() { vec![header] } else { rows };
        let all_have = |c: char| lines.iter().all(|line| line.contains(c));
        let separator = if all_have(';') {
            Separator::Semicolon
        } else if all_have('\t') {
            Separator::Tab
        } else if all_have(',') && !Layout::blanks_and_decimal_commas(&lines, header) {
            Separator::Comma
        } else if lines.iter().any(|line| line.contains(',')) && header.contains(',') {
            // A row that lacks cells: the error names its line.
            Separator::Comma
        } else {
            Separator::Blanks
        };
        let comma = |line: &&str| separator.split(line).iter().any(|cell| has_decimal_comma(cell));
        let decimal_comma = separator != Separator::Comma && lines.iter().any(comma);
        Layout { separator, decimal_comma }
    }

    /// Whether rows are numbers with decimal commas between blanks: `0,1 12,5`, or a single one a line under a header of one name.
    fn blanks_and_decimal_commas(lines: &[&str], header: &str) -> bool {
        let one = !header.contains(',') && header.split_whitespace().count() == 1;
        let of = |line: &&str| {
            let cells: Vec<&str> = line.split_whitespace().collect();
            cells.iter().all(|cell| is_number(cell)) && (cells.len() > 1 || one)
        };
        lines.iter().all(of)
    }

    /// The cells of a row.
    pub fn split(&self, line: &str) -> Vec<String> {
        self.separator.split(line)
    }

    /// What is wrong with a row of another number of cells than the header has names.
    pub fn wrong_count(&self, cells: &[String], columns: usize) -> String {
        let decimal = self.separator == Separator::Comma && cells.len() == 2 * columns;
        let cure = if decimal {
            "if these are decimal commas, separate the columns by ';' or tabs"
        } else {
            "write one cell for each"
        };
        format!(
            "{} cells between {}, but the header has {columns} columns: {cure}",
            cells.len(),
            self.separator.name()
        )
    }

    /// The cells of a row with decimal points.
    pub fn with_points(&self, line: usize, cells: Vec<String>) -> Result<Vec<String>, SheetError> {
        if self.separator == Separator::Comma {
            return Ok(cells);
        }
        let point = |cell: String| {
            let bare = cell.replace(['.', ','], "");
            if cell.contains(',') && cell.contains('.') && bare.parse::<f64>().is_ok() {
                return refuse(
                    line,
                    format!(
                        "'{cell}' has a point and a comma: write numbers without separators of thousands"
                    ),
                );
            }
            if !self.decimal_comma {
                return Ok(cell);
            }
            if cell.contains('.') && cell.parse::<f64>().is_ok() {
                return refuse(
                    line,
                    format!(
                        "'{cell}' has a decimal point, and other numbers have decimal commas: write all alike"
                    ),
                );
            }
            Ok(if has_decimal_comma(&cell) { cell.replacen(',', ".", 1) } else { cell })
        };
        cells.into_iter().map(point).collect()
    }
}
