//! Rows of the topic `/crossings`: what crosses a storage plane, and what enters through an inlet.
//!
//! A rigid clump is one row: id of its first member, centre of mass, radius of the sphere that holds it; `clump` is the index of its shape
//! in the record `clumps`, 65535 for a sphere; `scale`, the quaternion that turns the frame its shape was given in, and its `mass` follow.
//! Tables in which all are spheres have none of these columns; where spheres may be bonded ([`super::bond`]), the quaternion alone says
//! how each has turned. `cluster` is there where some have one.

use dem::setup::{Crossing, EntryClump, Particle};
use nalgebra::{Quaternion, UnitQuaternion};
use record::column::{
    CLUMP, CLUSTER, CONTACTS, ID, MASS, MATERIAL, ORIENTATION, ORIENTATION_REAL, OUTLET, POSITION, RADIUS,
    SCALE, SPIN, TIME, VELOCITY,
};
use record::{Columns, RecordError, TableBuilder};
use stream::Table;

/// `clump` of a sphere.
const SPHERE: u16 = u16::MAX;

/// One row: when, through which outlet, what.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossingRow {
    /// Time of the crossing [s].
    pub time: f64,
    /// Index of the outlet.
    pub outlet: u16,
    /// State at that time.
    pub particle: Particle,
    pub contacts: u16,
    /// Of a rigid clump: its shape, and its mass [kg].
    pub clump: Option<(EntryClump, f64)>,
    /// How a sphere that may be bonded has turned.
    pub turn: Option<UnitQuaternion<f64>>,
    /// Its cluster; 0: none.
    pub cluster: u32,
}

impl CrossingRow {
    /// Of a crossing in a run whose clumps have these masses at scale 1 [kg].
    pub fn new(c: &Crossing, masses: &[f64]) -> CrossingRow {
        CrossingRow {
            time: c.time,
            outlet: c.outlet as u16,
            particle: c.particle,
            contacts: c.touching.len() as u16,
            clump: with_mass(c.clump, masses),
            turn: c.turn,
            cluster: c.cluster,
        }
    }

    fn orientation(&self) -> UnitQuaternion<f64> {
        self.clump.map_or(self.turn.unwrap_or_default(), |c| c.0.orientation)
    }
}

/// A clump and its mass [kg], of shapes that have these masses at scale 1 [kg].
pub(super) fn with_mass(clump: Option<EntryClump>, masses: &[f64]) -> Option<(EntryClump, f64)> {
    let mass = |e: &EntryClump| masses.get(e.shape as usize).map_or(f64::NAN, |m| m * e.scale.powi(3));
    clump.map(|e| (e, mass(&e)))
}

/// The table of the topic `/crossings`.
pub fn to_table(rows: &[CrossingRow]) -> Table {
    columns(rows).done()
}

pub(super) fn columns(rows: &[CrossingRow]) -> TableBuilder {
    let table = TableBuilder::new(rows.len())
        .vectors(POSITION, rows, |r| r.particle.position)
        .numbers(TIME, rows.iter().map(|r| r.time))
        .vectors(VELOCITY, rows, |r| r.particle.velocity)
        .vectors(SPIN, rows, |r| r.particle.spin)
        .numbers(RADIUS, rows.iter().map(|r| r.particle.radius))
        .u32(ID, rows.iter().map(|r| r.particle.id))
        .u16(MATERIAL, rows.iter().map(|r| r.particle.material))
        .u16(OUTLET, rows.iter().map(|r| r.outlet))
        .u16(CONTACTS, rows.iter().map(|r| r.contacts));
    let table = match rows.iter().all(|r| r.cluster == 0) {
        true => table,
        false => table.u32(CLUSTER, rows.iter().map(|r| r.cluster)),
    };
    let turn = |r: &CrossingRow| {
        let q = r.orientation();
        [q.w, q.i, q.j, q.k]
    };
    if rows.iter().all(|r| r.clump.is_none()) {
        return if rows.iter().all(|r| r.turn.is_none()) { table } else { table.orientations(rows, turn) };
    }
    table
        .u16(CLUMP, rows.iter().map(|r| r.clump.map_or(SPHERE, |c| c.0.shape as u16)))
        .numbers(SCALE, rows.iter().map(|r| r.clump.map_or(1.0, |c| c.0.scale)))
        .orientations(rows, turn)
        .numbers(MASS, rows.iter().map(|r| r.clump.map_or(0.0, |c| c.1)))
}

/// Adds shapes and orientations to the rows of a table, where it has them.
fn add_turns(columns: &Columns, rows: &mut [CrossingRow]) -> Result<(), RecordError> {
    if columns.table.get(ORIENTATION_REAL).is_none() {
        return Ok(());
    }
    let (real, vector) = (columns.numbers(ORIENTATION_REAL)?, columns.vectors(ORIENTATION)?);
    let wrong = |k: usize, why: String| {
        Err(RecordError::new(columns.name, format!("row {k}: {why}"), "run stage-replay again"))
    };
    for (k, row) in rows.iter_mut().enumerate() {
        let q = Quaternion::new(real[k], vector[k].x, vector[k].y, vector[k].z);
        if !((q.norm() - 1.0).abs() < 1e-9) {
            return wrong(k, format!("a quaternion of length {}", q.norm()));
        }
        // As it was written: to normalize it again would change its last digits.
        row.turn = Some(UnitQuaternion::new_unchecked(q));
    }
    let Some(shapes) = columns.indices(CLUMP, f64::from(SPHERE))? else { return Ok(()) };
    let (scales, masses) = (columns.numbers(SCALE)?, columns.numbers(MASS)?);
    for (k, row) in rows.iter_mut().enumerate().filter(|(k, _)| shapes[*k] != u32::from(SPHERE)) {
        let (shape, scale, mass) = (shapes[k], scales[k], masses[k]);
        if !(scale > 0.0 && mass > 0.0) {
            return wrong(k, format!("a clump of scale {scale} and mass {mass} kg"));
        }
        let orientation = row.turn.take().unwrap_or_default();
        row.clump = Some((EntryClump { shape, scale, orientation }, mass));
    }
    Ok(())
}

/// The rows of a table.
///
/// # Errors
/// Columns that are missing or wrong; `materials` is the number of materials that the stream names.
pub fn from_table(stream: &str, table: &Table, materials: usize) -> Result<Vec<CrossingRow>, RecordError> {
    let columns = Columns { name: stream, table };
    let positions = columns.vectors(POSITION)?;
    let times = columns.numbers(TIME)?;
    let velocities = columns.vectors(VELOCITY)?;
    let spins = columns.vectors_or_zero(SPIN)?;
    let radii = columns.radii()?;
    let ids = columns.needed(ID, f64::from(u32::MAX - 1))?;
    let material = columns.needed(MATERIAL, materials as f64 - 1.0)?;
    let outlets = columns.indices(OUTLET, f64::from(u16::MAX))?;
    let clusters = columns.indices(CLUSTER, f64::from(u32::MAX))?;
    let contacts = columns.indices(CONTACTS, f64::from(u16::MAX))?;
    let row = |i: usize| CrossingRow {
        time: times[i],
        outlet: outlets.as_ref().map_or(0, |o| o[i] as u16),
        particle: Particle {
            id: ids[i],
            material: material[i] as u16,
            radius: radii[i],
            position: positions[i],
            velocity: velocities[i],
            spin: spins[i],
        },
        contacts: contacts.as_ref().map_or(0, |c| c[i] as u16),
        clump: None,
        turn: None,
        cluster: clusters.as_ref().map_or(0, |c| c[i]),
    };
    let mut rows: Vec<CrossingRow> = (0..times.len()).map(row).collect();
    add_turns(&columns, &mut rows)?;
    Ok(rows)
}
