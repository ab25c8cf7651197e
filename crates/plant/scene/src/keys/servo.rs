//! Walls that follow a force or a stress.

use super::table::table;
use super::value::{KeyUnit, KeyValue, begins_as_number, exactly};
use super::whole::whole_as_number;
use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use std::fmt;

table! {
    /// A force that a wall follows.
    Servo section {
        /// Direction in which the wall pushes; of a plane, to the side of the grains.
        direction: [f64; 3] = required, "", Finite, "[0, 0, -1]";
        /// Force on the grains; this, `stress` or `path`.
        force: Option<f64> = absent("–"), "N", Finite, "100";
        /// Stress on the grains, on `area` or `area_between`.
        stress: Option<f64> = absent("–"), "Pa", Finite, "\"100 kPa\"";
        /// Force or stress over time: see below.
        path: Option<ServoPath> = absent("–"), "", Any, "";
        /// Area that a stress acts on.
        area: Option<f64> = absent("–"), "m²", Positive, "\"20 cm²\"";
        /// The two sides of that area: each a pair of walls, or a length; see below.
        area_between: Option<[Side; 2]> = absent("–"), "m", Positive, "[[\"left\", \"right\"], \"10 cm\"]";
        /// Largest speed.
        speed_limit: f64 = required, "m/s", Positive, "0.1";
    }
}

table! {
    /// A table of force or stress over time.
    ServoPath inline {
        /// A CSV file with the columns `t` [s], and `force` [N] or `stress` [Pa].
        source: String = required, "", File, "\"load.csv\"";
    }
}

/// A side of an area.
#[derive(Debug, Clone, PartialEq)]
pub enum Side {
    /// Its length [m].
    Length(f64),
    /// The distance of two walls, by name.
    Walls([String; 2]),
}

impl KeyValue for Side {
    fn kind() -> String {
        "text or number".to_owned()
    }

    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<Side, D::Error> {
        from.deserialize_any(SideVisitor(unit))
    }

    fn numbers(&self) -> Vec<f64> {
        match self {
            Side::Length(length) => vec![*length],
            Side::Walls(_) => Vec::new(),
        }
    }
}

impl KeyValue for [Side; 2] {
    fn kind() -> String {
        "list of 2, each 2 names or a number".to_owned()
    }

    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<[Side; 2], D::Error> {
        exactly(unit, "a list of 2", from)
    }

    fn numbers(&self) -> Vec<f64> {
        self.iter().flat_map(Side::numbers).collect()
    }
}

struct SideVisitor(KeyUnit);

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

    whole_as_number! { Side }

    fn visit_str<E: Error>(self, text: &str) -> Result<Side, E> {
        if !begins_as_number(text) {
            return Err(E::invalid_value(serde::de::Unexpected::Str(text), &self));
        }
        self.0.parse(text).map(Side::Length)
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
