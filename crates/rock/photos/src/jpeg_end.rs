//! Whether a JPEG is all there: decoders fill what is missing with grey, and say nothing.
//!
//! Segments FF xx with their lengths follow each other up to the scan, whose data hold FF only before 00 or a restart mark. The picture ends with FF D9; what
//! follows, as the small pictures that some cameras append, is not looked at. ITU-T T.81 (1992), annex B.

/// Marks without a length: of the arithmetic of T.81, restarts, and the start.
fn is_bare(mark: u8) -> bool {
    matches!(mark, 0x01 | 0xd0..=0xd8)
}

/// Whether the mark of the end of the picture is there.
pub(crate) fn has_end(bytes: &[u8]) -> bool {
    let mut at = 0;
    loop {
        // The next mark; data and filling bytes are passed over.
        let found = bytes
            .get(at..)
            .and_then(|rest| rest.windows(2).position(|w| w[0] == 0xff && !matches!(w[1], 0 | 0xff)));
        let Some(found) = found else { return false };
        let mark = bytes[at + found + 1];
        at += found + 2;
        if mark == 0xd9 {
            return true;
        }
        if is_bare(mark) {
            continue;
        }
        let Some(&[high, low]) = bytes.get(at..at + 2) else { return false };
        at += usize::from(high) << 8 | usize::from(low);
    }
}
