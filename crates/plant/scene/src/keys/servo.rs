//! Walls that follow a force or a stress.

use super::unit::{self, KeyUnit};
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
use std::fmt;

/// A force that a wall follows.
#[derive(Debug, Clone, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Servo {
    /// Which way the wall pushes.
    #[serde(deserialize_with = "unit::plain")]
    pub direction: [f64; 3],
    /// Force on the particles [N]; this, `stress` or `path`.
    #[serde(default, deserialize_with = "unit::newtons")]
    pub force: Option<f64>,
    /// Stress [Pa] on an area; this, `force` or `path`.
    #[serde(default, deserialize_with = "unit::pascals")]
    pub stress: Option<f64>,
    /// A table of force or stress over time; this, `force` or `stress`.
    pub path: Option<ServoPath>,
    /// Area that a stress acts on [m²]; this or `area_between`.
    #[serde(default, deserialize_with = "unit::square_metres")]
    pub area: Option<f64>,
    /// Two sides of the area that a stress acts on; this or `area`.
    pub area_between: Option<[Side; 2]>,
    /// Largest speed [m/s].
    #[serde(deserialize_with = "unit::metres_a_second")]
    pub speed_limit: f64,
}

/// A table of force or stress over time.
#[derive(Debug, Clone, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ServoPath {
    /// CSV with the column t [s], and force [N] or stress [Pa].
    pub source: String,
}

/// A side of an area.
#[derive(Debug, Clone, PartialEq)]
pub enum Side {
    /// Its length [m].
    Length(f64),
    /// The distance of two walls, by name.
    Walls([String; 2]),
}

const LENGTH: KeyUnit = KeyUnit { unit: "m", such: "8 mm" };

impl<'de> Deserialize<'de> for Side {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Side, D::Error> {
        from.deserialize_any(SideVisitor)
    }
}

struct SideVisitor;

impl<'de> Visitor<'de> for SideVisitor {
    type Value = Side;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(
            "the names of two walls, such as [\"left\", \"right\"], or a length [m], such as 0.1 or \"8 mm\"",
        )
    }

    fn visit_f64<E: Error>(self, v: f64) -> Result<Side, E> {
        Ok(Side::Length(v))
    }

    fn visit_i64<E: Error>(self, v: i64) -> Result<Side, E> {
        self.visit_f64(v as f64)
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Side, E> {
        if !unit::begins_as_number(text) {
            return Err(E::invalid_value(serde::de::Unexpected::Str(text), &self));
        }
        LENGTH.parse(text).map(Side::Length)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Side, A::Error> {
        let mut names = Vec::new();
        while let Some(name) = seq.next_element::<String>()? {
            names.push(name);
        }
        let count = names.len();
        names.try_into().map(Side::Walls).map_err(|_| A::Error::invalid_length(count, &self))
    }
}
