//! Contact histories in tables: columns named as the effects name their fields, and the topic `/history`.
//!
//! A row of `/history` is a contact at the last frame of a run: `id`, `partner` (another id) or `wall` (index in `/surfaces`) with its
//! `element`, and the history as `id` sees it. 4294967295 stands for none.

use dem::effects::{ContactHistory, Field, Kind};
use dem::setup::{KeptContact, KeptPartner};
use geom::Vec3;
use record::column::{ID, PARTNER, POSITION};
use record::{Columns, RecordError, TableBuilder};
use stream::Table;

const WALL: &str = "wall";
const ELEMENT: &str = "element";
/// No particle, or no wall.
const NONE: u32 = u32::MAX;

/// Columns of the history, as the effects name its fields.
fn names() -> Vec<String> {
    let of = |(field, _): (&Field, _)| match field.kind {
        Kind::Scalar => vec![field.name.to_owned()],
        Kind::Vector => ["x", "y", "z"].map(|axis| format!("{}{axis}", field.name)).to_vec(),
    };
    ContactHistory::fields().into_iter().flat_map(of).collect()
}

/// A table with the columns of histories added, whole.
pub fn with_histories<T>(table: TableBuilder, rows: &[T], of: fn(&T) -> ContactHistory) -> Table {
    let number = |at: usize| rows.iter().map(move |r| of(r).numbers()[at]);
    names().iter().zip(0..).fold(table, |table, (name, at)| table.numbers(name, number(at))).done()
}

/// The histories of a table, row by row.
///
/// # Errors
/// A column that is missing or wrong.
pub fn histories(columns: &Columns) -> Result<Vec<ContactHistory>, RecordError> {
    let numbers = names().iter().map(|name| columns.numbers(name)).collect::<Result<Vec<_>, _>>()?;
    let row = |k: usize| {
        let mut history = ContactHistory::default();
        history.numbers_mut().iter_mut().zip(&numbers).for_each(|(number, column)| *number = column[k]);
        history
    };
    Ok((0..columns.table.rows()).map(row).collect())
}

/// The table of `/history`.
pub fn to_table(rows: &[KeptContact]) -> Table {
    let partner = |r: &KeptContact| match r.partner {
        KeptPartner::Particle(id) => [id, NONE, NONE],
        KeptPartner::Wall { wall, element } => [NONE, wall, element],
    };
    let column = |at: usize| rows.iter().map(move |r| partner(r)[at]);
    let table = TableBuilder::new(rows.len())
        .vectors(POSITION, rows, |_| Vec3::zeros())
        .u32(ID, rows.iter().map(|r| r.id))
        .u32(PARTNER, column(0))
        .u32(WALL, column(1))
        .u32(ELEMENT, column(2));
    with_histories(table, rows, |r| r.history)
}

/// The rows of `/history`.
///
/// # Errors
/// A column that is missing or wrong.
pub fn from_table(name: &str, table: &Table) -> Result<Vec<KeptContact>, RecordError> {
    let (columns, any) = (Columns { name, table }, f64::from(u32::MAX));
    let (ids, partners) = (columns.needed(ID, any)?, columns.needed(PARTNER, any)?);
    let (walls, elements) = (columns.needed(WALL, any)?, columns.needed(ELEMENT, any)?);
    let row = |(k, history): (usize, ContactHistory)| {
        let partner = match walls[k] {
            NONE => KeptPartner::Particle(partners[k]),
            wall => KeptPartner::Wall { wall, element: elements[k] },
        };
        KeptContact { id: ids[k], partner, history }
    };
    Ok(histories(&columns)?.into_iter().enumerate().map(row).collect())
}
