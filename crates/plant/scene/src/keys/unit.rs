//! Numbers of a scene: plain numbers in the unit of their key, or text with a unit such as "8 mm".
//!
//! Each key names its unit where it is declared: `#[serde(deserialize_with = "unit::metres")]`. Lists may be written as a list of numbers
//! and texts, or as one text with commas.

use super::{Diameter, Every, OrAuto};
use geom::units;
use serde::de::{DeserializeSeed, Deserializer, Error, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// The unit of a key, and a text that it takes.
#[derive(Clone, Copy)]
pub struct KeyUnit {
    /// Unit of plain numbers; "" for none.
    pub unit: &'static str,
    /// An example of a text.
    pub such: &'static str,
}

impl KeyUnit {
    /// The number in a text.
    pub fn parse<E: Error>(self, text: &str) -> Result<f64, E> {
        units::parse(text, self.unit).map_err(|e| {
            let plain = if self.unit.is_empty() {
                "a number".to_owned()
            } else {
                format!("a number [{}]", self.unit)
            };
            E::custom(format_args!("{e}; expected {plain}, or text with a unit, such as \"{}\"", self.such))
        })
    }

    fn expecting(self, f: &mut fmt::Formatter, what: &str) -> fmt::Result {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" [{}]", self.unit) };
        write!(f, "{what}{unit}, such as 0.5 or \"{}\"", self.such)
    }
}

macro_rules! units {
    ($($name:ident $unit:literal $such:literal;)*) => { $(
        pub(super) fn $name<'de, D: Deserializer<'de>, T: InUnit>(from: D) -> Result<T, D::Error> {
            T::read(KeyUnit { unit: $unit, such: $such }, from)
        }
    )* };
}

units! {
    metres "m" "8 mm";
    square_metres "m²" "20 cm²";
    cubic_metres "m³" "2 cm³";
    seconds "s" "20 ms";
    kilograms "kg" "2 t";
    kilograms_a_second "kg/s" "1.5 t/h";
    a_second "1/s" "100 1/s";
    metres_a_second "m/s" "50 mm/s";
    metres_a_second_squared "m/s²" "9.81 m/s²";
    radians "rad" "15 deg";
    radians_a_second "rad/s" "30 rpm";
    turns_a_minute "rpm" "8 rpm";
    hertz "Hz" "50 Hz";
    newtons "N" "2 kN";
    newtons_a_metre "N/m" "2 kN/m";
    newton_seconds_a_metre "N·s/m" "2 kN·s/m";
    pascals_a_metre "Pa/m" "2 GPa/m";
    joules "J" "1 mJ";
    pascals "Pa" "5 MPa";
    pascal_seconds "Pa·s" "1 cP";
    density "kg/m³" "2.5 g/cm³";
    plain "" "40 %";
}

/// The text example of a unit, for keys whose unit the engine's effects name.
pub(super) fn of(unit: &'static str) -> KeyUnit {
    let such = match unit {
        "m" => "8 mm",
        "m/s" => "50 mm/s",
        "N/m" => "2 kN/m",
        "J/m²" => "50 mJ/m²",
        "J/m³" => "20 kJ/m³",
        "rad" => "15 deg",
        "Pa" => "5 MPa",
        _ => "40 %",
    };
    KeyUnit { unit, such }
}

/// Whether a text is meant as a number, with or without a unit.
pub(super) fn begins_as_number(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
}

/// A value that is made of numbers of one unit.
pub trait InUnit: Sized {
    /// Reads it.
    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<Self, D::Error>;
}

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

    fn visit_i64<E: Error>(self, v: i64) -> Result<f64, E> {
        Ok(v as f64)
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<f64, E> {
        self.0.parse(text)
    }
}

impl InUnit for f64 {
    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<f64, D::Error> {
        Number(unit).deserialize(from)
    }
}

/// TOML has no null: a key that is there has a value.
impl<T: InUnit> InUnit for Option<T> {
    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<Option<T>, D::Error> {
        T::read(unit, from).map(Some)
    }
}

/// Reads `N` numbers.
struct Numbers<const N: usize>(KeyUnit);

impl<'de, const N: usize> Visitor<'de> for Numbers<N> {
    type Value = [f64; N];

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.0.expecting(f, &format!("a list of {N} numbers"))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<[f64; N], A::Error> {
        let mut numbers = [0.0; N];
        for (k, number) in numbers.iter_mut().enumerate() {
            *number =
                seq.next_element_seed(Number(self.0))?.ok_or_else(|| A::Error::invalid_length(k, &self))?;
        }
        match seq.next_element_seed(Number(self.0))? {
            None => Ok(numbers),
            Some(_) => Err(A::Error::invalid_length(N + 1, &self)),
        }
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

impl<const N: usize> InUnit for [f64; N] {
    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<[f64; N], D::Error> {
        from.deserialize_any(Numbers(unit))
    }
}

/// Reads a list of any length.
struct List<const N: usize>(KeyUnit);

impl<'de, const N: usize> Visitor<'de> for List<N> {
    type Value = Vec<[f64; N]>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "a list of lists of {N} numbers [{}]", self.0.unit)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Vec<[f64; N]>, A::Error> {
        let mut list = Vec::new();
        while let Some(numbers) = seq.next_element_seed(Seed::<[f64; N]>(self.0, PhantomData))? {
            list.push(numbers);
        }
        Ok(list)
    }
}

impl<const N: usize> InUnit for Vec<[f64; N]> {
    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<Vec<[f64; N]>, D::Error> {
        from.deserialize_seq(List(unit))
    }
}

/// Reads a value in a unit inside another one.
pub(super) struct Seed<T>(pub KeyUnit, pub PhantomData<T>);

impl<'de, T: InUnit> DeserializeSeed<'de> for Seed<T> {
    type Value = T;

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<T, D::Error> {
        T::read(self.0, from)
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

    fn visit_i64<E: Error>(self, v: i64) -> Result<T, E> {
        self.visit_f64(v as f64)
    }

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

impl InUnit for OrAuto {
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
}

impl InUnit for Every {
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
}

impl InUnit for Diameter {
    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<Diameter, D::Error> {
        let range: Option<fn([f64; 2]) -> Diameter> = Some(|[low, high]| Diameter { low, high });
        let what = "one value, or two: [smallest, largest]";
        from.deserialize_any(NumberOr {
            unit,
            what,
            number: |v| Diameter { low: v, high: v },
            word: None,
            range,
        })
    }
}
