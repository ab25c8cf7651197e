//! Values of keys: how each type is read, what it is called, and which of its numbers a range is about.
//!
//! Numbers are plain in the unit of their key, or text with a unit such as "8 mm". Lists may be written as a list of numbers and texts, or as
//! one text with commas.

use super::table::{Judge, Key, Range, TableShape};
use crate::error::Result as Checked;
use dem::setup::{WhenBlocked, ZoneMotion, ZoneTest};
use geom::units;
use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, Error, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// The unit of a key, a text that a number of it takes, and a value of the key.
#[derive(Clone, Copy)]
pub struct KeyUnit {
    /// Unit of plain numbers; "" for none.
    pub unit: &'static str,
    pub such: &'static str,
    /// A value of the key in TOML; "" where it is none of a key.
    pub example: &'static str,
}

impl KeyUnit {
    /// That of this name.
    pub fn of(unit: &'static str) -> KeyUnit {
        let such = match unit {
            "m" => "8 mm",
            "m²" => "20 cm²",
            "m³" => "2 cm³",
            "s" => "20 ms",
            "kg" => "2 t",
            "kg/s" => "1.5 t/h",
            "1/s" => "100 1/s",
            "m/s" => "50 mm/s",
            "m/s²" => "9.81 m/s²",
            "rad" => "15 deg",
            "rad/s" => "30 rpm",
            "rpm" => "8 rpm",
            "Hz" => "50 Hz",
            "N" => "2 kN",
            "N/m" => "2 kN/m",
            "N·s/m" | "N s/m" => "2 kN·s/m",
            "Pa" => "5 MPa",
            "Pa/m" => "2 GPa/m",
            "Pa·s" => "1 cP",
            "J" => "1 mJ",
            "J/m²" => "50 mJ/m²",
            "J/m³" => "20 kJ/m³",
            "kg/m³" => "2.5 g/cm³",
            _ => "40 %",
        };
        KeyUnit { unit, such, example: "" }
    }

    /// The same of a key with this example.
    pub fn of_key(unit: &'static str, example: &'static str) -> KeyUnit {
        KeyUnit { example, ..KeyUnit::of(unit) }
    }

    /// The same of a part of the value.
    pub fn within(self) -> KeyUnit {
        KeyUnit { example: "", ..self }
    }

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

    pub(super) fn expecting(self, f: &mut fmt::Formatter, what: &str) -> fmt::Result {
        self.expecting_such(f, what, &format!("0.5 or \"{}\"", self.such))
    }

    /// What is expected, with an example; "" for none.
    pub(super) fn expecting_such(self, f: &mut fmt::Formatter, what: &str, such: &str) -> fmt::Result {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" [{}]", self.unit) };
        let such = if such.is_empty() { String::new() } else { format!(", such as {such}") };
        write!(f, "{what}{unit}{such}")
    }
}

/// Whether a text is meant as a number, with or without a unit.
pub(super) fn begins_as_number(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
}

/// A value of a key.
pub trait KeyValue: Sized {
    /// Its type in words.
    fn kind() -> String;

    /// Reads it; plain numbers are in `unit`.
    ///
    /// # Errors
    /// A value of another type, a text that is not a number of this unit.
    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<Self, D::Error>;

    /// The table that it is, if it is one.
    fn table() -> Option<TableShape> {
        None
    }

    /// The numbers that a range is about.
    fn numbers(&self) -> Vec<f64> {
        Vec::new()
    }

    /// The word that it is, if it is one of several.
    fn word(&self) -> Option<&'static str> {
        None
    }

    /// Checks that they are in the range of their key.
    ///
    /// # Errors
    /// The first that is not.
    fn check(&self, judge: &dyn Judge, at: &str, key: &Key) -> Checked<()> {
        judge.numbers(at, key, &self.numbers())
    }
}

/// Reads one value of a table or a list (a seed of serde); plain numbers are in this unit.
pub(super) struct In<T>(KeyUnit, PhantomData<T>);

impl<T> In<T> {
    pub fn new(unit: KeyUnit) -> In<T> {
        In(unit, PhantomData)
    }
}

impl<'de, T: KeyValue> DeserializeSeed<'de> for In<T> {
    type Value = T;

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<T, D::Error> {
        T::read(self.0, from)
    }
}

/// Words in quotation marks, with commas.
pub(super) fn quoted<'a>(words: impl Iterator<Item = &'a str>) -> String {
    words.map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(", ")
}

/// Reads a word that is one of these.
pub(super) struct Word(pub Vec<&'static str>);

impl<'de> DeserializeSeed<'de> for Word {
    type Value = &'static str;

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<&'static str, D::Error> {
        from.deserialize_any(self)
    }
}

impl Visitor<'_> for Word {
    type Value = &'static str;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "one of {}", quoted(self.0.iter().copied()))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<&'static str, E> {
        let known = self.0.iter().find(|word| **word == text).copied();
        known.ok_or_else(|| {
            // As serde writes it: `text::parse` reads it again.
            let known = self.0.iter().map(|k| format!("`{k}`")).collect::<Vec<_>>().join(", ");
            E::custom(format_args!("unknown variant `{text}`, expected one of {known}"))
        })
    }
}

/// Enums whose variants are words of a scene: they have `ALL` and `name`.
macro_rules! word_values {
    ($($type:ty)*) => { $(
        impl $crate::keys::value::KeyValue for $type {
            fn kind() -> String {
                $crate::keys::value::quoted(<$type>::ALL.iter().map(|word| word.name()))
            }

            fn read<'de, D: serde::Deserializer<'de>>(
                _: $crate::keys::value::KeyUnit,
                from: D,
            ) -> std::result::Result<$type, D::Error> {
                let names = <$type>::ALL.iter().map(|word| word.name()).collect();
                let text = serde::de::DeserializeSeed::deserialize($crate::keys::value::Word(names), from)?;
                let word = <$type>::ALL.iter().find(|word| word.name() == text).copied();
                word.ok_or_else(|| serde::de::Error::custom(text))
            }

            fn word(&self) -> Option<&'static str> {
                Some(self.name())
            }
        }
    )* };
}

pub(super) use word_values;

word_values! { WhenBlocked ZoneMotion ZoneTest }

/// Types that serde reads, and what they are called.
macro_rules! plain_values {
    ($($type:ty, $kind:literal;)*) => { $(
        impl KeyValue for $type {
            fn kind() -> String {
                $kind.to_owned()
            }

            fn read<'de, D: Deserializer<'de>>(_: KeyUnit, from: D) -> Result<$type, D::Error> {
                <$type>::deserialize(from)
            }
        }
    )* };
}

plain_values! {
    bool, "true/false";
    toml::Value, "list or text or table";
}

impl KeyValue for [String; 2] {
    fn kind() -> String {
        "2 names".to_owned()
    }

    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<[String; 2], D::Error> {
        exactly(unit, "a list of 2 names", from)
    }
}

/// Reads a list of so many values, and of no more.
pub(super) fn exactly<'de, T: KeyValue, D: Deserializer<'de>, const N: usize>(
    unit: KeyUnit,
    expected: &'static str,
    from: D,
) -> Result<[T; N], D::Error> {
    let values = Vec::<T>::read(unit, from)?;
    let count = values.len();
    values.try_into().map_err(|_| D::Error::invalid_length(count, &expected))
}

impl KeyValue for String {
    fn kind() -> String {
        "text".to_owned()
    }

    fn read<'de, D: Deserializer<'de>>(_: KeyUnit, from: D) -> Result<String, D::Error> {
        String::deserialize(from)
    }

    fn check(&self, judge: &dyn Judge, at: &str, key: &Key) -> Checked<()> {
        if key.range == Range::Name { judge.name(at, self) } else { Ok(()) }
    }
}

/// TOML has no null: a key that is there has a value.
impl<T: KeyValue> KeyValue for Option<T> {
    fn kind() -> String {
        T::kind()
    }

    fn table() -> Option<TableShape> {
        T::table()
    }

    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<Option<T>, D::Error> {
        T::read(unit, from).map(Some)
    }

    fn check(&self, judge: &dyn Judge, at: &str, key: &Key) -> Checked<()> {
        self.as_ref().map_or(Ok(()), |value| value.check(judge, at, key))
    }
}

/// A list of tables, as [`crate::text`] knows it.
pub(crate) const TABLES: &str = "a sequence of tables";

/// Reads a list of any length.
struct List<T>(KeyUnit, PhantomData<T>);

impl<'de, T: KeyValue> Visitor<'de> for List<T> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match T::table() {
            Some(_) => f.write_str(TABLES),
            None => self.0.expecting_such(f, &format!("a {}", Vec::<T>::kind()), self.0.example),
        }
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Vec<T>, A::Error> {
        let mut list = Vec::new();
        while let Some(value) = seq.next_element_seed(In::<T>::new(self.0.within()))? {
            list.push(value);
        }
        Ok(list)
    }
}

impl<T: KeyValue> KeyValue for Vec<T> {
    fn kind() -> String {
        let each = T::kind();
        let lists = each.starts_with(|c: char| c.is_ascii_digit());
        format!("list of {}{each}", if lists { "lists of " } else { "" })
    }

    fn table() -> Option<TableShape> {
        T::table()
    }

    fn read<'de, D: Deserializer<'de>>(unit: KeyUnit, from: D) -> Result<Vec<T>, D::Error> {
        from.deserialize_seq(List(unit, PhantomData))
    }

    fn check(&self, judge: &dyn Judge, at: &str, key: &Key) -> Checked<()> {
        let words: Vec<&str> = self.iter().filter_map(T::word).collect();
        judge.once(at, &words)?;
        self.iter().enumerate().try_for_each(|(i, value)| value.check(judge, &format!("{at}.{i}"), key))
    }
}
