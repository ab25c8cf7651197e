//! Rows of the topic `/crossings/bonds`: bonds of particles that cross, with all that makes them.
//!
//! They are written before the rows of `/crossings` that they belong to. A row for each bond that was whole when a particle crossed: `id`,
//! `partner`, the direction from `partner` to `id` when they were bonded (`axisx`…), the turn between both then (a quaternion), `length` and `radius` [m], `share`
//! (distance of the section from `id` over the length), the springs `stretching` and `shearing` [N/m], `bending` and `torsion` [N·m/rad], `lag` (dashpots over
//! springs [s]), `moments` (their share in the stress), `at_ends` (1: moments count at the centres), `tensile_strength` and `shear_strength` [Pa]
//! (infinite: it never breaks), `friction` (tan φ), `replaces_contact` (1: the two are not in contact besides); x y z is the position of the particle. How
//! particles have turned is in their own rows. The record `bonds` holds what all of them ask of a time step.
//!
//! In an inlet stream a row says that two particles that come in are bonded.

use dem::setup::{BondNumbers, Crossing, CrossingBond};
use geom::Vec3;
use nalgebra::{Quaternion, UnitQuaternion};
use record::column::{
    ID, ORIENTATION, ORIENTATION_REAL, PARTNER, POSITION, RADIUS, SHEAR_STRENGTH, TENSILE_STRENGTH, TIME,
    Vector,
};
use record::{Columns, RecordError, TableBuilder, topic};
use stream::Table;

const AXIS: Vector = ["axisx", "axisy", "axisz"];
const LENGTH: &str = "length";
const SHARE: &str = "share";
const SPRINGS: [&str; 4] = ["stretching", "shearing", "bending", "torsion"];
const LAG: &str = "lag";
const MOMENTS: &str = "moments";
const AT_ENDS: &str = "at_ends";
const FRICTION: &str = "friction";
const REPLACES: &str = "replaces_contact";
const CURE: &str = "run stage-replay again";

/// One bond of a crossing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondRow {
    /// Time of the crossing [s].
    pub time: f64,
    /// Position of the particle [m].
    pub place: Vec3,
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
    let number = |of: fn(&BondNumbers) -> f64| rows.iter().map(move |r| of(&r.bond.bond));
    let spring = |k: usize| rows.iter().map(move |r| r.bond.bond.stiffness[k]);
    let turn = |r: &BondRow| {
        let q = r.bond.bond.reference;
        [q.w, q.i, q.j, q.k]
    };
    let table = TableBuilder::new(rows.len())
        .vectors(POSITION, rows, |r| r.place)
        .numbers(TIME, rows.iter().map(|r| r.time))
        .u32(ID, rows.iter().map(|r| r.bond.id))
        .u32(PARTNER, rows.iter().map(|r| r.bond.partner))
        .vectors(AXIS, rows, |r| r.bond.bond.axis)
        .orientations(rows, turn)
        .numbers(LENGTH, number(|b| b.size[0]))
        .numbers(RADIUS, number(|b| b.size[1]))
        .numbers(SHARE, number(|b| b.share));
    let table = (0..).zip(SPRINGS).fold(table, |table, (k, name)| table.numbers(name, spring(k)));
    table
        .numbers(LAG, number(|b| b.lag))
        .numbers(MOMENTS, number(|b| b.moments))
        .numbers(AT_ENDS, number(|b| f64::from(u8::from(b.at_ends))))
        .numbers(TENSILE_STRENGTH, number(|b| b.strength[0]))
        .numbers(SHEAR_STRENGTH, number(|b| b.strength[1]))
        .numbers(FRICTION, number(|b| b.strength[2]))
        .numbers(REPLACES, number(|b| f64::from(u8::from(b.replaces_contact))))
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
    let (axes, real, vector) =
        (columns.vectors(AXIS)?, columns.numbers(ORIENTATION_REAL)?, columns.vectors(ORIENTATION)?);
    let (length, radius, share) =
        (columns.numbers(LENGTH)?, columns.numbers(RADIUS)?, columns.numbers(SHARE)?);
    let springs = SPRINGS.iter().map(|name| columns.numbers(name)).collect::<Result<Vec<_>, _>>()?;
    let (lag, moments, friction) =
        (columns.numbers(LAG)?, columns.numbers(MOMENTS)?, columns.numbers(FRICTION)?);
    let (at_ends, replaces) = (columns.needed(AT_ENDS, 1.0)?, columns.needed(REPLACES, 1.0)?);
    let (tensile, shear) = (strengths(&columns, TENSILE_STRENGTH)?, strengths(&columns, SHEAR_STRENGTH)?);
    let row = |k: usize| {
        let numbers = BondNumbers {
            axis: axes[k],
            // As it was written: to normalize it again would change its last digits.
            reference: UnitQuaternion::new_unchecked(Quaternion::new(
                real[k],
                vector[k].x,
                vector[k].y,
                vector[k].z,
            )),
            size: [length[k], radius[k]],
            share: share[k],
            stiffness: [0, 1, 2, 3].map(|spring| springs[spring][k]),
            lag: lag[k],
            moments: moments[k],
            at_ends: at_ends[k] == 1,
            strength: [tensile[k], shear[k], friction[k]],
            replaces_contact: replaces[k] == 1,
        };
        let bond = CrossingBond { id: ids[k], partner: partners[k], bond: numbers };
        match unsound(k, &bond) {
            None => Ok(BondRow { time: times[k], place: places[k], bond }),
            Some(why) => Err(RecordError::new(stream, why, CURE)),
        }
    };
    (0..ids.len()).map(row).collect()
}

/// A column of strengths [Pa]; infinite ones never break.
fn strengths(columns: &Columns, column: &str) -> Result<Vec<f64>, RecordError> {
    let found = columns.optional(column).filter(|all| all.iter().all(|s| *s >= 0.0));
    let why = || format!("the column '{column}' is missing, or has a strength below 0");
    found.ok_or_else(|| RecordError::new(columns.name, why(), CURE))
}

/// What is wrong with the bond of a row.
fn unsound(row: usize, bond: &CrossingBond) -> Option<String> {
    let CrossingBond { id, partner, bond } = bond;
    let (topic, norms) = (topic::CROSSING_BONDS, [bond.axis.norm(), bond.reference.norm()]);
    let [along, others @ ..] = bond.stiffness;
    let positive = bond.size.iter().chain([&along]).all(|x| *x > 0.0) && others.iter().all(|x| *x >= 0.0);
    let shares = [bond.share, bond.moments].iter().all(|x| (0.0..=1.0).contains(x));
    let sound = norms.iter().all(|n| (n - 1.0).abs() < 1e-9)
        && positive
        && shares
        && bond.lag >= 0.0
        && bond.strength[2] >= 0.0
        && id != partner;
    (!sound).then(|| format!("row {row} of {topic}: a bond of {id} and {partner} that cannot be: {bond:?}"))
}
