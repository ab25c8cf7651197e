//! Where the names of the columns come from: the file, or the user.

use super::{Rows, error};
use crate::formats::ReadError;
use crate::formats::text_names::TextColumns;
use crate::formats::xyz_columns::{Header, Named, axes, for_ply, pieces, separator, unusual};
use stream::MOST_COLUMNS;

impl Rows {
    /// The names of a line, unless the user gives them all.
    pub(super) fn names_in(&self, line: &str, number: usize, is_comment: bool) -> Option<Header> {
        match &self.given {
            Some(TextColumns::Listed(_)) => None,
            Some(TextColumns::Chosen(names)) => Header::new(line, number, is_comment, Some(names)),
            None => Header::new(line, number, is_comment, None),
        }
    }

    /// Takes the names and the number of columns from the first line of numbers.
    pub(super) fn begin(&mut self, number: usize, line: &str) -> Result<(), ReadError> {
        match &self.given {
            Some(TextColumns::Listed(names)) => {
                let names = names.clone();
                return self.begin_listed(number, line, &names);
            }
            Some(TextColumns::Chosen(names)) if self.header.is_none() => {
                let what = format!(
                    "no line in front of the first point names the columns {}: give --columns with all names in the order of the file",
                    names.join(", ")
                );
                return Err(error(number, what, line));
            }
            _ => {}
        }
        if let Some(header) = &self.header {
            let named = header.columns(line).map_err(|what| error(header.line, what, &header.text))?;
            match named {
                Some(Named { names, axes, by_tabs }) => {
                    (self.width, self.names, self.axes, self.by_tabs) = (names.len(), names, axes, by_tabs);
                    return Ok(());
                }
                None => self.comments.push(header.text.clone()),
            }
        }
        let separator = separator(line, false);
        let open = separator.is_some_and(|s| line.trim_end_matches([' ', '\r']).ends_with(s));
        self.width = pieces(line, separator).count() - usize::from(open);
        if self.width > MOST_COLUMNS {
            let what = format!("more than {MOST_COLUMNS} columns: is the line end missing?");
            return Err(error(number, what, line));
        }
        Ok(())
    }

    /// The same with names that the user gives.
    fn begin_listed(&mut self, number: usize, line: &str, names: &[Option<String>]) -> Result<(), ReadError> {
        let count = |tabs: bool| {
            let separator = separator(line, tabs);
            let open = separator.is_some_and(|s| line.trim_end_matches([' ', '\r']).ends_with(s));
            let count = pieces(line, separator).count();
            count - usize::from(open && count > names.len())
        };
        self.by_tabs = count(true) == names.len();
        if count(self.by_tabs) != names.len() {
            let what =
                format!("--columns names {} columns, and the first point has {}", names.len(), count(false));
            return Err(error(number, what, line));
        }
        let plain: Vec<String> = names.iter().map(|name| name.clone().unwrap_or_default()).collect();
        self.left_out = names.iter().map(Option::is_none).collect();
        (self.width, self.axes) = (names.len(), axes(&plain).ok().flatten().unwrap_or([0, 1, 2]));
        self.names = plain.iter().map(|name| for_ply(name)).collect();
        Ok(())
    }

    /// What to say of a word that is not a number.
    pub(super) fn not_a_number(&self, number: usize, word: &str, column: usize, line: &str) -> ReadError {
        let what = format!("'{word}' (column {}) is not a number", column + 1);
        let is_first = self.points.is_empty() && self.header.is_none();
        let cure = match is_first && self.given.is_none() {
            true => {
                "; a line of names has x, y and z among them: name the columns with --columns, - for one that is left out"
            }
            false => "",
        };
        error(number, what + cure, line)
    }
}

/// Whether a line holds something else than numbers in columns that are not left out: names of the file.
pub(super) fn names_other(line: &str, names: &[Option<String>]) -> bool {
    let mut words = pieces(line, separator(line, true)).enumerate();
    let is_other = |word: &str| word.parse::<f64>().is_err() && unusual(word).is_none();
    words.any(|(k, word)| is_other(word) && !names.get(k).is_some_and(Option::is_none))
}
