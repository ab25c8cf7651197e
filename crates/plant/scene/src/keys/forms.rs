//! Values that may be written in two ways: a share, a word or a truth value, one table or a list of them.

use super::{Accuracy, BackThroughZone, EnergyGuard};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Unexpected, Visitor};
use std::fmt;
use std::marker::PhantomData;

impl<'de> Deserialize<'de> for Accuracy {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Accuracy, D::Error> {
        from.deserialize_any(Share)
    }
}

struct Share;

impl Visitor<'_> for Share {
    type Value = Accuracy;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a share such as \"1%\" or 0.01")
    }

    fn visit_f64<E: Error>(self, v: f64) -> Result<Accuracy, E> {
        Ok(Accuracy(v))
    }

    fn visit_i64<E: Error>(self, v: i64) -> Result<Accuracy, E> {
        self.visit_f64(v as f64)
    }

    fn visit_str<E: Error>(self, v: &str) -> Result<Accuracy, E> {
        // Units keep the digits: 0.0000001 % is 1e-9, and its number over 100 is less.
        let share = Some(v.trim()).filter(|v| v.ends_with('%')).and_then(|v| geom::units::parse(v, "").ok());
        share.map(Accuracy).ok_or_else(|| E::invalid_value(Unexpected::Str(v), &self))
    }
}

impl<'de> Deserialize<'de> for BackThroughZone {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<BackThroughZone, D::Error> {
        from.deserialize_any(Back)
    }
}

struct Back;

impl Visitor<'_> for Back {
    type Value = BackThroughZone;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("true, false or \"remove\"")
    }

    fn visit_bool<E: Error>(self, stops: bool) -> Result<BackThroughZone, E> {
        Ok(if stops { BackThroughZone::Stops } else { BackThroughZone::Stays })
    }

    fn visit_str<E: Error>(self, v: &str) -> Result<BackThroughZone, E> {
        match v {
            "remove" => Ok(BackThroughZone::IsRemoved),
            _ => Err(E::invalid_value(Unexpected::Str(v), &self)),
        }
    }
}

impl<'de> Deserialize<'de> for EnergyGuard {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<EnergyGuard, D::Error> {
        from.deserialize_any(ShareOrOff)
    }
}

struct ShareOrOff;

impl Visitor<'_> for ShareOrOff {
    type Value = EnergyGuard;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a share such as 0.02 or \"2%\", or false")
    }

    fn visit_bool<E: Error>(self, guards: bool) -> Result<EnergyGuard, E> {
        if guards { Err(E::invalid_value(Unexpected::Bool(true), &self)) } else { Ok(EnergyGuard::Off) }
    }

    fn visit_f64<E: Error>(self, v: f64) -> Result<EnergyGuard, E> {
        Ok(EnergyGuard::Share(v))
    }

    fn visit_i64<E: Error>(self, v: i64) -> Result<EnergyGuard, E> {
        self.visit_f64(v as f64)
    }

    fn visit_str<E: Error>(self, v: &str) -> Result<EnergyGuard, E> {
        let share = geom::units::parse(v, "").map(EnergyGuard::Share);
        share.map_err(|_| E::invalid_value(Unexpected::Str(v), &self))
    }
}

/// Reads a table, or a list of tables.
pub(super) fn one_or_more<'de, D, T>(from: D) -> Result<Option<Vec<T>>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    from.deserialize_any(OneOrMore(PhantomData)).map(Some)
}

struct OneOrMore<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for OneOrMore<T> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a table, or a list of tables")
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Vec<T>, A::Error> {
        T::deserialize(MapAccessDeserializer::new(map)).map(|one| vec![one])
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Vec<T>, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(seq))
    }
}
