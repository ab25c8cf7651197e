//! The XML of an E57 file before it is parsed: an element with too many attributes, or too many namespaces, would take time to the square.
//!
//! ```text
//! file     bytes 24..32: where the XML begins; 32..40: its length; 40..48: length of a page
//! page     the last 4 bytes are its checksum
//! ```
//!
//! ASTM E2807-11 (2019). Such a file has a few attributes on each element and one namespace for each extension.

/// Most attributes of an element, and most namespaces of a file.
const MOST: usize = 256;
/// Length of the checksum of a page [B].
const CHECKSUM: usize = 4;

/// Refuses XML that takes time to the square.
pub(crate) fn check(bytes: &[u8]) -> Result<(), String> {
    let mut scan = Scan::default();
    let Some(parts) = parts(bytes) else { return Ok(()) };
    for part in parts {
        part.iter().try_for_each(|&byte| scan.take(byte))?;
    }
    Ok(())
}

/// The XML, page by page; none where the header makes no sense, which the parser refuses.
fn parts(bytes: &[u8]) -> Option<impl Iterator<Item = &[u8]>> {
    let number = |at: usize| {
        let eight = bytes.get(at..at + 8)?.try_into().ok()?;
        usize::try_from(u64::from_le_bytes(eight)).ok()
    };
    let (mut at, mut left, page) = (number(24)?, number(32)?, number(40)?);
    (page > CHECKSUM && at < bytes.len()).then_some(())?;
    Some(std::iter::from_fn(move || {
        let end = (at / page).checked_add(1)?.checked_mul(page)?;
        let part = bytes.get(at..(end - CHECKSUM).min(bytes.len())).unwrap_or_default();
        let part = &part[..part.len().min(left)];
        (at, left) = (end, left - part.len());
        (left > 0 || !part.is_empty()).then_some(part).filter(|_| end - page < bytes.len())
    }))
}

/// What the next byte belongs to.
#[derive(Clone, Copy, PartialEq, Default)]
enum Place {
    #[default]
    Text,
    Tag,
    /// A value, up to this quote.
    Value(u8),
    /// What is no element, up to the last byte of this mark.
    Other(&'static [u8]),
}

#[derive(Default)]
struct Scan {
    place: Place,
    /// The last bytes.
    last: [u8; 9],
    attributes: usize,
    namespaces: usize,
}

impl Scan {
    fn take(&mut self, byte: u8) -> Result<(), String> {
        self.last.copy_within(1.., 0);
        self.last[8] = byte;
        self.place = match (self.place, byte) {
            (Place::Text, b'<') => {
                self.attributes = 0;
                Place::Tag
            }
            (Place::Tag, b'>') => Place::Text,
            (Place::Tag, b'"' | b'\'') => {
                self.attributes += 1;
                Place::Value(byte)
            }
            (Place::Tag, _) if self.last.ends_with(b"<!--") => Place::Other(b"-->"),
            (Place::Tag, _) if self.last.ends_with(b"<![CDATA[") => Place::Other(b"]]>"),
            (Place::Tag, _) => {
                self.namespaces += usize::from(self.last.ends_with(b"xmlns"));
                Place::Tag
            }
            (Place::Value(quote), _) if byte == quote => Place::Tag,
            (Place::Other(end), _) if self.last.ends_with(end) => Place::Text,
            (place, _) => place,
        };
        let many = [
            (self.attributes, "an element of its XML has more than 256 attributes"),
            (self.namespaces, "its XML has more than 256 namespaces"),
        ];
        match many.iter().find(|(count, _)| *count > MOST) {
            Some((_, what)) => Err((*what).to_owned()),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file of pages of 64 bytes whose XML begins at 50.
    fn file(xml: &str) -> Vec<u8> {
        let mut bytes = vec![0u8; 50];
        bytes[24..32].copy_from_slice(&50u64.to_le_bytes());
        bytes[32..40].copy_from_slice(&(xml.len() as u64).to_le_bytes());
        bytes[40..48].copy_from_slice(&64u64.to_le_bytes());
        for byte in xml.bytes() {
            bytes.push(byte);
            if bytes.len() % 64 == 60 {
                // A quote, or the end of a tag, that is no part of the text.
                bytes.extend_from_slice(b"\"'><");
            }
        }
        bytes
    }

    #[test]
    fn attributes_and_namespaces_are_counted_across_pages() {
        let element = |count: usize| {
            let all: String = (0..count).map(|k| format!(" a{k}='<\">{k}'")).collect();
            format!("<e57Root{all}>")
        };
        assert_eq!(check(&file(&element(256).repeat(3))), Ok(()));
        let why = check(&file(&(element(3) + &element(257)))).unwrap_err();
        assert!(why.contains("256 attributes"), "{why}");
        let nested: String = (0..257).map(|k| format!("<a xmlns:n{k}=\"u{k}\">")).collect();
        assert!(check(&file(&nested)).unwrap_err().contains("256 namespaces"));
    }

    #[test]
    fn quotes_outside_of_elements_are_no_attributes() {
        let quotes = "it's \"5\" < 6 ".repeat(300);
        for text in
            [format!("<a><![CDATA[{quotes}]]></a>"), format!("<!--{quotes}--><a/>"), quotes.replace('<', "")]
        {
            assert_eq!(check(&file(&text)), Ok(()), "{}", &text[..12]);
        }
    }

    #[test]
    fn headers_without_sense_are_for_the_parser() {
        for (at, number) in [(24, u64::MAX), (32, u64::MAX), (40, 0), (40, 3), (40, u64::MAX), (24, 1 << 40)]
        {
            let mut bytes = file("<a b='c'>");
            bytes[at..at + 8].copy_from_slice(&number.to_le_bytes());
            assert_eq!(check(&bytes), Ok(()), "{at} {number}");
        }
        assert_eq!(check(b"ASTM-E57"), Ok(()));
    }
}
