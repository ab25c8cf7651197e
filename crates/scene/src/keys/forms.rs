//! Values that may be written in two ways.

use crate::model::{Accuracy, Diameter, Every, OrAuto};
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
use std::fmt;

struct OrAutoVisitor;

impl<'de> Deserialize<'de> for OrAuto {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<OrAuto, D::Error> {
        from.deserialize_any(OrAutoVisitor)
    }
}

impl Visitor<'_> for OrAutoVisitor {
    type Value = OrAuto;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("\"auto\" or a number")
    }

    fn visit_f64<E: Error>(self, v: f64) -> Result<OrAuto, E> {
        Ok(OrAuto::Given(v))
    }

    fn visit_i64<E: Error>(self, v: i64) -> Result<OrAuto, E> {
        Ok(OrAuto::Given(v as f64))
    }

    fn visit_str<E: Error>(self, v: &str) -> Result<OrAuto, E> {
        if v == "auto" {
            Ok(OrAuto::Auto)
        } else {
            Err(E::invalid_value(serde::de::Unexpected::Str(v), &self))
        }
    }
}

struct EveryVisitor;

impl<'de> Deserialize<'de> for Every {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Every, D::Error> {
        from.deserialize_any(EveryVisitor)
    }
}

impl Visitor<'_> for EveryVisitor {
    type Value = Every;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a time in seconds, such as 0.01, or \"step\"")
    }

    fn visit_f64<E: Error>(self, v: f64) -> Result<Every, E> {
        Ok(Every::Given(v))
    }

    fn visit_i64<E: Error>(self, v: i64) -> Result<Every, E> {
        Ok(Every::Given(v as f64))
    }

    fn visit_str<E: Error>(self, v: &str) -> Result<Every, E> {
        if v == "step" {
            Ok(Every::Step)
        } else {
            Err(E::invalid_value(serde::de::Unexpected::Str(v), &self))
        }
    }
}

struct AccuracyVisitor;

impl<'de> Deserialize<'de> for Accuracy {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Accuracy, D::Error> {
        from.deserialize_any(AccuracyVisitor)
    }
}

impl Visitor<'_> for AccuracyVisitor {
    type Value = Accuracy;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a share such as \"1%\" or 0.01")
    }

    fn visit_f64<E: Error>(self, v: f64) -> Result<Accuracy, E> {
        Ok(Accuracy(v))
    }

    fn visit_i64<E: Error>(self, v: i64) -> Result<Accuracy, E> {
        Ok(Accuracy(v as f64))
    }

    fn visit_str<E: Error>(self, v: &str) -> Result<Accuracy, E> {
        let share = v.trim().strip_suffix('%').and_then(|v| v.trim().parse::<f64>().ok());
        share
            .map(|s| Accuracy(s / 100.0))
            .ok_or_else(|| E::invalid_value(serde::de::Unexpected::Str(v), &self))
    }
}

struct DiameterVisitor;

impl<'de> Deserialize<'de> for Diameter {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Diameter, D::Error> {
        from.deserialize_any(DiameterVisitor)
    }
}

impl<'de> Visitor<'de> for DiameterVisitor {
    type Value = Diameter;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a diameter in metres, or two: [smallest, largest]")
    }

    fn visit_f64<E: Error>(self, v: f64) -> Result<Diameter, E> {
        Ok(Diameter { low: v, high: v })
    }

    fn visit_i64<E: Error>(self, v: i64) -> Result<Diameter, E> {
        self.visit_f64(v as f64)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Diameter, A::Error> {
        let missing = |n| A::Error::invalid_length(n, &DiameterVisitor);
        let low: f64 = seq.next_element()?.ok_or_else(|| missing(0))?;
        let high: f64 = seq.next_element()?.ok_or_else(|| missing(1))?;
        match seq.next_element::<f64>()? {
            None => Ok(Diameter { low, high }),
            Some(_) => Err(missing(3)),
        }
    }
}
