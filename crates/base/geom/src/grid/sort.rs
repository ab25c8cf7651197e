//! Sorting of points by cell: both sorts are stable, so that points of one cell stay in the order of their indices.

use rayon::prelude::*;

/// Points that one thread sorts at once, and ranges of cells that they are sorted by, at most.
const PART: usize = 1 << 15;
const RANGES: usize = 256;
/// Bits of a key that one pass of [`sorted`] looks at, at most.
const DIGIT: u32 = 11;

/// Indices of points sorted by their cells, `keys`; and the first sorted place of each of so many `cells`, and one more. All threads sort parts of the points by
/// ranges of cells, then each range by cell.
pub fn by_cell(keys: &[u64], cells: usize) -> (Vec<u32>, Vec<u32>) {
    let width = cells.div_ceil(keys.len().div_ceil(PART).clamp(1, RANGES)).next_power_of_two();
    let ranges = cells.div_ceil(width);
    let parts = keys.par_chunks(PART).enumerate();
    let parts: Vec<ByRange> =
        parts.map(|(n, part)| ByRange::new(part, n * PART, width.trailing_zeros(), ranges)).collect();
    let (mut order, mut starts) = (vec![0; keys.len()], vec![0; cells + 1]);
    starts[cells] = keys.len() as u32;
    let (mut rest, mut pieces, mut first) = (&mut order[..], Vec::with_capacity(ranges), 0);
    for (range, starts) in starts[..cells].chunks_mut(width).enumerate() {
        let (own, others) =
            std::mem::take(&mut rest).split_at_mut(parts.iter().map(|part| part.of(range).len()).sum());
        let count = own.len() as u32;
        pieces.push((range, first, starts, own));
        (first, rest) = (first + count, others);
    }
    pieces.into_par_iter().for_each(|(range, first, starts, order)| {
        let points = || parts.iter().flat_map(|part| part.of(range));
        points().for_each(|&(cell, _)| starts[cell as usize] += 1);
        let mut sum = 0;
        starts.iter_mut().for_each(|start| sum += std::mem::replace(start, sum));
        let mut next = starts.to_vec();
        for &(cell, point) in points() {
            let place = &mut next[cell as usize];
            order[*place as usize] = point;
            *place += 1;
        }
        starts.iter_mut().for_each(|start| *start += first);
    });
    (order, starts)
}

/// Some points, sorted by ranges of cells.
struct ByRange {
    /// Cell within its range, and index, of each.
    points: Vec<(u32, u32)>,
    /// First point of each range, and one more.
    starts: Vec<u32>,
}

impl ByRange {
    /// Points from index `first` on, by ranges of 2^`bits` cells.
    fn new(keys: &[u64], first: usize, bits: u32, ranges: usize) -> ByRange {
        let mut starts = vec![0; ranges + 1];
        keys.iter().for_each(|&key| starts[(key >> bits) as usize + 1] += 1);
        (0..ranges).for_each(|range| starts[range + 1] += starts[range]);
        let (mut next, mut points) = (starts.clone(), vec![(0, 0); keys.len()]);
        for (point, &key) in (first as u32..).zip(keys) {
            let place = &mut next[(key >> bits) as usize];
            points[*place as usize] = ((key & ((1 << bits) - 1)) as u32, point);
            *place += 1;
        }
        ByRange { points, starts }
    }

    /// Those of a range.
    fn of(&self, range: usize) -> &[(u32, u32)] {
        &self.points[self.starts[range] as usize..self.starts[range + 1] as usize]
    }
}

/// Sorts by the upper 32 bits, which are at most `most`, keeping the order of equals (least significant digit first).
pub fn sorted(mut items: Vec<u64>, most: u64) -> Vec<u64> {
    let bits = u64::BITS - most.leading_zeros();
    // As few bits at a time as the passes allow: fewer places to write to stay in the cache.
    let digit = bits.div_ceil(bits.div_ceil(DIGIT).max(1)).max(1);
    let mut other = vec![0; items.len()];
    for shift in (32..32 + bits).step_by(digit as usize) {
        let digit = |item: u64| (item >> shift) as usize & ((1 << digit) - 1);
        let mut next = [0u32; 1 << DIGIT];
        items.iter().for_each(|&item| next[digit(item)] += 1);
        let mut sum = 0;
        next.iter_mut().for_each(|n| sum += std::mem::replace(n, sum));
        for &item in &items {
            let place = &mut next[digit(item)];
            other[*place as usize] = item;
            *place += 1;
        }
        std::mem::swap(&mut items, &mut other);
    }
    items
}
