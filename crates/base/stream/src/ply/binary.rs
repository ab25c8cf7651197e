//! Binary data: rows of one width in bulk, rows with lists one by one.

use super::{
    Element, ListColumn, NumberType, Ply, PlyError,
    header::{ElementHeader, Header, Property},
};
use crate::{
    Table, Values,
    number_type::of_kind,
    rows::{Number, column},
    table::each,
};

/// Reads the data that begin at `at`.
pub(super) fn body<const BIG: bool>(header: Header, bytes: &[u8], mut at: usize) -> Result<Ply, PlyError> {
    let mut ply = Ply { comments: header.comments, obj_info: header.obj_info, elements: Vec::new() };
    for element in &header.elements {
        ply.elements.push(match element.stride() {
            Some(stride) => bulk::<BIG>(element, stride, bytes, &mut at)?,
            None => Rows::new(element, bytes, at).read::<BIG>(&mut at)?,
        });
    }
    match &bytes[at..] {
        rest if is_line_end(rest) => Ok(ply),
        rest => Err(PlyError::Trailing { extra: rest.len() as u64, byte: at as u64 }),
    }
}

/// Whether nothing stands behind the data, or the end of a line that some programs write.
pub(super) fn is_line_end(rest: &[u8]) -> bool {
    matches!(rest, b"" | b"\n" | b"\r\n")
}

/// An element without lists: all rows are `stride` bytes wide.
fn bulk<const BIG: bool>(
    element: &ElementHeader,
    stride: usize,
    bytes: &[u8],
    at: &mut usize,
) -> Result<Element, PlyError> {
    let rest = &bytes[*at..];
    let needed = element.rows.checked_mul(stride as u64).filter(|&needed| needed <= rest.len() as u64);
    let Some(needed) = needed.map(|needed| needed as usize) else {
        return Err(truncated(element, (rest.len() / stride.max(1)) as u64, bytes));
    };
    let mut table = Table::default();
    let mut offset = 0;
    for property in &element.properties {
        let values = if needed == 0 {
            property.kind.empty()
        } else {
            column::<BIG>(&rest[..needed], stride, offset, property.kind)
        };
        push(&mut table, element, property, values)?;
        offset += property.kind.size();
    }
    *at += needed;
    Ok(Element { name: element.name.clone(), table, lists: Vec::new() })
}

fn truncated(element: &ElementHeader, row: u64, bytes: &[u8]) -> PlyError {
    let (element, rows) = (element.name.clone(), element.rows);
    PlyError::Truncated { element, rows, row, byte: bytes.len() as u64 }
}

/// Adds a column to an element's table.
pub(super) fn push(
    table: &mut Table,
    element: &ElementHeader,
    property: &Property,
    values: Values,
) -> Result<(), PlyError> {
    table
        .push(&property.name, values)
        .map_err(|source| PlyError::Table { element: element.name.clone(), source })
}

/// Reads an element with lists.
struct Rows<'a> {
    element: &'a ElementHeader,
    bytes: &'a [u8],
    at: usize,
    columns: Vec<(Values, Vec<usize>)>,
}

impl<'a> Rows<'a> {
    fn new(element: &'a ElementHeader, bytes: &'a [u8], at: usize) -> Rows<'a> {
        let columns = element.properties.iter().map(|p| (p.kind.empty(), Vec::new())).collect();
        Rows { element, bytes, at, columns }
    }

    fn read<const BIG: bool>(mut self, at: &mut usize) -> Result<Element, PlyError> {
        for row in 0..self.element.rows {
            for (place, property) in self.element.properties.iter().enumerate() {
                let count = match property.count {
                    Some(kind) => self.count::<BIG>(row, property, kind)?,
                    None => 1,
                };
                let size = property.kind.size();
                let items = count.checked_mul(size).and_then(|n| self.bytes[self.at..].get(..n));
                let items = items.ok_or_else(|| truncated(self.element, row, self.bytes))?;
                self.at += items.len();
                let (values, ends) = &mut self.columns[place];
                each!(values, v => extend::<_, BIG>(v, items, size));
                if property.count.is_some() {
                    ends.push(values.len());
                }
            }
        }
        *at = self.at;
        finish(self.element, self.columns)
    }

    /// The number of items in the next list.
    fn count<const BIG: bool>(
        &mut self,
        row: u64,
        property: &Property,
        kind: NumberType,
    ) -> Result<usize, PlyError> {
        let bytes = self.bytes[self.at..].get(..kind.size());
        let bytes = bytes.ok_or_else(|| truncated(self.element, row, self.bytes))?;
        #[allow(clippy::unnecessary_cast)]
        let count = of_kind!(kind, T, _V => <T as Number>::get::<BIG>(bytes) as f64);
        if count < 0.0 {
            let (element, property) = (self.element.name.clone(), property.name.clone());
            return Err(PlyError::Count { element, row, byte: self.at as u64, property, count });
        }
        self.at += kind.size();
        Ok(count as usize)
    }
}

fn extend<T: Number, const BIG: bool>(values: &mut Vec<T>, items: &[u8], size: usize) {
    values.extend(items.chunks_exact(size).map(T::get::<BIG>));
}

/// Puts columns together to an element; a list's column comes with the ends of its rows.
pub(super) fn finish(
    element: &ElementHeader,
    columns: Vec<(Values, Vec<usize>)>,
) -> Result<Element, PlyError> {
    let mut table = Table::with_rows(element.rows as usize);
    let mut lists = Vec::new();
    for (property, (values, ends)) in element.properties.iter().zip(columns) {
        match property.count {
            None => push(&mut table, element, property, values)?,
            Some(count_kind) => {
                let (name, position) = (property.name.clone(), table.columns().len());
                lists.push(ListColumn { name, position, count_kind, ends, values });
            }
        }
    }
    Ok(Element { name: element.name.clone(), table, lists })
}
