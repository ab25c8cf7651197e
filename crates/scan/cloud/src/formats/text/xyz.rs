//! Text: one point per line, as in XYZ, PTS, CSV, ASC and TXT exports.
//!
//! Numbers are separated by blanks, tabs, commas or semicolons; decimal commas are refused. Nothing between two commas or semicolons is a
//! column without a value. Lines that begin with `#` or `//` are comments; the last of them that can
//! be the names of the columns is it. A first line of words names the columns, as many as there are. A line with a single whole number gives the number of points that follow (PTS; again in front of each further scan).

mod naming;

use super::columns::Header;
use super::given::TextColumns;
use super::names::is_units;
use super::words::{Separator, pieces, separator, separator_for, unusual};
use crate::formats::error::ReadError;
use crate::points::Cloud;
use crate::points::ReadWarning;
use geom::Vec3;
use std::borrow::Cow;
use stream::{Table, Values};

/// The columns of PTS after x, y, z, by their number.
const PTS: [&[&str]; 5] =
    [&[], &["intensity"], &[], &["red", "green", "blue"], &["intensity", "red", "green", "blue"]];

/// Text has no mark: any bytes without control characters in their beginning will do.
pub(crate) fn matches(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(4096)];
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    let text = |b: &u8| matches!(b, b'\t' | b'\n' | b'\r' | b' '..=b'~' | 0x80..);
    let word = |b: &u8| {
        matches!(b, b'0'..=b'9' | b'-' | b'+' | b'.' | b'#' | b'/' | b'"' | b',' | b';')
            || b.is_ascii_alphabetic()
    };
    head.iter().all(text)
        && head.iter().find(|b| !b.is_ascii_whitespace()).is_some_and(word)
        && head.iter().any(u8::is_ascii_digit)
}

pub(crate) fn read(bytes: Vec<u8>) -> Result<Cloud, ReadError> {
    read_as(&bytes, None)
}

/// Reads text whose columns the user names.
pub(crate) fn read_as(bytes: &[u8], given: Option<&TextColumns>) -> Result<Cloud, ReadError> {
    let mut rows = Rows { given: given.cloned(), ..Rows::default() };
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let cr_only = !bytes.contains(&b'\n');
    let mut number = 0;
    for line in bytes.split(|&b| b == if cr_only { b'\r' } else { b'\n' }) {
        number += 1;
        rows.line(number, &text(line))?;
    }
    rows.into_cloud(number)
}

/// A line, of Latin-1 if it is not UTF-8: names and comments may have letters of either.
fn text(line: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(line) {
        Ok(text) => text.into(),
        Err(_) => line.iter().map(|&byte| char::from(byte)).collect::<String>().into(),
    }
}

fn error(line: usize, what: impl Into<String>, text: &str) -> ReadError {
    ReadError::Text { line, what: what.into(), text: text.trim().chars().take(80).collect() }
}

/// Whether a comma is the decimal sign: something else, or a comma with a blank, separates numbers.
fn decimal_commas(line: &str) -> bool {
    if !line.contains(',') {
        return false;
    }
    let words = || line.split([' ', '\t']).filter(|w| !w.is_empty());
    let tight = words().any(|w| w.trim_matches(',').contains(','));
    let before = words().zip(words().skip(1));
    let (mut blank, mut comma) = (false, false);
    before.for_each(|(a, b)| {
        let touches = a.ends_with(',') || b.starts_with(',');
        (blank, comma) = (blank || !touches, comma || touches);
    });
    // "1.5,2, 3" has points and is only written unevenly.
    line.contains(';') || (blank && tight) || (comma && tight && !line.contains('.'))
}

#[derive(Default)]
struct Rows {
    points: Vec<Vec3>,
    extra: Vec<Vec<f64>>,
    header: Option<Header>,
    /// Comments that may be the names, with their places among the comments.
    commented: Vec<(usize, Header)>,
    /// The line of units below the names.
    units: Option<String>,
    /// The names that the user gives.
    given: Option<TextColumns>,
    /// Whether a line of names was passed over, because the user gives others.
    passed_over: bool,
    /// Names of all columns, once the first point is there.
    names: Vec<String>,
    /// Which columns are x, y and z.
    axes: [usize; 3],
    /// Which columns are left out, whatever stands in them; empty: none.
    left_out: Vec<bool>,
    /// Whether tabs separate columns one by one.
    by_tabs: bool,
    /// Columns of the first point.
    width: usize,
    /// Points that the count lines so far promise.
    promised: Option<usize>,
    comments: Vec<String>,
    warnings: Vec<ReadWarning>,
}

/// Comments that are kept.
const MOST_COMMENTS: usize = 100;

impl Rows {
    fn line(&mut self, number: usize, line: &str) -> Result<(), ReadError> {
        if line.trim().is_empty() {
            return Ok(());
        }
        let trimmed = line.trim_start();
        if let Some(comment) = trimmed.strip_prefix('#').or_else(|| trimmed.strip_prefix("//")) {
            self.comment(number, comment.trim_start_matches(['#', '/']).trim());
            return Ok(());
        }
        if let (true, Some(TextColumns::Listed(names))) = (self.points.is_empty(), &self.given) {
            if !self.passed_over && naming::names_other(line, names) {
                self.passed_over = true;
                self.comment(number, &format!("columns in the file: {}", line.trim()));
                return Ok(());
            }
        } else if self.points.is_empty()
            && self.header.is_none()
            && let Some(header) = self.names_in(line, number, false)
        {
            self.header = Some(header);
            return Ok(());
        }
        let is_named = self.header.is_some() || self.passed_over;
        if self.points.is_empty() && is_named && is_units(line) {
            self.units = Some(line.trim().to_owned());
            self.comment(number, line.trim());
            return Ok(());
        }
        let done = self.promised.is_none_or(|p| p == self.points.len());
        if done
            && let (Ok(count), true) =
                (line.trim().parse::<usize>(), self.promised.is_some() || self.points.is_empty())
        {
            self.promised = Some(self.points.len().saturating_add(count));
            return Ok(());
        }
        if done && self.promised.is_some() {
            return Err(error(
                number,
                format!("a point after the {} that were promised", self.points.len()),
                line,
            ));
        }
        self.point(number, line)
    }

    fn comment(&mut self, number: usize, comment: &str) {
        if !self.points.is_empty() {
            return;
        }
        if let Some(names) = self.names_in(comment, number, true) {
            self.commented.truncate(MOST_COMMENTS - 1);
            self.commented.push((self.comments.len(), names));
        } else if self.comments.len() < MOST_COMMENTS {
            self.comments.push(comment.to_owned());
        }
    }

    /// What separates the columns of a line.
    fn separator(&self, line: &str) -> Separator {
        let left_out = self.left_out.contains(&true).then(|| separator_for(line, self.width)).flatten();
        left_out.or_else(|| separator(line, self.by_tabs))
    }

    fn point(&mut self, number: usize, line: &str) -> Result<(), ReadError> {
        if self.has_decimal_commas(line) {
            return Err(error(number, "decimal commas: write numbers with a point", line));
        }
        if self.points.is_empty() {
            self.begin(number, line)?;
            self.extra.resize(self.width.saturating_sub(3), Vec::new());
        }
        let separator = self.separator(line);
        let mut values = [0.0; 3];
        let (mut width, mut extra) = (0, 0);
        for word in pieces(line, separator) {
            // A separator at the end separates nothing.
            if width == self.width && word.is_empty() {
                continue;
            }
            let value: f64 = match word {
                "" => f64::NAN,
                word => match word.parse().ok().or_else(|| unusual(word)) {
                    Some(value) => value,
                    None if self.left_out.get(width) == Some(&true) => f64::NAN,
                    None => return Err(self.not_a_number(number, word, width, line)),
                },
            };
            match self.axes.iter().position(|&axis| axis == width) {
                Some(axis) => values[axis] = value,
                None => {
                    let Some(column) = self.extra.get_mut(extra) else {
                        return Err(self.uneven(number, pieces(line, separator).count(), line));
                    };
                    column.push(value);
                    extra += 1;
                }
            }
            width += 1;
        }
        if width == 1 && self.points.is_empty() && self.promised.is_some() {
            let what = "a second whole number begins PTX, whose third line is the place of the scanner, x y z: export it again, or as E57";
            return Err(error(number, what, line));
        }
        if width < 3 {
            return Err(error(number, format!("{width} numbers where a point has at least x y z"), line));
        }
        if width != self.width {
            return Err(self.uneven(number, width, line));
        }
        self.points.push(values.into());
        Ok(())
    }

    fn uneven(&self, number: usize, width: usize, line: &str) -> ReadError {
        error(number, format!("{width} columns where the first point has {}", self.width), line)
    }

    fn into_cloud(self, lines: usize) -> Result<Cloud, ReadError> {
        let found = self.points.len();
        if let Some(promised) = self.promised.filter(|&p| p != found) {
            return Err(error(lines, format!("{promised} points promised, {found} there"), "end of file"));
        }
        if found == 0 && self.promised.is_none() {
            return Err(error(lines, "text without a point", "end of file"));
        }
        let pts =
            self.promised.and(PTS.get(self.extra.len())).filter(|names| names.len() == self.extra.len());
        let mut attributes = Table::with_rows(found);
        let columns = (0..self.width).filter(|column| !self.axes.contains(column));
        for (i, (at, column)) in columns.zip(self.extra).enumerate() {
            if self.left_out.get(at) == Some(&true) {
                continue;
            }
            let given = self.names.get(at).filter(|name| !name.is_empty()).cloned();
            let name = given.or_else(|| pts.map(|names| names[i].to_owned()));
            let name = name.unwrap_or_else(|| format!("c{}", at + 1));
            let is_taken = attributes.get(&name).is_some() || ["x", "y", "z"].contains(&name.as_str());
            let name = if is_taken { format!("c{}", at + 1) } else { name };
            let values = typed(&name, column);
            attributes
                .push(&name, values)
                .map_err(|source| ReadError::Table { format: "XYZ/PTS", source })?;
        }
        Ok(Cloud {
            points: self.points,
            attributes,
            double: true,
            position_column: self.axes.into_iter().min().unwrap_or(0),
            comments: self.comments,
            warnings: self.warnings,
        })
    }
}

/// Colours are bytes where they can be; everything else stays as it was read.
fn typed(name: &str, column: Vec<f64>) -> Values {
    let byte = |v: &f64| v.fract() == 0.0 && (0.0..=255.0).contains(v);
    if matches!(name, "red" | "green" | "blue") && column.iter().all(byte) {
        return Values::U8(column.into_iter().map(|v| v as u8).collect());
    }
    Values::F64(column)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimal_commas_are_refused() {
        for line in ["0,5 1,25 2,0", "0,39;0,04;0,1", "0 1,5 2", "0,5, 1,25, 2,0", "0,5\t1,2\t3"] {
            let message = read(line.as_bytes().to_vec()).unwrap_err().to_string();
            assert!(
                message.contains(&format!("line 1: decimal commas: write numbers with a point: '{line}'"))
            );
        }
        for line in ["1, 2, 3", "1,2,3", "1 , 2 , 3", "1.5,2, 3", "1; 2; 3", "1 2 3", "1,2,3,"] {
            let cloud = read(line.as_bytes().to_vec()).unwrap();
            assert_eq!((cloud.points.len(), cloud.points[0].z), (1, 3.0), "{line}");
        }
    }
}
