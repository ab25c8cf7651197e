//! Lines that end in LF, CRLF or CR.

/// Cuts bytes into lines; the first line end decides which kind the file has.
pub(super) struct Lines<'a> {
    bytes: &'a [u8],
    /// Where the next line begins.
    pub at: usize,
    /// Number of the line given last, from 1.
    pub number: usize,
    ending: Ending,
}

#[derive(Clone, Copy, PartialEq)]
enum Ending {
    Lf,
    CrLf,
    Cr,
}

impl<'a> Lines<'a> {
    pub fn new(bytes: &'a [u8]) -> Lines<'a> {
        let first = bytes.iter().position(|b| matches!(b, b'\n' | b'\r'));
        let ending = match first.map(|i| (bytes[i], bytes.get(i + 1))) {
            Some((b'\r', Some(b'\n'))) => Ending::CrLf,
            Some((b'\r', _)) => Ending::Cr,
            _ => Ending::Lf,
        };
        Lines { bytes, at: 0, number: 0, ending }
    }

    /// Goes on from a place in the file, with the lines before it counted.
    pub fn from(bytes: &'a [u8], at: usize, number: usize) -> Lines<'a> {
        Lines { at, number, ..Lines::new(bytes) }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = self.bytes.get(self.at..).filter(|rest| !rest.is_empty())?;
        let stop = if self.ending == Ending::Cr { b'\r' } else { b'\n' };
        let length = rest.iter().position(|&b| b == stop);
        self.at += length.map_or(rest.len(), |l| l + 1);
        self.number += 1;
        let line = &rest[..length.unwrap_or(rest.len())];
        // A CR before LF is dropped in any file: some writers mix both.
        Some(line.strip_suffix(b"\r").filter(|_| self.ending != Ending::Cr).unwrap_or(line))
    }
}
