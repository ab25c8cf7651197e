//! Planes and shapes of a scene: text as on the command line, or lists of numbers and texts with units.
//!
//! Both become the text of the command line, which has one parser.

use super::value::{In, KeyUnit, KeyValue};
use geom::units;
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor};
use std::fmt;
use std::ops::Deref;

/// Numbers with commas.
fn joined(numbers: &[f64]) -> String {
    numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(",")
}

/// The rest of a list: numbers in metres, or texts with a unit.
fn lengths<'de, A: SeqAccess<'de>>(seq: &mut A) -> Result<Vec<f64>, A::Error> {
    let mut numbers = Vec::new();
    while let Some(number) = seq.next_element_seed(In::<f64>::new(KeyUnit::of("m")))? {
        numbers.push(number);
    }
    Ok(numbers)
}

/// A text whose lengths with units are in metres; other parts stay as they are.
fn in_metres(text: &str) -> String {
    let (name, numbers) = match text.split_once(':') {
        Some((name, numbers)) => (format!("{name}:"), numbers),
        None => (String::new(), text),
    };
    let part = |part: &str| units::parse(part, "m").map_or_else(|_| part.to_owned(), |v| v.to_string());
    name + &numbers.split(',').map(part).collect::<Vec<_>>().join(",")
}

/// Texts as the command line has them, which a visitor reads.
macro_rules! texts {
    ($($(#[$about:meta])* $name:ident $visitor:ident $kind:literal;)*) => { $(
        $(#[$about])*
        #[derive(Debug, Clone, PartialEq)]
        pub struct $name(pub String);

        impl Deref for $name {
            type Target = str;

            fn deref(&self) -> &str {
                &self.0
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(self)
            }
        }

        impl KeyValue for $name {
            fn kind() -> String {
                $kind.to_owned()
            }

            fn read<'de, D: Deserializer<'de>>(_: KeyUnit, from: D) -> Result<$name, D::Error> {
                from.deserialize_any($visitor).map($name)
            }
        }
    )* };
}

texts! {
    /// A plane: `px,py,pz,nx,ny,nz`.
    PlaneText PlaneVisitor "text or 6 numbers";
    /// A shape: `box:x0,y0,z0,x1,y1,z1`.
    ShapeText ShapeVisitor "text or list or table";
}

struct PlaneVisitor;

impl<'de> Visitor<'de> for PlaneVisitor {
    type Value = String;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a plane: \"px,py,pz,nx,ny,nz\" or [px, py, pz, nx, ny, nz], a point [m] and the normal")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<String, E> {
        Ok(in_metres(text))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<String, A::Error> {
        let numbers = lengths(&mut seq)?;
        match numbers.len() {
            6 => Ok(joined(&numbers)),
            n => Err(A::Error::invalid_length(n, &self)),
        }
    }
}

struct ShapeVisitor;

impl<'de> Visitor<'de> for ShapeVisitor {
    type Value = String;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(
            "a shape: \"box:0,0,0,1,1,1\", [\"box\", 0, 0, 0, 1, 1, 1] or { box = [0, 0, 0, 1, 1, 1] }",
        )
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<String, E> {
        Ok(in_metres(text))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<String, A::Error> {
        let name: String = seq.next_element()?.ok_or_else(|| A::Error::invalid_length(0, &self))?;
        let numbers = lengths(&mut seq)?;
        Ok(format!("{name}:{}", joined(&numbers)))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<String, A::Error> {
        let name: String = map.next_key()?.ok_or_else(|| A::Error::invalid_length(0, &self))?;
        let numbers = map.next_value_seed(Values)?;
        match map.next_key::<String>()? {
            None => Ok(format!("{name}:{numbers}")),
            Some(other) => Err(A::Error::custom(format_args!("a shape has one name: '{name}' or '{other}'"))),
        }
    }
}

/// The numbers of a shape, or the file of one.
struct Values;

impl<'de> serde::de::DeserializeSeed<'de> for Values {
    type Value = String;

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<String, D::Error> {
        from.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Values {
    type Value = String;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("the numbers of a shape [m], or the name of its file")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<String, E> {
        Ok(in_metres(text))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<String, A::Error> {
        let numbers = lengths(&mut seq)?;
        Ok(joined(&numbers))
    }
}
