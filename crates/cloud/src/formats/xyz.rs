//! Text: one point per line, as in XYZ, PTS, CSV, ASC and TXT exports.
//!
//! Numbers are separated by blanks, tabs, commas or semicolons; decimal commas are refused. Lines that begin with `#` or `//` are
//! comments. A first line of words names the columns. A line with a single whole number gives the number of
//! points that follow (PTS; again in front of each further scan).

use super::ReadError;
use crate::Cloud;
use geom::Vec3;
use stream::{MOST_COLUMNS, Table, Values};

/// The columns of PTS after x, y, z, by their number.
const PTS: [&[&str]; 5] =
    [&[], &["intensity"], &[], &["red", "green", "blue"], &["intensity", "red", "green", "blue"]];

/// Text has no mark: any bytes without control characters in their beginning will do.
pub(super) fn matches(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(4096)];
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    let text = |b: &u8| matches!(b, b'\t' | b'\n' | b'\r' | b' '..=b'~' | 0x80..);
    let word = |b: &u8| {
        matches!(b, b'0'..=b'9' | b'-' | b'+' | b'.' | b'#' | b'/' | b'"') || b.is_ascii_alphabetic()
    };
    head.iter().all(text)
        && head.iter().find(|b| !b.is_ascii_whitespace()).is_some_and(word)
        && head.iter().any(u8::is_ascii_digit)
}

pub(super) fn read(bytes: Vec<u8>) -> Result<Cloud, ReadError> {
    let mut rows = Rows::default();
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
    let cr_only = !bytes.contains(&b'\n');
    let mut number = 0;
    for line in bytes.split(|&b| b == if cr_only { b'\r' } else { b'\n' }) {
        number += 1;
        let line = std::str::from_utf8(line)
            .map_err(|_| error(number, "not UTF-8 text", &String::from_utf8_lossy(line)))?;
        rows.line(number, line.trim())?;
    }
    rows.into_cloud(number)
}

fn error(line: usize, what: impl Into<String>, text: &str) -> ReadError {
    ReadError::Text { line, what: what.into(), text: text.chars().take(80).collect() }
}

fn words(line: &str) -> impl Iterator<Item = &str> {
    // A comma or semicolon with blanks around it is one separator.
    line.split([' ', '\t', ',', ';']).filter(|w| !w.is_empty())
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
    names: Option<Vec<String>>,
    /// Columns of the first point.
    width: usize,
    /// Points that the count lines so far promise.
    promised: Option<usize>,
    comments: Vec<String>,
}

impl Rows {
    fn line(&mut self, number: usize, line: &str) -> Result<(), ReadError> {
        if line.is_empty() {
            return Ok(());
        }
        if let Some(comment) = line.strip_prefix('#').or_else(|| line.strip_prefix("//")) {
            let comment = comment.trim_start_matches(['#', '/']).trim();
            if self.points.is_empty() && self.names.is_none() && is_header(comment) {
                self.names = Some(names(comment));
            } else if self.points.is_empty() && self.comments.len() < 100 {
                self.comments.push(comment.to_owned());
            }
            return Ok(());
        }
        if self.points.is_empty() && self.names.is_none() && is_header(line) {
            self.names = Some(names(line));
            return Ok(());
        }
        let done = self.promised.is_none_or(|p| p == self.points.len());
        if done
            && let (Ok(count), true) =
                (line.parse::<usize>(), self.promised.is_some() || self.points.is_empty())
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

    fn point(&mut self, number: usize, line: &str) -> Result<(), ReadError> {
        if decimal_commas(line) {
            return Err(error(number, "decimal commas: write numbers with a point", line));
        }
        let mut values = [0.0; 3];
        let mut width = 0;
        for word in words(line) {
            let value: f64 = word.parse().map_err(|_| {
                error(number, format!("'{word}' (column {}) is not a number", width + 1), line)
            })?;
            match width {
                0..3 => values[width] = value,
                _ if self.points.is_empty() && width < MOST_COLUMNS => self.extra.push(vec![value]),
                _ if self.points.is_empty() => {
                    let what = format!("more than {MOST_COLUMNS} columns: is the line end missing?");
                    return Err(error(number, what, line));
                }
                _ => match self.extra.get_mut(width - 3) {
                    Some(column) => column.push(value),
                    None => return Err(self.uneven(number, words(line).count(), line)),
                },
            }
            width += 1;
        }
        if width < 3 {
            return Err(error(number, format!("{width} numbers where a point has at least x y z"), line));
        }
        if !self.points.is_empty() && width != self.width {
            return Err(self.uneven(number, width, line));
        }
        self.width = width;
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
        for (i, column) in self.extra.into_iter().enumerate() {
            let given = self.names.as_ref().and_then(|n| n.get(i + 3)).cloned();
            let name = given.or_else(|| pts.map(|names| names[i].to_owned()));
            let name = name.unwrap_or_else(|| format!("c{}", i + 4));
            let name = if attributes.get(&name).is_some() { format!("c{}", i + 4) } else { name };
            let values = typed(&name, column);
            attributes
                .push(&name, values)
                .map_err(|source| ReadError::Table { format: "XYZ/PTS", source })?;
        }
        Ok(Cloud {
            points: self.points,
            attributes,
            double: true,
            position_column: 0,
            comments: self.comments,
        })
    }
}

/// Whether a line names columns: its first three words are x, y, z in some spelling.
fn is_header(line: &str) -> bool {
    let mut words = words(line).map(|w| w.trim_matches('"').to_ascii_lowercase());
    let axis = |word: Option<String>, axis: &str| {
        word.is_some_and(|w| {
            w == axis || w.starts_with(&format!("{axis}_")) || w.starts_with(&format!("{axis}["))
        })
    };
    axis(words.next(), "x") && axis(words.next(), "y") && axis(words.next(), "z")
}

/// Names that PLY can hold; colours in the spelling of PLY.
fn names(line: &str) -> Vec<String> {
    words(line)
        .map(|w| match w.trim_matches('"') {
            "R" | "r" | "Red" => "red".to_owned(),
            "G" | "g" | "Green" => "green".to_owned(),
            "B" | "b" | "Blue" => "blue".to_owned(),
            other => other.chars().map(|c| if c.is_ascii_graphic() { c } else { '_' }).collect(),
        })
        .collect()
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
