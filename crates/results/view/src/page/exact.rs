//! Exact positions for a page on which regions are drawn: the points that it marks are those that `cloud-crop` removes.

use std::sync::Arc;
use stream::{Table, Values};

/// The property in which `cloud-crop --mark` writes which points it would remove, as bytes: `cloud::crop::marks` says what a mark is.
const MARK: &str = "removed";

/// Positions as 4-byte numbers where these hold every bit, else as 8-byte numbers.
pub(crate) struct Exact {
    /// Bytes of a coordinate: 4 or 8.
    pub width: usize,
    /// x, y, z of each, little-endian [m].
    pub bytes: Arc<Vec<u8>>,
    /// For each whether `cloud-crop` has marked it; absent where none is marked.
    pub marks: Option<Arc<Vec<u8>>>,
}

impl Exact {
    /// Packs the positions, and the marks that a table has.
    pub fn of(centre: &[&Values; 3], table: &Table) -> Exact {
        let short = centre.iter().flat_map(|axis| axis.iter()).all(|c| f64::from(c as f32) == c);
        let width = if short { 4 } else { 8 };
        let mut bytes = Vec::with_capacity(3 * width * centre[0].len());
        for i in 0..centre[0].len() {
            for axis in centre {
                match short {
                    true => bytes.extend_from_slice(&(axis.get(i) as f32).to_le_bytes()),
                    false => bytes.extend_from_slice(&axis.get(i).to_le_bytes()),
                }
            }
        }
        let marks = match table.get(MARK) {
            Some(Values::U8(marks)) if marks.iter().any(|m| *m != 0) => Some(Arc::new(marks.clone())),
            _ => None,
        };
        Exact { width, bytes: Arc::new(bytes), marks }
    }

    /// How many bytes.
    pub fn len(&self) -> usize {
        self.bytes.len() + self.marks.as_ref().map_or(0, |marks| marks.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_bytes_are_enough_only_where_no_bit_is_lost() {
        let one = |x: f64| Values::F64(vec![x]);
        let at = |x: f64| Exact::of(&[&one(x), &one(0.5), &one(-3.0)], &Table::with_rows(1));
        assert_eq!((at(0.25).width, at(0.25).len()), (4, 12));
        assert_eq!((at(0.1).width, at(0.1).len()), (8, 24));
        assert_eq!(at(0.1).bytes[..8], 0.1f64.to_le_bytes());
    }
}
