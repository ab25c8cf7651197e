//! Where the names of the columns come from: the file, or the user.

use super::{Rows, decimal_commas, error};
use crate::formats::error::ReadError;
use crate::formats::text::columns::{Header, Named, axes};
use crate::formats::text::given::TextColumns;
use crate::formats::text::names::{for_ply, units_below};
use crate::formats::text::words::{Separator, pieces, separator, separator_for, unusual};
use crate::points::{LengthUnit, ReadWarning};
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
        let commented = std::mem::take(&mut self.commented);
        let listed = match &self.given {
            Some(TextColumns::Listed(names)) => Some(names.clone()),
            Some(TextColumns::Chosen(names)) if self.header.is_none() && commented.is_empty() => {
                let what = format!(
                    "no line in front of the first point names the columns {}: give --columns with all names in the order of the file",
                    names.join(", ")
                );
                return Err(error(number, what, line));
            }
            _ => None,
        };
        let mut length = None;
        if let Some(names) = listed {
            self.begin_listed(number, line, &names)?;
        } else if let Some(Named { names, axes, by_tabs, length: named }) = self.named(line, commented)? {
            (self.width, self.names, self.axes, self.by_tabs) = (names.len(), names, axes, by_tabs);
            length = named;
        } else {
            let separator = separator(line, false);
            let open = separator.is_some_and(|s| line.trim_end_matches([' ', '\r']).ends_with(s));
            (self.width, self.axes) = (pieces(line, separator).count() - usize::from(open), [0, 1, 2]);
        }
        if self.width > MOST_COLUMNS {
            let what = format!("more than {MOST_COLUMNS} columns: is the line end missing?");
            return Err(error(number, what, line));
        }
        let below = self.units.as_ref().and_then(|units| units_below(units, &self.axes));
        self.warnings.extend(length.or(below).and_then(ReadWarning::of_header));
        Ok(())
    }

    /// The names that the file gives the columns of its first line of numbers: a line of names, or else the last comment that can be one.
    fn named(&mut self, row: &str, commented: Vec<(usize, Header)>) -> Result<Option<Named>, ReadError> {
        let mut found = None;
        let mut wrong = None;
        match &self.header {
            Some(header) => {
                let names = header.columns(row).map_err(|what| error(header.line, what, &header.text))?;
                found = names.map(|names| (commented.len(), names));
            }
            None => {
                for (k, (_, header)) in commented.iter().enumerate().rev() {
                    match header.columns(row) {
                        Ok(Some(names)) => {
                            found = Some((k, names));
                            break;
                        }
                        Ok(None) => {}
                        Err(what) => wrong = Some(error(header.line, what, &header.text)),
                    }
                }
            }
        }
        if let (None, Some(wrong)) = (&found, wrong) {
            return Err(wrong);
        }
        if let (None, Some((_, header))) =
            (&found, commented.iter().rev().find(|(_, header)| header.is_in_doubt()))
        {
            self.warnings.push(ReadWarning::NamesInDoubt {
                line: header.line,
                text: header.text.chars().take(80).collect(),
                words: header.words(),
                columns: pieces(row, separator(row, false)).count(),
            });
        }
        let used = found.as_ref().map(|(k, _)| *k);
        for (k, (place, header)) in commented.into_iter().enumerate().rev() {
            if Some(k) != used {
                self.comments.insert(place, header.text);
            }
        }
        Ok(found.map(|(_, names)| names))
    }

    /// The same with names that the user gives.
    fn begin_listed(&mut self, number: usize, line: &str, names: &[Option<String>]) -> Result<(), ReadError> {
        let plain: Vec<String> = names.iter().map(|name| name.clone().unwrap_or_default()).collect();
        self.left_out = names.iter().map(Option::is_none).collect();
        (self.width, self.axes) = (names.len(), axes(&plain).ok().flatten().unwrap_or([0, 1, 2]));
        self.names = for_ply(&plain);
        let count = |separator: Separator| {
            let open = separator.is_some_and(|s| line.trim_end_matches([' ', '\r']).ends_with(s));
            let count = pieces(line, separator).count();
            count - usize::from(open && count > names.len())
        };
        self.by_tabs = count(separator(line, true)) == names.len();
        let found = count(self.separator(line));
        if found != names.len() {
            let what = format!("--columns names {} columns, and the first point has {found}", names.len());
            return Err(error(number, what, line));
        }
        Ok(())
    }

    /// Whether a comma is the decimal sign of a number; what stands in columns that are left out is none.
    pub(super) fn has_decimal_commas(&self, line: &str) -> bool {
        let Some(TextColumns::Listed(names)) = self.given.as_ref().filter(|_| line.contains(',')) else {
            return decimal_commas(line);
        };
        match separator_for(line, names.len()) {
            Some(one) if names.contains(&None) => {
                let mut due = pieces(line, Some(one)).zip(names).filter(|(_, name)| name.is_some());
                due.any(|(word, _)| word.contains(','))
            }
            _ => decimal_commas(line),
        }
    }

    /// What to say of a word that is not a number.
    pub(super) fn not_a_number(&self, number: usize, word: &str, column: usize, line: &str) -> ReadError {
        let what = format!("'{word}' (column {}) is not a number", column + 1);
        let is_first = self.points.is_empty() && self.names.is_empty();
        let cure = match is_first && self.given.is_none() {
            true => {
                "; a line of names has x, y and z among them: name the columns with --columns, - for one that is left out"
            }
            false => "",
        };
        error(number, what + cure, line)
    }
}

/// Whether a line names columns: words where numbers are due, and nothing there that begins as a number does.
pub(super) fn names_other(line: &str, names: &[Option<String>]) -> bool {
    let separator = separator_for(line, names.len()).or_else(|| separator(line, true));
    let is_due = |k: usize| !names.get(k).is_some_and(Option::is_none);
    let due: Vec<&str> =
        pieces(line, separator).enumerate().filter(|(k, _)| is_due(*k)).map(|(_, word)| word).collect();
    let begins_as_a_number = |word: &&str| {
        let word = word.trim_start_matches('"').trim_start();
        word.trim_start_matches(['+', '-', '\u{2212}', '.']).starts_with(|c: char| c.is_ascii_digit())
    };
    let is_word = |word: &&str| word.parse::<f64>().is_err() && unusual(word).is_none();
    due.iter().any(is_word) && !due.iter().any(begins_as_a_number)
}

impl ReadWarning {
    /// What to say of the units that a header gives x, y and z.
    fn of_header(units: [LengthUnit; 3]) -> Option<ReadWarning> {
        let [x, y, z] = &units;
        if x.metres != y.metres || x.metres != z.metres {
            return Some(ReadWarning::HeaderUnits(units));
        }
        (x.metres != 1.0).then(|| ReadWarning::HeaderUnit(x.clone()))
    }
}
