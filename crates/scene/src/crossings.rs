//! Crossings as tables: what passes a storage plane, and what enters through an inlet.
//!
//! Topic `/crossings` holds particles in the order of their passage times; `/crossings/watermark` says "nothing
//! more before t"; `/crossings/touches` has one row for each contact a particle had when it passed.

use crate::columns::Columns;
use crate::error::SceneError;
use dem::setup::{Crossing, Particle};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use stream::{Table, Values, mcap::Event};

/// Topic of the particles.
pub const CROSSINGS: &str = "/crossings";
/// Topic of the promises.
pub const WATERMARK: &str = "/crossings/watermark";
/// Topic of the contacts.
pub const TOUCHES: &str = "/crossings/touches";
/// Partner of a touch with a wall.
pub const WALL: u32 = u32::MAX;

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
}

impl From<&Crossing> for Passage {
    fn from(c: &Crossing) -> Passage {
        Passage {
            time: c.time,
            outlet: c.outlet as u16,
            particle: c.particle,
            contacts: c.touching.len() as u16,
        }
    }
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
    Builder::new(rows.len())
        .vectors(["x", "y", "z"], rows, |r| r.particle.position)
        .f64("time", rows.iter().map(|r| r.time))
        .vectors(["vx", "vy", "vz"], rows, |r| r.particle.velocity)
        .vectors(["wx", "wy", "wz"], rows, |r| r.particle.spin)
        .f64("radius", rows.iter().map(|r| r.particle.radius))
        .with("id", Values::U32(rows.iter().map(|r| r.particle.id).collect()))
        .with("material", Values::U16(rows.iter().map(|r| r.particle.material).collect()))
        .with("outlet", Values::U16(rows.iter().map(|r| r.outlet).collect()))
        .with("contacts", Values::U16(rows.iter().map(|r| r.contacts).collect()))
        .0
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
    };
    Ok((0..times.len()).map(row).collect())
}

/// The table of the topic `/crossings/touches`: a row for each contact; x y z is where the particle was.
pub(crate) fn touches(crossings: &[Crossing]) -> Table {
    let rows: Vec<_> = crossings.iter().flat_map(|c| c.touching.iter().map(move |t| (c, t))).collect();
    Builder::new(rows.len())
        .vectors(["x", "y", "z"], &rows, |r| r.0.particle.position)
        .f64("time", rows.iter().map(|r| r.0.time))
        .with("id", Values::U32(rows.iter().map(|r| r.0.particle.id).collect()))
        .with("partner", Values::U32(rows.iter().map(|r| r.1.partner.unwrap_or(WALL)).collect()))
        .vectors(["fnx", "fny", "fnz"], &rows, |r| r.1.normal)
        .vectors(["ftx", "fty", "ftz"], &rows, |r| r.1.tangential)
        .0
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
