//! Values that may be written in two ways.

use super::{Accuracy, Diameter, Every, OrAuto};
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Unexpected, Visitor};
use std::fmt;

/// Reads a type from a number, or from what the further methods of its visitor take.
macro_rules! written_as {
    ($type:ident, $expecting:literal, $number:expr, { $($more:tt)* }) => {
        impl<'de> Deserialize<'de> for $type {
            fn deserialize<D: Deserializer<'de>>(from: D) -> Result<$type, D::Error> {
                struct Form;
                impl<'de> Visitor<'de> for Form {
                    type Value = $type;

                    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                        f.write_str($expecting)
                    }

                    fn visit_f64<E: Error>(self, v: f64) -> Result<$type, E> {
                        Ok($number(v))
                    }

                    fn visit_i64<E: Error>(self, v: i64) -> Result<$type, E> {
                        self.visit_f64(v as f64)
                    }

                    $($more)*
                }
                from.deserialize_any(Form)
            }
        }
    };
}

written_as!(OrAuto, "\"auto\" or a number", |v| OrAuto(Some(v)), {
    fn visit_str<E: Error>(self, v: &str) -> Result<OrAuto, E> {
        if v == "auto" { Ok(OrAuto(None)) } else { Err(E::invalid_value(Unexpected::Str(v), &self)) }
    }
});

written_as!(Every, "a time in seconds, such as 0.01, or \"step\"", Every::Given, {
    fn visit_str<E: Error>(self, v: &str) -> Result<Every, E> {
        if v == "step" { Ok(Every::Step) } else { Err(E::invalid_value(Unexpected::Str(v), &self)) }
    }
});

written_as!(Accuracy, "a share such as \"1%\" or 0.01", Accuracy, {
    fn visit_str<E: Error>(self, v: &str) -> Result<Accuracy, E> {
        let share = v.trim().strip_suffix('%').and_then(|v| v.trim().parse::<f64>().ok());
        share.map(|s| Accuracy(s / 100.0)).ok_or_else(|| E::invalid_value(Unexpected::Str(v), &self))
    }
});

written_as!(
    Diameter,
    "a diameter in metres, or two: [smallest, largest]",
    |v| Diameter { low: v, high: v },
    {
        fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Diameter, A::Error> {
            let missing = |n| A::Error::invalid_length(n, &self);
            let low: f64 = seq.next_element()?.ok_or_else(|| missing(0))?;
            let high: f64 = seq.next_element()?.ok_or_else(|| missing(1))?;
            match seq.next_element::<f64>()? {
                None => Ok(Diameter { low, high }),
                Some(_) => Err(missing(3)),
            }
        }
    }
);
