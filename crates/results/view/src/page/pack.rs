//! Packing: numbers as 16 bits between the least and the greatest of a frame; whole numbers as 8, 16 or 32, exactly.
//!
//! ```text
//! q = round((v − lo)/(hi − lo) · m)      v ≈ lo + q/m (hi − lo)      |error| ≤ (hi − lo)/(2 m),  m = 65 535
//! whole numbers: hi = lo + m, m = 255, 65 535 or 4 294 967 295, the least that holds them: error 0
//! ```

use super::page_field::Field;
use crate::GrainCount;
use crate::appearance::scale::Range;
use crate::things::spheres::Spheres;
use std::sync::Arc;

/// How much wider than needed a box is made, so that the next frames fit in it too [–].
const ROOM: f64 = 0.02;

/// The range of a column without a number in it.
const NO_RANGE: Range = Range { lo: 0.0, hi: 0.0 };

/// A column of packed numbers.
#[derive(Clone)]
pub(crate) struct Column {
    /// What 0 and the greatest number stand for.
    pub range: Range,
    /// Bytes of a number: 1, 2 or 4, little-endian.
    pub width: usize,
    /// The numbers; the same place in memory as the last frame's when they are the same.
    pub bytes: Arc<Vec<u8>>,
}

impl Column {
    /// Packs values; the bytes of the `last` column are used again where they are the same.
    pub fn new(
        values: impl ExactSizeIterator<Item = f64>,
        range: Range,
        width: usize,
        last: Option<&Column>,
    ) -> Column {
        let range = if range.lo > range.hi { NO_RANGE } else { range };
        let mut bytes = Vec::with_capacity(values.len() * width);
        values.for_each(|v| quantise(v, range, width, &mut bytes));
        let same = last.filter(|l| l.range == range && l.width == width && *l.bytes == bytes);
        Column { range, width, bytes: same.map_or_else(|| Arc::new(bytes), |l| Arc::clone(&l.bytes)) }
    }

    /// Bound on the error of a number by packing, in its unit; none for whole numbers, whose steps are 1.
    pub fn error(&self) -> f64 {
        let steps_of_one = self.range.hi - self.range.lo == most(self.width);
        if self.range.hi > self.range.lo && !steps_of_one {
            (self.range.hi - self.range.lo) / (2.0 * most(self.width))
        } else {
            0.0
        }
    }
}

/// The greatest number of so many bytes.
fn most(width: usize) -> f64 {
    match width {
        1 => 255.0,
        2 => 65_535.0,
        _ => 4_294_967_295.0,
    }
}

fn quantise(value: f64, range: Range, width: usize, bytes: &mut Vec<u8>) {
    let share = if range.hi > range.lo && value.is_finite() { range.share(value) } else { 0.0 };
    let number = (share * most(width)).round() as u32;
    bytes.extend(number.to_le_bytes().into_iter().take(width));
}

/// One layer at one time.
pub(crate) struct Packed {
    /// From when on it is so [s].
    pub time: f64,
    /// How many spheres.
    pub count: usize,
    /// How many grains they are.
    pub grains: GrainCount,
    /// Clumps that are polyhedra, see [`super::solids`].
    pub solids: Arc<Vec<u8>>,
    /// The box of the positions [m].
    pub extent: [Range; 3],
    /// Positions: x, y, z of each, two bytes each.
    pub position: Arc<Vec<u8>>,
    /// Radii [m]; no bytes when all spheres share one.
    pub radius: Column,
    /// The fields, in the layer's order.
    pub fields: Vec<Column>,
}

impl Packed {
    /// Packs a frame, without its fields; `last` is the one before, whose box and bytes are used again where they fit.
    pub fn new(time: f64, spheres: &Spheres, last: Option<&Packed>) -> Packed {
        let range = |k: usize| Range::of(spheres.centre[k].iter());
        let extent = std::array::from_fn(|k| roomy(range(k), last.map(|l| l.extent[k])));
        let mut bytes = Vec::with_capacity(spheres.len() * 6);
        for i in 0..spheres.len() {
            (0..3).for_each(|k| quantise(spheres.centre[k].get(i), extent[k], 2, &mut bytes));
        }
        let same = last.filter(|l| l.extent == extent && *l.position == bytes);
        let position = same.map_or_else(|| Arc::new(bytes), |l| Arc::clone(&l.position));
        let sizes = Range::of(spheres.radii());
        let count = if sizes.hi > sizes.lo { spheres.len() } else { 0 };
        let radii = (0..count).map(|i| spheres.radius(i));
        Packed {
            time,
            count: spheres.len(),
            grains: GrainCount::with(spheres.len(), &[]),
            solids: Arc::default(),
            extent,
            position,
            radius: Column::new(radii, sizes, 2, last.map(|l| &l.radius)),
            fields: Vec::new(),
        }
    }

    /// Packs the next field.
    pub fn add(&mut self, field: &Field, values: &[f64], last: Option<&Packed>) {
        let before = last.and_then(|l| l.fields.get(self.fields.len()));
        let (all, values) = (Range::of(values), values.iter().copied());
        let width = if field.whole { width_of(all) } else { None };
        self.fields.push(match width {
            Some(width) => Column::new(values, whole(all, width), width, before),
            None => Column::new(values, all, 2, before),
        });
    }

    /// Bound on the error of a position along any axis by packing [m].
    pub fn position_error(&self) -> f64 {
        self.extent
            .iter()
            .filter(|r| r.hi > r.lo)
            .map(|r| (r.hi - r.lo) / (2.0 * most(2)))
            .fold(0.0, f64::max)
    }

    /// All columns of bytes.
    pub fn blobs(&self) -> impl Iterator<Item = &Arc<Vec<u8>>> {
        [&self.position, &self.radius.bytes, &self.solids]
            .into_iter()
            .chain(self.fields.iter().map(|f| &f.bytes))
    }
}

/// Bytes that whole numbers of that range need.
fn width_of(all: Range) -> Option<usize> {
    [1, 2, 4].into_iter().find(|&width| all.hi - all.lo <= most(width))
}

/// A range of whole numbers in which each has a packed number of its own: steps of 1.
fn whole(all: Range, width: usize) -> Range {
    if all.lo <= all.hi { Range { lo: all.lo, hi: all.lo + most(width) } } else { all }
}

/// The last frame's range where it still fits, so that what rests keeps its bytes; else a slightly wider one.
fn roomy(needed: Range, last: Option<Range>) -> Range {
    if needed.lo > needed.hi {
        return NO_RANGE; // a frame without grains
    }
    let width = needed.hi - needed.lo;
    match last {
        Some(l) if l.lo <= needed.lo && l.hi >= needed.hi && l.hi - l.lo <= 1.3 * width => l,
        _ if width > 0.0 => Range { lo: needed.lo - ROOM * width, hi: needed.hi + ROOM * width },
        _ => needed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stream::{Table, Values};

    /// The value a packed number stands for, as the page computes it.
    fn unpacked(column: &[u8], i: usize, range: Range) -> f64 {
        let q = f64::from(u16::from_le_bytes([column[2 * i], column[2 * i + 1]]));
        range.lo + q / 65_535.0 * (range.hi - range.lo)
    }

    fn spheres(n: usize, scale: f64) -> Table {
        let wave = |i: usize, f: f64| scale * (i as f64 * f).sin();
        let axis = |f: f64| Values::F64((0..n).map(|i| wave(i, f)).collect());
        let mut table = Table::default();
        let even = |value: f64| Values::F64(vec![value; n]);
        for (name, values) in [("x", axis(0.7)), ("y", axis(1.3)), ("z", even(2.0)), ("radius", even(0.01))] {
            table.push(name, values).expect("as many rows");
        }
        table
    }

    #[test]
    fn no_position_is_off_by_more_than_the_stated_error() {
        let table = spheres(5000, 3.7);
        let given = Spheres::of(&table, "run").expect("spheres");
        let packed = Packed::new(0.0, &given, None);
        let bound = packed.position_error() * (1.0 + 1e-9);
        assert!(bound < 3.7 * 2.0 * 1.05 / 131_070.0);
        for i in 0..given.len() {
            for k in 0..3 {
                let error =
                    (unpacked(&packed.position, 3 * i + k, packed.extent[k]) - given.centre[k].get(i)).abs();
                assert!(error <= bound, "{i} {k} {error}");
            }
        }
    }

    #[test]
    fn what_does_not_move_is_stored_once() {
        let table = spheres(100, 1.0);
        let given = Spheres::of(&table, "run").expect("spheres");
        let first = Packed::new(0.0, &given, None);
        let second = Packed::new(1.0, &given, Some(&first));
        assert!(Arc::ptr_eq(&first.position, &second.position));
        assert!(first.radius.bytes.is_empty());
    }

    #[test]
    fn whole_numbers_come_back_exactly() {
        for (step, width) in [(0.005, 1), (1.0, 2), (1e5, 4)] {
            let id: Vec<f64> = (0..40_000).map(|i| (f64::from(i) * step).floor() + 17.0).collect();
            assert_eq!(width_of(Range::of(&id)), Some(width));
            let range = whole(Range::of(&id), width);
            let column = Column::new(id.iter().copied(), range, width, None);
            let number = |i: usize| {
                let bytes = &column.bytes[width * i..width * (i + 1)];
                bytes.iter().rev().fold(0.0, |sum, &b| 256.0 * sum + f64::from(b))
            };
            assert!((0..id.len()).all(|i| range.lo + number(i) == id[i]), "{width} bytes");
            assert_eq!(column.error(), 0.0);
        }
    }
}
