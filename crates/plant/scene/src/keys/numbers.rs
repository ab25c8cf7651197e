//! Values that are made of numbers: one, several, a range, a number or a word.

use super::value::{KeyUnit, KeyValue, begins_as_number};
use super::whole::whole_as_number;
use super::{Every, OneOrRange, OrAuto};
use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, SeqAccess, Visitor};
use std::fmt;

/// Reads one number.
struct Number(KeyUnit);

impl<'de> DeserializeSeed<'de> for Number {
    type Value = f64;

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<f64, D::Error> {
        from.deserialize_any(self)
    }
}

impl Visitor<'_> for Number {
    type Value = f64;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.0.expecting(f, "a number")
    }

    fn visit_f64<E: Error>(self, v: f64) -> Result<f64, E> {
        Ok(v)
    }

    whole_as_number! { f64 }

    fn visit_str<E: Error>(self, text: &str) -> Result<f64, E> {
        self.0.parse(text)
    }
}

impl KeyValue for f64 {
    fn kind() -> String {
        "number".to_owned()
    }

    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<f64, D::Error> {
        Number(unit).deserialize(from)
    }

    fn numbers(&self) -> Vec<f64> {
        vec![*self]
    }
}

/// Reads `N` numbers.
struct Numbers<const N: usize>(KeyUnit);

impl<'de, const N: usize> Visitor<'de> for Numbers<N> {
    type Value = [f64; N];

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        // A list in a list has no example, and the example of the key may be one number.
        let such = match self.0.example {
            list if list.starts_with('[') => list.to_owned(),
            _ => format!("[{}]", ["0.5"; N].join(", ")),
        };
        self.0.expecting_such(f, &format!("a list of {N} numbers"), &such)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<[f64; N], A::Error> {
        let mut numbers = [0.0; N];
        for (k, number) in numbers.iter_mut().enumerate() {
            *number =
                seq.next_element_seed(Number(self.0))?.ok_or_else(|| A::Error::invalid_length(k, &self))?;
        }
        let mut count = N;
        while seq.next_element::<IgnoredAny>()?.is_some() {
            count += 1;
        }
        if count == N { Ok(numbers) } else { Err(A::Error::invalid_length(count, &self)) }
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<[f64; N], E> {
        let number = |part: &str| match part.trim().parse() {
            Ok(number) => Ok(number),
            Err(_) => self.0.parse(part),
        };
        let numbers = text.split(',').map(number).collect::<Result<Vec<f64>, E>>()?;
        let count = numbers.len();
        numbers.try_into().map_err(|_| E::invalid_length(count, &self))
    }
}

impl<const N: usize> KeyValue for [f64; N] {
    fn kind() -> String {
        format!("{N} numbers")
    }

    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<[f64; N], D::Error> {
        from.deserialize_any(Numbers(unit))
    }

    fn numbers(&self) -> Vec<f64> {
        self.to_vec()
    }
}

/// A number, or one of the other ways to write a value.
struct NumberOr<T> {
    unit: KeyUnit,
    what: &'static str,
    number: fn(f64) -> T,
    word: Option<(&'static str, T)>,
    range: Option<fn([f64; 2]) -> T>,
}

impl<'de, T: Copy> Visitor<'de> for NumberOr<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.unit.expecting(f, self.what)
    }

    fn visit_f64<E: Error>(self, v: f64) -> Result<T, E> {
        Ok((self.number)(v))
    }

    whole_as_number! { T }

    fn visit_str<E: Error>(self, text: &str) -> Result<T, E> {
        match self.word {
            Some((word, value)) if text == word => Ok(value),
            Some(_) if !begins_as_number(text) => {
                Err(E::invalid_value(serde::de::Unexpected::Str(text), &self))
            }
            _ => self.unit.parse(text).map(self.number),
        }
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<T, A::Error> {
        match self.range {
            Some(range) => Numbers::<2>(self.unit).visit_seq(seq).map(range),
            None => Err(A::Error::invalid_type(serde::de::Unexpected::Seq, &self)),
        }
    }
}

impl KeyValue for OrAuto {
    fn kind() -> String {
        "number or \"auto\"".to_owned()
    }

    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<OrAuto, D::Error> {
        let word = Some(("auto", OrAuto(None)));
        from.deserialize_any(NumberOr {
            unit,
            what: "\"auto\" or a number",
            number: |v| OrAuto(Some(v)),
            word,
            range: None,
        })
    }

    fn numbers(&self) -> Vec<f64> {
        self.0.into_iter().collect()
    }
}

impl KeyValue for Every {
    fn kind() -> String {
        "number or \"step\"".to_owned()
    }

    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<Every, D::Error> {
        let word = Some(("step", Every::Step));
        from.deserialize_any(NumberOr {
            unit,
            what: "\"step\" or a time",
            number: Every::Given,
            word,
            range: None,
        })
    }

    fn numbers(&self) -> Vec<f64> {
        match self {
            Every::Step => Vec::new(),
            Every::Given(time) => vec![*time],
        }
    }
}

impl KeyValue for OneOrRange {
    fn kind() -> String {
        "number or 2 numbers".to_owned()
    }

    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<OneOrRange, D::Error> {
        let range: Option<fn([f64; 2]) -> OneOrRange> = Some(|[low, high]| OneOrRange { low, high });
        let what = "one value, or two: [smallest, largest]";
        from.deserialize_any(NumberOr {
            unit,
            what,
            number: |v| OneOrRange { low: v, high: v },
            word: None,
            range,
        })
    }

    fn numbers(&self) -> Vec<f64> {
        vec![self.low, self.high]
    }
}
