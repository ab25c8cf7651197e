//! Makes a table column by column.

use crate::column::{ORIENTATION, ORIENTATION_REAL};
use geom::Vec3;
use stream::{NumberType, Table, Values};

/// Columns of one table. Names are given once by the caller, and all columns have the same number of rows.
pub struct TableBuilder {
    table: Table,
    kind: NumberType,
}

impl TableBuilder {
    /// A table of so many rows, whose numbers are written in double precision.
    pub fn new(rows: usize) -> TableBuilder {
        TableBuilder::of(rows, NumberType::F64)
    }

    /// A table whose [`TableBuilder::numbers`] and [`TableBuilder::vectors`] are of this type: `F32`, else `F64`.
    pub fn of(rows: usize, kind: NumberType) -> TableBuilder {
        TableBuilder { table: Table::with_rows(rows), kind }
    }

    /// Adds a column.
    pub fn with(mut self, name: &str, values: Values) -> TableBuilder {
        // Lengths are equal and names are different by construction.
        let _ = self.table.push(name, values);
        self
    }

    /// Adds a column of numbers.
    pub fn numbers(self, name: &str, values: impl Iterator<Item = f64>) -> TableBuilder {
        let values = match self.kind {
            NumberType::F32 => Values::F32(values.map(|v| v as f32).collect()),
            _ => Values::F64(values.collect()),
        };
        self.with(name, values)
    }

    /// Adds a column of indices or ids.
    pub fn u32(self, name: &str, values: impl Iterator<Item = u32>) -> TableBuilder {
        self.with(name, Values::U32(values.collect()))
    }

    /// Adds a column of small indices.
    pub fn u16(self, name: &str, values: impl Iterator<Item = u16>) -> TableBuilder {
        self.with(name, Values::U16(values.collect()))
    }

    /// Adds the three columns of a vector.
    pub fn vectors<T>(self, names: [&str; 3], rows: &[T], of: impl Fn(&T) -> Vec3) -> TableBuilder {
        let axes = names.iter().enumerate();
        axes.fold(self, |table, (axis, name)| table.numbers(name, rows.iter().map(|r| of(r)[axis])))
    }

    /// Adds the four columns of an orientation, w x y z.
    pub fn orientations<T>(self, rows: &[T], of: impl Fn(&T) -> [f64; 4]) -> TableBuilder {
        let real = self.numbers(ORIENTATION_REAL, rows.iter().map(|r| of(r)[0]));
        real.vectors(ORIENTATION, rows, |r| {
            let [_, x, y, z] = of(r);
            Vec3::new(x, y, z)
        })
    }

    /// The table.
    pub fn done(self) -> Table {
        self.table
    }
}
