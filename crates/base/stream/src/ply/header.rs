//! The header: lines of words up to `end_header`.

use super::{Encoding, NumberType, PlyError, text::Lines};
use crate::MOST_COLUMNS;

/// What the header says.
pub(super) struct Header {
    pub encoding: Encoding,
    pub comments: Vec<String>,
    pub obj_info: Vec<String>,
    pub elements: Vec<ElementHeader>,
    /// Lines up to and with `end_header`.
    pub lines: usize,
}

/// One `element` line and its properties.
pub(super) struct ElementHeader {
    pub name: String,
    pub rows: u64,
    pub properties: Vec<Property>,
}

/// One `property` line.
pub(super) struct Property {
    pub name: String,
    /// Type of the count, for a list.
    pub count: Option<NumberType>,
    pub kind: NumberType,
}

impl ElementHeader {
    /// Bytes of a row in binary, when it has no list.
    pub fn stride(&self) -> Option<usize> {
        self.properties.iter().map(|p| p.count.is_none().then(|| p.kind.size())).sum()
    }
}

/// Parses the header; the second value is where the data begin.
pub(super) fn parse(bytes: &[u8]) -> Result<(Header, usize), PlyError> {
    let mut lines = Lines::new(bytes);
    if lines.next().map(<[u8]>::trim_ascii_end) != Some(b"ply") {
        let found = String::from_utf8_lossy(&bytes[..bytes.len().min(16)]).into_owned();
        return Err(PlyError::Header { line: 1, what: "a PLY file begins with the line 'ply'", found });
    }
    let mut format = None;
    let mut header = Header {
        encoding: Encoding::Ascii,
        comments: Vec::new(),
        obj_info: Vec::new(),
        elements: Vec::new(),
        lines: 0,
    };
    while let Some(line) = lines.next() {
        // Comments may be in any encoding; the rest is ASCII.
        let line = String::from_utf8_lossy(line);
        let wrong = |what| PlyError::Header { line: lines.number, what, found: shortened(&line) };
        let (word, rest) = line.trim_end().split_once([' ', '\t']).unwrap_or((line.trim_end(), ""));
        match word {
            "format" if format.is_some() => return Err(wrong("a second format")),
            "format" => format = Some(encoding(rest).map_err(wrong)?),
            "end_header" => {
                header.encoding = format.ok_or_else(|| wrong("no 'format' line before the end"))?;
                if let Some(e) = header.elements.iter().find(|e| e.rows > 0 && e.properties.is_empty()) {
                    return Err(PlyError::Empty { element: e.name.clone(), rows: e.rows });
                }
                header.lines = lines.number;
                // The line break after `end_header` is part of the header; data that follow it may be LF bytes.
                return Ok((header, lines.at));
            }
            _ => header.take(word, rest).map_err(wrong)?,
        }
    }
    Err(PlyError::NoEnd)
}

impl Header {
    /// Takes what a line says, or tells what is wrong with it.
    fn take(&mut self, word: &str, rest: &str) -> Result<(), &'static str> {
        match word {
            "" => {}
            "comment" => self.comments.push(rest.to_owned()),
            "obj_info" => self.obj_info.push(rest.to_owned()),
            "element" => {
                let element = element(rest).ok_or("not 'element NAME COUNT'")?;
                if self.elements.len() >= MOST_COLUMNS {
                    return Err("more than 4096 elements");
                }
                if self.elements.iter().any(|e| e.name == element.name) {
                    return Err("a second element of this name");
                }
                self.elements.push(element);
            }
            "property" => {
                let property = property(rest)?;
                let element = self.elements.last_mut().ok_or("a property before any element")?;
                if element.properties.len() >= MOST_COLUMNS {
                    return Err("an element has more than 4096 properties");
                }
                if element.properties.iter().any(|p| p.name == property.name) {
                    return Err("this name occurs twice in its element");
                }
                element.properties.push(property);
            }
            _ => return Err("unknown word"),
        }
        Ok(())
    }
}

fn encoding(rest: &str) -> Result<Encoding, &'static str> {
    let mut words = rest.split_ascii_whitespace();
    match (words.next(), words.next()) {
        (Some("ascii"), Some("1.0")) => Ok(Encoding::Ascii),
        (Some("binary_little_endian"), Some("1.0")) => Ok(Encoding::BinaryLittleEndian),
        (Some("binary_big_endian"), Some("1.0")) => Ok(Encoding::BinaryBigEndian),
        _ => Err("unknown format (known: ascii, binary_little_endian, binary_big_endian, 1.0)"),
    }
}

fn element(rest: &str) -> Option<ElementHeader> {
    let mut words = rest.split_ascii_whitespace();
    let (name, rows) = (words.next()?, words.next()?);
    let rows = rows.parse().ok()?;
    words.next().is_none().then(|| ElementHeader { name: name.to_owned(), rows, properties: Vec::new() })
}

fn property(rest: &str) -> Result<Property, &'static str> {
    let words: Vec<&str> = rest.split_ascii_whitespace().collect();
    let kind = |word: &str| {
        NumberType::named(word).ok_or("unknown type (char uchar short ushort int uint float double)")
    };
    match words[..] {
        ["list", count, item, name] => {
            let count = kind(count)?;
            if matches!(count, NumberType::F32 | NumberType::F64) {
                return Err("the count of a list is a whole number");
            }
            Ok(Property { name: name.to_owned(), count: Some(count), kind: kind(item)? })
        }
        [item, name] => Ok(Property { name: name.to_owned(), count: None, kind: kind(item)? }),
        _ => Err("not 'property TYPE NAME' or 'property list TYPE TYPE NAME'"),
    }
}

fn shortened(line: &str) -> String {
    line.chars().take(80).collect()
}
