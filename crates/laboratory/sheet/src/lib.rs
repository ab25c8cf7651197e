//! Tables of curves, as laboratories and codes write them.
//!
//! ```text
//! strain [%],stress [kPa]      # strain stress            Dehnung [%];Spannung [kPa]
//! 0.1,12.5                     0.001 12500                0,1;12,5
//! ```
//!
//! Columns are separated by commas, semicolons, tabs or blanks; the header may stand behind `#` (numpy.savetxt, YADE's plot.saveDataTxt, GrainLearning), and its
//! names may be separated by something else than the numbers. A second line of the header may hold units. With another separator than the comma, numbers may have decimal
//! commas. What is not certain is an error: a table that is read wrongly looks like a result.

mod cells;
mod header;

use cells::Layout;
pub use header::Column;
use thiserror::Error;

/// Most bytes of a table.
const MOST: usize = 1 << 28;

/// What is wrong with a table, and where.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{message}")]
pub struct SheetError {
    /// Line in the file, from 1.
    pub line: usize,
    pub message: String,
}

/// A row: its line in the file, and its cells with decimal points.
pub type Row = (usize, Vec<String>);

/// A table.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    pub columns: Vec<Column>,
    pub rows: Vec<Row>,
}

/// Whether a line is a comment: `#`, or `%` before a blank.
fn comment(line: &str) -> Option<&str> {
    let line = line.trim_start();
    line.strip_prefix('#').or_else(|| line.strip_prefix("% "))
}

fn refuse<T>(line: usize, message: impl Into<String>) -> Result<T, SheetError> {
    Err(SheetError { line, message: message.into() })
}

impl Sheet {
    /// Reads a table.
    ///
    /// # Errors
    /// No header, no certain separator, rows of other lengths, numbers with a point and a comma.
    pub fn parse(text: &str) -> Result<Sheet, SheetError> {
        if text.len() > MOST {
            return refuse(1, format!("{} bytes: give a table below {MOST}", text.len()));
        }
        let text = text.trim_start_matches('\u{feff}');
        let lines = || (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
        let plain: Vec<(usize, &str)> = lines().filter(|(_, line)| comment(line).is_none()).collect();
        let Some(&(first, head)) = plain.first() else {
            return match lines().last() {
                Some((line, _)) => refuse(line, "has comments only: a table has a header and rows"),
                None => refuse(1, "is empty: a table has a header and rows"),
            };
        };
        let is_data = Layout::is_data(head);
        let (header, body) = match is_data {
            // The header is the comment right above the numbers.
            true => {
                let above = lines().take_while(|(line, _)| *line < first).last();
                let Some((line, above)) = above else {
                    return refuse(
                        first,
                        "its first line has numbers: write a header with the names of the columns above it, such as '# strain stress'",
                    );
                };
                ((line, comment(above).unwrap_or_default()), &plain[..])
            }
            false => ((first, head), &plain[1..]),
        };
        let layout = Layout::of(body, header.1);
        let count = body.iter().map(|(_, line)| layout.split(line).len()).find(|n| *n > 0);
        let mut columns = header::columns(header, count, &layout, is_data)?;
        let mut rows = Vec::new();
        for (k, (line, text)) in body.iter().enumerate() {
            let cells = layout.split(text);
            if cells.len() != columns.len() {
                return refuse(*line, layout.wrong_count(&cells, columns.len()));
            }
            if k == 0 && !is_data && header::take_units(&mut columns, &cells) {
                continue;
            }
            rows.push((*line, layout.with_points(*line, cells)?));
        }
        Ok(Sheet { columns, rows })
    }
}

#[cfg(test)]
mod tests;
