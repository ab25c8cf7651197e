//! Contacts of what passes a storage plane, as a table: with whom, with which force, and what they remember.
//!
//! Topic `/crossings/touches`, written before the rows of `/crossings` that it belongs to. A row for each contact that a particle had when it
//! passed: `id` (of a clump: of the member), `partner` (4294967295: a wall), force on it `fn` and `ft` [N]; x y z is where the particle was.
//! What the contact remembers follows, as `id` sees it: the springs of sliding friction [m], rolling and twisting resistance [rad], and what
//! the normal law keeps (`held`, JKR: a_c [m]); 0 where no effect keeps it.
//!
//! In an inlet stream a row says what the contact of two that come in has to remember once `id` is free.

use crate::columns::Columns;
use crate::crossings::Builder;
use crate::error::SceneError;
use dem::effects::{ContactHistory, Field, Kind};
use dem::setup::{Crossing, Memory, Touch};
use stream::{Table, Values};

/// Topic of the contacts.
pub const TOUCHES: &str = "/crossings/touches";
/// Partner of a touch with a wall.
pub const WALL: u32 = u32::MAX;

/// One contact of a passage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touching {
    /// Passage time [s].
    pub time: f64,
    /// Whose contact, with whom, and what it remembers.
    pub memory: Memory,
}

/// The table of a run's crossings.
pub(crate) fn of_crossings(crossings: &[Crossing]) -> Table {
    let rows: Vec<(&Crossing, &Touch)> =
        crossings.iter().flat_map(|c| c.touching.iter().map(move |t| (c, t))).collect();
    let table = Builder::new(rows.len())
        .vectors(["x", "y", "z"], &rows, |r| r.0.particle.position)
        .f64("time", rows.iter().map(|r| r.0.time))
        .with("id", Values::U32(rows.iter().map(|r| r.1.id).collect()))
        .with("partner", Values::U32(rows.iter().map(|r| r.1.partner.unwrap_or(WALL)).collect()))
        .vectors(["fnx", "fny", "fnz"], &rows, |r| r.1.normal)
        .vectors(["ftx", "fty", "ftz"], &rows, |r| r.1.tangential);
    springs(table, &rows, |r| r.1.springs)
}

/// The table of an inlet stream.
pub fn to_table(rows: &[Touching]) -> Table {
    let table = Builder::new(rows.len())
        .vectors(["x", "y", "z"], rows, |_| geom::Vec3::zeros())
        .f64("time", rows.iter().map(|r| r.time))
        .with("id", Values::U32(rows.iter().map(|r| r.memory.id).collect()))
        .with("partner", Values::U32(rows.iter().map(|r| r.memory.partner).collect()));
    springs(table, rows, |r| r.memory.springs)
}

fn springs<T>(table: Builder, rows: &[T], of: impl Fn(&T) -> ContactHistory) -> Table {
    let column = |at: usize| rows.iter().map(|r| of(r).numbers()[at]).collect::<Vec<_>>();
    names()
        .into_iter()
        .enumerate()
        .fold(table, |table, (at, name)| table.f64(&name, column(at).into_iter()))
        .0
}

/// Columns of what a contact keeps.
fn names() -> Vec<String> {
    let of = |(field, _): (&Field, _)| match field.kind {
        Kind::Scalar => vec![field.name.to_owned()],
        Kind::Vector => ["x", "y", "z"].map(|axis| format!("{}{axis}", field.name)).to_vec(),
    };
    ContactHistory::fields().into_iter().flat_map(of).collect()
}

/// Contacts between particles that remember something. Of a table that older versions wrote, without memory, none.
///
/// # Errors
/// Columns that are missing or wrong.
pub fn from_table(stream: &str, table: &Table) -> Result<Vec<Touching>, SceneError> {
    let columns = Columns { name: stream, table };
    if table.get("held").is_none() {
        return Ok(Vec::new());
    }
    let times = columns.numbers("time")?;
    let need = |column: &str| {
        let found = columns.indices(column, f64::from(u32::MAX))?;
        found.ok_or_else(|| {
            SceneError::file(stream, format!("the column '{column}' is missing"), "run stage-replay again")
        })
    };
    let (ids, partners) = (need("id")?, need("partner")?);
    let kept = names().iter().map(|name| columns.numbers(name)).collect::<Result<Vec<_>, _>>()?;
    let row = |k: usize| {
        let mut springs = ContactHistory::default();
        springs.numbers_mut().iter_mut().zip(&kept).for_each(|(number, column)| *number = column[k]);
        Touching { time: times[k], memory: Memory { id: ids[k], partner: partners[k], springs } }
    };
    Ok((0..times.len())
        .map(row)
        .filter(|t| t.memory.partner != WALL && !t.memory.springs.is_zero())
        .collect())
}
