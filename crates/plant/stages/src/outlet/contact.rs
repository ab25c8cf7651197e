//! Rows of the topic `/crossings/touches`: contacts of particles that cross, with forces and history.
//!
//! They are written before the rows of `/crossings` that they belong to. A row for each contact that a particle had when it crossed: `id`
//! (of a clump: of the member), `partner` (4294967295: a wall), force on it `fn` and `ft` [N]; x y z is the position of the particle. The
//! contact history follows, as `id` sees it: the springs of sliding friction [m], rolling and twisting resistance [rad], and the number
//! that the normal law keeps (`held`, JKR: a_c [m]); 0 where no effect keeps it.
//!
//! In an inlet stream a row is the history that the contact of two particles gets once `id` is free.

use dem::effects::ContactHistory;
use dem::setup::{Crossing, PairHistory, Touch};
use geom::Vec3;
use record::column::{ID, PARTNER, POSITION, TIME, Vector};
use record::{Columns, RecordError, TableBuilder};
use scene::input::history::{histories, with_histories};
use stream::Table;

/// Partner of a contact with a wall.
pub const WALL: u32 = u32::MAX;

const NORMAL_FORCE: Vector = ["fnx", "fny", "fnz"];
const TANGENTIAL_FORCE: Vector = ["ftx", "fty", "ftz"];
/// Tables of older versions, without history, lack this column.
const NORMAL: &str = "held";

/// History of one contact of a crossing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactRow {
    /// Time of the crossing [s].
    pub time: f64,
    /// The two particles, and the history of their contact.
    pub pair: PairHistory,
}

/// The table of a run's crossings.
pub fn of_crossings(crossings: &[Crossing]) -> Table {
    let rows: Vec<(&Crossing, &Touch)> =
        crossings.iter().flat_map(|c| c.touching.iter().map(move |t| (c, t))).collect();
    let table = TableBuilder::new(rows.len())
        .vectors(POSITION, &rows, |r| r.0.particle.position)
        .numbers(TIME, rows.iter().map(|r| r.0.time))
        .u32(ID, rows.iter().map(|r| r.1.id))
        .u32(PARTNER, rows.iter().map(|r| r.1.partner.unwrap_or(WALL)))
        .vectors(NORMAL_FORCE, &rows, |r| r.1.normal)
        .vectors(TANGENTIAL_FORCE, &rows, |r| r.1.tangential);
    with_histories(table, &rows, |r| r.1.history)
}

/// The table of an inlet stream.
pub fn to_table(rows: &[ContactRow]) -> Table {
    let table = TableBuilder::new(rows.len())
        .vectors(POSITION, rows, |_| Vec3::zeros())
        .numbers(TIME, rows.iter().map(|r| r.time))
        .u32(ID, rows.iter().map(|r| r.pair.id))
        .u32(PARTNER, rows.iter().map(|r| r.pair.partner));
    with_histories(table, rows, |r| r.pair.history)
}

/// Contacts between particles that have a history. A table of older versions, without history, has none.
///
/// # Errors
/// Columns that are missing or wrong.
pub fn from_table(stream: &str, table: &Table) -> Result<Vec<ContactRow>, RecordError> {
    let columns = Columns { name: stream, table };
    if table.get(NORMAL).is_none() {
        return Ok(Vec::new());
    }
    let times = columns.numbers(TIME)?;
    let any = f64::from(u32::MAX);
    let (ids, partners) = (columns.needed(ID, any)?, columns.needed(PARTNER, any)?);
    let row = |(k, history): (usize, ContactHistory)| ContactRow {
        time: times[k],
        pair: PairHistory { id: ids[k], partner: partners[k], history },
    };
    let kept = |r: &ContactRow| r.pair.partner != WALL && !r.pair.history.is_zero();
    Ok(histories(&columns)?.into_iter().enumerate().map(row).filter(kept).collect())
}
