//! Text data: one row per line; blank lines are skipped.

use super::{
    Element, Ply, PlyError,
    binary::finish,
    header::{ElementHeader, Header, Property},
    text::Lines,
};
use crate::{Values, table::each};

/// Reads the data that begin at `at`.
pub(super) fn body(header: Header, bytes: &[u8], at: usize) -> Result<Ply, PlyError> {
    let mut lines = Lines::from(bytes, at, header.lines);
    let mut ply = Ply { comments: header.comments, obj_info: header.obj_info, elements: Vec::new() };
    for element in &header.elements {
        ply.elements.push(rows(element, &mut lines)?);
    }
    let byte = lines.at as u64;
    match lines.find(|line| !line.trim_ascii().is_empty()) {
        Some(_) => Err(PlyError::Trailing { extra: bytes.len() as u64 - byte, byte }),
        None => Ok(ply),
    }
}

fn rows(element: &ElementHeader, lines: &mut Lines) -> Result<Element, PlyError> {
    let mut columns: Vec<_> = element.properties.iter().map(|p| (p.kind.empty(), Vec::new())).collect();
    for row in 0..element.rows {
        let Some(line) = lines.find(|line| !line.trim_ascii().is_empty()) else {
            let (element, rows, byte) = (element.name.clone(), element.rows, lines.at as u64);
            return Err(PlyError::Truncated { element, rows, row, byte });
        };
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let place = NumberPlace { element, row, line: lines.number };
        for (property, (values, ends)) in element.properties.iter().zip(&mut columns) {
            let count = if property.count.is_some() { place.count(property, words.next())? } else { 1 };
            for _ in 0..count {
                place.number(property, words.next(), values)?;
            }
            if property.count.is_some() {
                ends.push(values.len());
            }
        }
        if let Some(word) = words.next() {
            let found = String::from_utf8_lossy(word).into_owned();
            let (element, line) = (element.name.clone(), lines.number);
            return Err(PlyError::Extra { line, element, row, extra: 1 + words.count(), found });
        }
    }
    finish(element, columns)
}

/// Where a number stands, for messages.
struct NumberPlace<'a> {
    element: &'a ElementHeader,
    row: u64,
    line: usize,
}

impl NumberPlace<'_> {
    /// Parses a word into the end of `values`.
    fn number(&self, property: &Property, word: Option<&[u8]>, values: &mut Values) -> Result<(), PlyError> {
        let text = word.and_then(|word| std::str::from_utf8(word).ok());
        let pushed = text.and_then(|text| each!(values, v => Text::parse(text).map(|x| v.push(x))));
        pushed.ok_or_else(|| self.wrong(property, word, property.kind.word()))
    }

    /// The number of items of a list.
    fn count(&self, property: &Property, word: Option<&[u8]>) -> Result<usize, PlyError> {
        let text = word.and_then(|word| std::str::from_utf8(word).ok());
        let count = text.and_then(<u32 as Text>::parse);
        count.map(|n| n as usize).ok_or_else(|| self.wrong(property, word, "count of a list"))
    }

    fn wrong(&self, property: &Property, word: Option<&[u8]>, kind: &'static str) -> PlyError {
        PlyError::Number {
            line: self.line,
            element: self.element.name.clone(),
            row: self.row,
            property: property.name.clone(),
            found: word
                .map_or("nothing".into(), |w| String::from_utf8_lossy(&w[..w.len().min(40)]).into_owned()),
            kind,
        }
    }
}

/// A number as text.
trait Text: Sized {
    fn parse(text: &str) -> Option<Self>;
}

macro_rules! integer {
    ($($t:ty)*) => {$(
        impl Text for $t {
            fn parse(text: &str) -> Option<$t> {
                // Some writers put whole numbers down as "3.0".
                let whole = || text.parse::<f64>().ok().filter(|x| x.fract() == 0.0).map(|x| x as i64);
                text.parse().ok().or_else(|| whole().and_then(|x| <$t>::try_from(x).ok()))
            }
        }
    )*};
}
integer!(i8 u8 i16 u16 i32 u32);

macro_rules! float {
    ($($t:ident)*) => {$(
        impl Text for $t {
            fn parse(text: &str) -> Option<$t> {
                text.parse().ok().or_else(|| spelled_by_old_c_libraries(text).map(|x| x as $t))
            }
        }
    )*};
}
float!(f32 f64);

/// "nan" and "inf" are understood by Rust; Windows wrote "-1.#IND", "1.#QNAN", "1.#INF", glibc "-nan".
fn spelled_by_old_c_libraries(text: &str) -> Option<f64> {
    let (sign, word) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest));
    let word = word.to_ascii_lowercase();
    if word.starts_with("1.#inf") {
        Some(sign * f64::INFINITY)
    } else if word.starts_with("1.#") || word.starts_with("nan") {
        Some(f64::NAN)
    } else {
        None
    }
}
