//! Rows of the topic `/crossings/bonds`: bonds of particles that cross, with all that makes the beam.
//!
//! They are written before the rows of `/crossings` that they belong to. A row for each bond that was whole when a particle crossed: `id`,
//! `partner`, the direction from `partner` to `id` when they were bonded (`axisx`…), `length` and `radius` of the beam [m], the springs
//! `stretching` [N/m], `bending` and `torsion` [N·m/rad], `lag` (dashpots over springs [s]), `tensile_strength` and `shear_strength` [Pa]
//! (infinite: it never breaks); x y z is the position of the particle. How particles have turned since they were bonded is in their own
//! rows. The record `bonds` holds what all of them ask of a time step.
//!
//! In an inlet stream a row says that two particles that come in are bonded.

use dem::setup::{Crossing, CrossingBond};
use geom::Vec3;
use record::column::{ID, PARTNER, POSITION, RADIUS, TIME, Vector};
use record::{Columns, RecordError, TableBuilder, topic};
use stream::Table;

const AXIS: Vector = ["axisx", "axisy", "axisz"];
const LENGTH: &str = "length";
const SPRINGS: Vector = ["stretching", "bending", "torsion"];
const LAG: &str = "lag";
const TENSILE: &str = "tensile_strength";
const SHEAR: &str = "shear_strength";
const CURE: &str = "run stage-replay again";

/// One bond of a crossing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondRow {
    /// Time of the crossing [s].
    pub time: f64,
    /// Position of the particle [m].
    pub place: Vec3,
    /// The bond.
    pub bond: CrossingBond,
}

/// The bonds of a run's crossings.
pub fn of_crossings(crossings: &[Crossing]) -> Vec<BondRow> {
    let of = |c: &Crossing| {
        let (time, place) = (c.time, c.particle.position);
        c.bonds.clone().into_iter().map(move |bond| BondRow { time, place, bond })
    };
    crossings.iter().flat_map(of).collect()
}

/// The table of the topic.
pub fn to_table(rows: &[BondRow]) -> Table {
    let number = |of: fn(&CrossingBond) -> f64| rows.iter().map(move |r| of(&r.bond));
    TableBuilder::new(rows.len())
        .vectors(POSITION, rows, |r| r.place)
        .numbers(TIME, rows.iter().map(|r| r.time))
        .u32(ID, rows.iter().map(|r| r.bond.id))
        .u32(PARTNER, rows.iter().map(|r| r.bond.partner))
        .vectors(AXIS, rows, |r| r.bond.axis)
        .numbers(LENGTH, number(|b| b.size[0]))
        .numbers(RADIUS, number(|b| b.size[1]))
        .vectors(SPRINGS, rows, |r| r.bond.stiffness.into())
        .numbers(LAG, number(|b| b.lag))
        .numbers(TENSILE, number(|b| b.strength[0]))
        .numbers(SHEAR, number(|b| b.strength[1]))
        .done()
}

/// The bonds of a table.
///
/// # Errors
/// Columns that are missing or wrong.
pub fn from_table(stream: &str, table: &Table) -> Result<Vec<BondRow>, RecordError> {
    let columns = Columns { name: stream, table };
    let most = f64::from(u32::MAX - 1);
    let (ids, partners) = (columns.needed(ID, most)?, columns.needed(PARTNER, most)?);
    let (times, places) = (columns.numbers(TIME)?, columns.vectors(POSITION)?);
    let axes = columns.vectors(AXIS)?;
    let (length, radius, lag) = (columns.numbers(LENGTH)?, columns.numbers(RADIUS)?, columns.numbers(LAG)?);
    let springs = columns.vectors(SPRINGS)?;
    let (tensile, shear) = (strengths(&columns, TENSILE)?, strengths(&columns, SHEAR)?);
    let row = |k: usize| {
        let bond = CrossingBond {
            id: ids[k],
            partner: partners[k],
            axis: axes[k],
            size: [length[k], radius[k]],
            stiffness: springs[k].into(),
            lag: lag[k],
            strength: [tensile[k], shear[k]],
        };
        match unsound(k, &bond) {
            None => Ok(BondRow { time: times[k], place: places[k], bond }),
            Some(why) => Err(RecordError::new(stream, why, CURE)),
        }
    };
    (0..ids.len()).map(row).collect()
}

/// A column of strengths [Pa]; infinite ones never break.
fn strengths(columns: &Columns, column: &str) -> Result<Vec<f64>, RecordError> {
    let found = columns.optional(column).filter(|all| all.iter().all(|s| *s > 0.0));
    let why = || format!("the column '{column}' is missing, or has a strength that is not above 0");
    found.ok_or_else(|| RecordError::new(columns.name, why(), CURE))
}

/// What is wrong with the bond of a row.
fn unsound(row: usize, bond: &CrossingBond) -> Option<String> {
    let CrossingBond { id, partner, axis, size, stiffness, lag, .. } = bond;
    let (topic, norm) = (topic::CROSSING_BONDS, axis.norm());
    let positive = size.iter().chain(stiffness).all(|x| *x > 0.0);
    let sound = (norm - 1.0).abs() < 1e-9 && positive && *lag >= 0.0 && id != partner;
    (!sound).then(|| format!(
        "row {row} of {topic}: a bond of {id} and {partner} with an axis of length {norm}, length and radius {size:?} m, springs {stiffness:?}, lag {lag} s"
    ))
}
