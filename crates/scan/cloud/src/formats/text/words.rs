//! The words of a line of text: what separates them, and numbers as programs write them.

/// What separates the columns of a line: one character, between two of which a column may be empty, or (none) any run of blanks, tabs, commas and semicolons.
pub(crate) type Separator = Option<char>;

/// What programs write where there is no value, in lower case.
const NO_VALUE: [&str; 10] =
    ["null", "na", "n/a", "#n/a", "-", "nan(ind)", "-nan(ind)", "1.#qnan", "-1.#ind", "1.#ind"];

/// What separates the numbers of a line; a tab counts only if `tabs` says so, because some programs align columns with several.
pub(crate) fn separator(line: &str, tabs: bool) -> Separator {
    let found = [';', ',', '\t'].into_iter().find(|&s| (s != '\t' || tabs) && line.contains(s))?;
    // "1 2 3, 4" is separated by anything.
    let is_one = |piece: &str| piece.starts_with('"') || !piece.contains([' ', '\t']);
    let is_plain = !(line.contains(' ') || line.contains('\t'));
    (is_plain || pieces(line, Some(found)).all(is_one)).then_some(found)
}

/// The separator that gives a line exactly so many columns; one more of it at the end separates nothing.
pub(crate) fn separator_for(line: &str, columns: usize) -> Separator {
    let count = |&one: &char| {
        let found = pieces(line, Some(one));
        found.clone().count() == columns
            || found.clone().count() == columns + 1 && found.last().is_some_and(str::is_empty)
    };
    [';', ',', '\t'].into_iter().filter(|&one| line.contains(one)).find(count)
}

/// The columns of a line of numbers.
pub(crate) fn pieces(line: &str, separator: Separator) -> Pieces<'_> {
    let any = [' ', '\t', ',', ';'];
    let separates = separator.map_or(any, |one| [one; 4]).map(|c| c as u8);
    Pieces { rest: Some(line.trim_end_matches([' ', '\r'])), separates, is_strict: separator.is_some() }
}

/// Parts of a line; bytes are looked at, because this takes most of the time of reading. Quotes hold what separates elsewhere.
#[derive(Clone)]
pub(crate) struct Pieces<'a> {
    rest: Option<&'a str>,
    separates: [u8; 4],
    is_strict: bool,
}

impl<'a> Iterator for Pieces<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        loop {
            let rest = self.rest?;
            let [a, b, c, d] = self.separates;
            let separates = |byte: u8| byte == a || byte == b || byte == c || byte == d;
            let from = match rest.as_bytes().first() {
                Some(b'"') => closing(rest, 0, separates),
                Some(b' ') if self.is_strict => {
                    closing(rest, rest.len() - rest.trim_start_matches(' ').len(), separates)
                }
                _ => 0,
            };
            let end = if from == 0 {
                rest.bytes().position(separates)
            } else {
                rest.bytes().skip(from).position(separates).map(|end| end + from)
            };
            let piece = match end {
                Some(end) => {
                    self.rest = rest.get(end + 1..);
                    &rest[..end]
                }
                None => {
                    self.rest = None;
                    rest
                }
            };
            if self.is_strict {
                return Some(piece.trim_ascii());
            }
            if !piece.is_empty() {
                return Some(piece);
            }
        }
    }
}

/// Where the quotes end that begin at `from`, if a separator or the end follows; 0 otherwise: a quote within a word is a letter.
fn closing(text: &str, from: usize, separates: impl Fn(u8) -> bool) -> usize {
    let Some(inner) = text[from..].strip_prefix('"') else { return 0 };
    let Some(length) = inner.find('"') else { return 0 };
    let end = from + length + 2;
    let behind = &text[end..];
    let next = behind.trim_ascii_start();
    if next.len() < behind.len() || next.bytes().next().is_none_or(separates) { end } else { 0 }
}

/// A number as programs write it besides: in quotes, with the exponents of Fortran, or a word for no value.
pub(crate) fn unusual(word: &str) -> Option<f64> {
    let bare = word.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).unwrap_or(word).trim();
    let lower = bare.to_ascii_lowercase();
    if bare.is_empty() || NO_VALUE.contains(&lower.as_str()) {
        return Some(f64::NAN);
    }
    lower.replacen('d', "e", 1).parse().ok()
}

/// The names of a line; quotes hold names with a separator.
pub(crate) fn split(text: &str, separator: Separator) -> Vec<String> {
    let Some(separator) = separator else {
        return pieces(text, None).map(|w| w.trim_matches('"').to_owned()).collect();
    };
    let mut records = csv::ReaderBuilder::new()
        .delimiter(separator as u8)
        .has_headers(false)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes())
        .into_records();
    let record = records.next().and_then(Result::ok).unwrap_or_default();
    record.iter().map(str::to_owned).collect()
}
