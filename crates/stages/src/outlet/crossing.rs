//! Crossings as tables: what passes a storage plane, and what enters through an inlet.
//!
//! Topic `/crossings` holds particles in the order of their passage times; `/crossings/watermark` says "nothing
//! more before t"; `/crossings/touches` ([`crate::touches`]) has one row for each contact a particle had when it passed.
//!
//! A rigid clump is one row: id of its first member, centre of mass, radius of the sphere that holds it; `clump` is its shape's index in the
//! record `clumps`, 65535 for a sphere; `scale`, the quaternion that turns the frame its shape was given in, and its `mass` follow. Tables in
//! which all are spheres have none of these columns; where spheres may be bonded ([`crate::links`]), the quaternion alone says how each has turned.

use crate::columns::Columns;
use crate::error::SceneError;
use dem::setup::{Crossing, EntryClump, Particle};
use nalgebra::{Quaternion, UnitQuaternion};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use stream::{Table, Values, mcap::Event};

/// Topic of the particles.
pub const CROSSINGS: &str = "/crossings";
/// Topic of the promises.
pub const WATERMARK: &str = "/crossings/watermark";
/// `clump` of a sphere.
pub const SPHERE: u16 = u16::MAX;

/// Nothing more comes before this time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Watermark {
    /// Time [s].
    pub until: f64,
}

impl Watermark {
    /// The message.
    pub fn to_json(self) -> Vec<u8> {
        // One number always is JSON.
        serde_json::to_vec(&self).unwrap_or_default()
    }

    /// The promise in an event of the topic.
    ///
    /// # Errors
    /// Something else than the JSON that is wanted.
    pub fn read(stream: &str, data: &[u8]) -> Result<Watermark, SceneError> {
        serde_json::from_slice(data).map_err(|e| {
            SceneError::file(stream, format!("{WATERMARK}: {e}"), "wanted: {\"until\": seconds}")
        })
    }
}

/// One row: when, through which outlet, what.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// Passage time [s].
    pub time: f64,
    /// Index of the outlet.
    pub outlet: u16,
    /// State at that time.
    pub particle: Particle,
    /// Number of contacts.
    pub contacts: u16,
    /// What makes it a rigid clump, and its mass [kg].
    pub clump: Option<(EntryClump, f64)>,
    /// How a sphere has turned that may be bonded.
    pub turn: Option<UnitQuaternion<f64>>,
}

impl Passage {
    /// Of a crossing in a run whose clumps have these masses at scale 1 [kg].
    pub fn new(c: &Crossing, masses: &[f64]) -> Passage {
        Passage {
            time: c.time,
            outlet: c.outlet as u16,
            particle: c.particle,
            contacts: c.touching.len() as u16,
            clump: with_mass(c.clump, masses),
            turn: c.turn,
        }
    }
}

/// A clump and its mass [kg], of shapes that have these masses at scale 1 [kg].
pub(crate) fn with_mass(clump: Option<EntryClump>, masses: &[f64]) -> Option<(EntryClump, f64)> {
    let mass = |e: &EntryClump| masses.get(e.shape as usize).map_or(f64::NAN, |m| m * e.scale.powi(3));
    clump.map(|e| (e, mass(&e)))
}

/// Builds a table column by column; names are given once, so that no two are equal.
pub(crate) struct Builder(pub Table);

impl Builder {
    pub(crate) fn new(rows: usize) -> Builder {
        Builder(Table::with_rows(rows))
    }

    pub(crate) fn with(mut self, name: &str, values: Values) -> Builder {
        // Lengths are equal and names are different by construction.
        let _ = self.0.push(name, values);
        self
    }

    pub(crate) fn f64(self, name: &str, values: impl Iterator<Item = f64>) -> Builder {
        self.with(name, Values::F64(values.collect()))
    }

    pub(crate) fn vectors<T>(self, names: [&str; 3], rows: &[T], of: impl Fn(&T) -> geom::Vec3) -> Builder {
        let mut table = self;
        for (axis, name) in names.iter().enumerate() {
            table = table.f64(name, rows.iter().map(|r| of(r)[axis]));
        }
        table
    }
}

/// The table of the topic `/crossings`.
pub fn to_table(rows: &[Passage]) -> Table {
    let table = Builder::new(rows.len())
        .vectors(["x", "y", "z"], rows, |r| r.particle.position)
        .f64("time", rows.iter().map(|r| r.time))
        .vectors(["vx", "vy", "vz"], rows, |r| r.particle.velocity)
        .vectors(["wx", "wy", "wz"], rows, |r| r.particle.spin)
        .f64("radius", rows.iter().map(|r| r.particle.radius))
        .with("id", Values::U32(rows.iter().map(|r| r.particle.id).collect()))
        .with("material", Values::U16(rows.iter().map(|r| r.particle.material).collect()))
        .with("outlet", Values::U16(rows.iter().map(|r| r.outlet).collect()))
        .with("contacts", Values::U16(rows.iter().map(|r| r.contacts).collect()));
    let turned = |table: Builder| {
        let of = |pick: fn(&UnitQuaternion<f64>) -> f64| {
            rows.iter().map(move |r| pick(&r.clump.map_or(r.turn.unwrap_or_default(), |c| c.0.orientation)))
        };
        table.f64("qw", of(|q| q.w)).f64("qx", of(|q| q.i)).f64("qy", of(|q| q.j)).f64("qz", of(|q| q.k))
    };
    if rows.iter().all(|r| r.clump.is_none()) {
        return if rows.iter().all(|r| r.turn.is_none()) { table.0 } else { turned(table).0 };
    }
    let shape = |r: &Passage| r.clump.map_or(SPHERE, |c| c.0.shape as u16);
    let table = table
        .with("clump", Values::U16(rows.iter().map(shape).collect()))
        .f64("scale", rows.iter().map(|r| r.clump.map_or(1.0, |c| c.0.scale)));
    turned(table).f64("mass", rows.iter().map(|r| r.clump.map_or(0.0, |c| c.1))).0
}

/// What makes a row a clump, and its mass [kg]; how a sphere has turned.
type Turned = (Option<(EntryClump, f64)>, Option<UnitQuaternion<f64>>);

/// The clumps among the rows of a table, and how all have turned where it tells.
fn turned(columns: &Columns) -> Result<Vec<Turned>, SceneError> {
    let rows = columns.table.rows();
    if columns.table.get("qw").is_none() {
        return Ok(vec![(None, None); rows]);
    }
    let (real, vector) = (columns.numbers("qw")?, columns.vectors(["qx", "qy", "qz"])?);
    let wrong = |why: String| Err(SceneError::file(columns.name, why, "run stage-replay again"));
    let mut all = Vec::with_capacity(rows);
    for (row, (w, v)) in real.iter().zip(&vector).enumerate() {
        let q = Quaternion::new(*w, v.x, v.y, v.z);
        if !((q.norm() - 1.0).abs() < 1e-9) {
            return wrong(format!("row {row}: a quaternion of length {}", q.norm()));
        }
        // As it was written: to normalize it again would change its last digits.
        all.push((None, Some(UnitQuaternion::new_unchecked(q))));
    }
    let Some(shapes) = columns.indices("clump", f64::from(SPHERE))? else { return Ok(all) };
    let (scales, masses) = (columns.numbers("scale")?, columns.numbers("mass")?);
    for (row, one) in all.iter_mut().enumerate().filter(|(row, _)| shapes[*row] != u32::from(SPHERE)) {
        let (shape, scale, mass) = (shapes[row], scales[row], masses[row]);
        if !(scale > 0.0 && mass > 0.0) {
            return wrong(format!("row {row}: a clump of scale {scale} and mass {mass} kg"));
        }
        let orientation = one.1.take().unwrap_or_default();
        one.0 = Some((EntryClump { shape, scale, orientation }, mass));
    }
    Ok(all)
}

/// The passages of a table.
///
/// # Errors
/// Columns that are missing or wrong; `materials` is the number of materials that the stream names.
pub fn from_table(stream: &str, table: &Table, materials: usize) -> Result<Vec<Passage>, SceneError> {
    let columns = Columns { name: stream, table };
    let positions = columns.vectors(["x", "y", "z"])?;
    let times = columns.numbers("time")?;
    let velocities = columns.vectors(["vx", "vy", "vz"])?;
    let spins = columns.vectors_or_zero(["wx", "wy", "wz"])?;
    let radii = columns.radii()?;
    let need = |column: &str, most: f64| {
        let found = columns.indices(column, most)?;
        found.ok_or_else(|| {
            SceneError::file(stream, format!("the column '{column}' is missing"), "run stage-replay again")
        })
    };
    let ids = need("id", f64::from(u32::MAX - 1))?;
    let material = need("material", materials as f64 - 1.0)?;
    let outlets = columns.indices("outlet", f64::from(u16::MAX))?;
    let contacts = columns.indices("contacts", f64::from(u16::MAX))?;
    let turned = turned(&columns)?;
    let row = |i: usize| Passage {
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
        clump: turned[i].0,
        turn: turned[i].1,
    };
    Ok((0..times.len()).map(row).collect())
}

/// Radii [m] of all particles that a stream can bring, and their materials: the metadata record `sizes`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sizes {
    /// Smallest radius [m].
    pub smallest: f64,
    /// Largest radius [m].
    pub largest: f64,
}

/// Name of the metadata record.
pub const SIZES: &str = "sizes";
/// Key of it that is there where no spheres are among them, only clumps.
pub(crate) const ONLY_CLUMPS: &str = "only_clumps";

impl Sizes {
    /// The record.
    pub fn to_map(self) -> BTreeMap<String, String> {
        let number = |name: &str, v: f64| (name.to_owned(), v.to_string());
        BTreeMap::from([number("smallest_radius", self.smallest), number("largest_radius", self.largest)])
    }

    /// From the record.
    ///
    /// # Errors
    /// A key that is missing or no positive number.
    pub fn from_map(stream: &str, map: &BTreeMap<String, String>) -> Result<Sizes, SceneError> {
        Ok(Sizes {
            smallest: number(stream, SIZES, map, "smallest_radius")?,
            largest: number(stream, SIZES, map, "largest_radius")?,
        })
    }

    /// The range that holds both.
    pub fn union(a: Option<Sizes>, b: Option<Sizes>) -> Option<Sizes> {
        match (a, b) {
            (Some(a), Some(b)) => {
                Some(Sizes { smallest: a.smallest.min(b.smallest), largest: a.largest.max(b.largest) })
            }
            _ => a.or(b),
        }
    }
}

/// A positive number of a metadata record.
pub(crate) fn number(
    stream: &str,
    record: &str,
    map: &BTreeMap<String, String>,
    key: &str,
) -> Result<f64, SceneError> {
    let value = map.get(key).and_then(|t| t.parse::<f64>().ok()).filter(|v| *v > 0.0 && v.is_finite());
    value.ok_or_else(|| {
        let found = map.get(key).map_or("nothing", String::as_str);
        SceneError::file(stream, format!("record '{record}': {key} = {found}"), "wanted: a number above 0")
    })
}

/// Topic of a message.
pub(crate) fn topic(event: &Event) -> Option<&str> {
    match event {
        Event::Metadata { .. } => None,
        Event::Points { topic, .. } | Event::Bytes { topic, .. } => Some(topic),
    }
}
