//! The layout of what is serialised, without its values: what a reader of bytes without names must know.
//!
//! ```text
//! State { dt: f64, fresh: [u32], zones: Zones { … }, loads: ([f64], [f64], [f64]) }
//! ```
//!
//! A list shows its first element, `[]` where there is none; an option shows `?` and what it holds; a variant its place and name.

use serde::ser::{
    Error as _, Serialize, SerializeMap, SerializeSeq, SerializeStruct, SerializeStructVariant,
    SerializeTuple, SerializeTupleStruct, SerializeTupleVariant, Serializer,
};
use std::fmt::{Error, Write};

/// The layout of a value.
///
/// # Errors
/// What the value itself refuses.
pub fn layout(value: &impl Serialize) -> Result<String, Error> {
    let mut text = String::new();
    value.serialize(Layout(&mut text))?;
    Ok(text)
}

struct Layout<'a>(&'a mut String);

/// Elements, separated by commas; `all` or only the first.
struct Elements<'a> {
    text: &'a mut String,
    count: usize,
    all: bool,
    end: &'static str,
}

impl Elements<'_> {
    fn add(&mut self, name: &str, value: &(impl Serialize + ?Sized)) -> Result<(), Error> {
        self.count += 1;
        if self.count > 1 && !self.all {
            return Ok(());
        }
        self.text.push_str(if self.count > 1 { ", " } else { "" });
        write!(self.text, "{name}")?;
        value.serialize(Layout(self.text))
    }

    fn finish(self) -> Result<(), Error> {
        self.text.push_str(self.end);
        Ok(())
    }
}

impl<'a> Layout<'a> {
    fn open(self, start: impl AsRef<str>, all: bool, end: &'static str) -> Result<Elements<'a>, Error> {
        self.0.push_str(start.as_ref());
        Ok(Elements { text: self.0, count: 0, all, end })
    }

    fn leaf(self, name: &str) -> Result<(), Error> {
        self.0.push_str(name);
        Ok(())
    }
}

macro_rules! leaves {
    ($($method:ident $kind:ty),*) => {
        $(fn $method(self, _: $kind) -> Result<(), Error> { self.leaf(stringify!($kind)) })*
    };
}

impl<'a> Serializer for Layout<'a> {
    type Ok = ();
    type Error = Error;
    type SerializeSeq = Elements<'a>;
    type SerializeTuple = Elements<'a>;
    type SerializeTupleStruct = Elements<'a>;
    type SerializeTupleVariant = Elements<'a>;
    type SerializeMap = Elements<'a>;
    type SerializeStruct = Elements<'a>;
    type SerializeStructVariant = Elements<'a>;

    leaves!(
        serialize_bool bool, serialize_i8 i8, serialize_i16 i16, serialize_i32 i32, serialize_i64 i64, serialize_u8 u8,
        serialize_u16 u16, serialize_u32 u32, serialize_u64 u64, serialize_f32 f32, serialize_f64 f64, serialize_char char,
        serialize_str &str, serialize_bytes &[u8]
    );

    fn serialize_none(self) -> Result<(), Error> {
        self.leaf("?")
    }
    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<(), Error> {
        self.0.push('?');
        value.serialize(self)
    }
    fn serialize_unit(self) -> Result<(), Error> {
        self.leaf("()")
    }
    fn serialize_unit_struct(self, name: &'static str) -> Result<(), Error> {
        self.leaf(name)
    }
    fn serialize_unit_variant(self, name: &'static str, at: u32, variant: &'static str) -> Result<(), Error> {
        self.leaf(&format!("{name}::{at} {variant}"))
    }
    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        name: &'static str,
        value: &T,
    ) -> Result<(), Error> {
        let mut one = self.open(format!("{name}("), true, ")")?;
        one.add("", value)?;
        one.finish()
    }
    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        name: &'static str,
        at: u32,
        variant: &'static str,
        value: &T,
    ) -> Result<(), Error> {
        let mut one = self.open(format!("{name}::{at} {variant}("), true, ")")?;
        one.add("", value)?;
        one.finish()
    }
    fn serialize_seq(self, _: Option<usize>) -> Result<Elements<'a>, Error> {
        self.open("[", false, "]")
    }
    fn serialize_tuple(self, _: usize) -> Result<Elements<'a>, Error> {
        self.open("(", true, ")")
    }
    fn serialize_tuple_struct(self, name: &'static str, _: usize) -> Result<Elements<'a>, Error> {
        self.open(format!("{name}("), true, ")")
    }
    fn serialize_tuple_variant(
        self,
        name: &'static str,
        at: u32,
        variant: &'static str,
        _: usize,
    ) -> Result<Elements<'a>, Error> {
        self.open(format!("{name}::{at} {variant}("), true, ")")
    }
    fn serialize_map(self, _: Option<usize>) -> Result<Elements<'a>, Error> {
        self.open("map [", false, "]")
    }
    fn serialize_struct(self, name: &'static str, _: usize) -> Result<Elements<'a>, Error> {
        self.open(format!("{name} {{ "), true, " }")
    }
    fn serialize_struct_variant(
        self,
        name: &'static str,
        at: u32,
        variant: &'static str,
        _: usize,
    ) -> Result<Elements<'a>, Error> {
        self.open(format!("{name}::{at} {variant} {{ "), true, " }")
    }
}

macro_rules! without_names {
    ($($kind:ident $method:ident),*) => {
        $(impl $kind for Elements<'_> {
            type Ok = ();
            type Error = Error;
            fn $method<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Error> {
                self.add("", value)
            }
            fn end(self) -> Result<(), Error> {
                self.finish()
            }
        })*
    };
}

without_names!(SerializeSeq serialize_element, SerializeTuple serialize_element, SerializeTupleStruct serialize_field,
    SerializeTupleVariant serialize_field);

macro_rules! with_names {
    ($($kind:ident),*) => {
        $(impl $kind for Elements<'_> {
            type Ok = ();
            type Error = Error;
            fn serialize_field<T: Serialize + ?Sized>(&mut self, name: &'static str, value: &T) -> Result<(), Error> {
                self.add(&format!("{name}: "), value)
            }
            fn end(self) -> Result<(), Error> {
                self.finish()
            }
        })*
    };
}

with_names!(SerializeStruct, SerializeStructVariant);

impl SerializeMap for Elements<'_> {
    type Ok = ();
    type Error = Error;
    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<(), Error> {
        self.add("", key)
    }
    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Error> {
        if self.count > 1 {
            return Ok(());
        }
        self.text.push_str(" to ");
        value.serialize(Layout(self.text)).map_err(Error::custom)
    }
    fn end(self) -> Result<(), Error> {
        self.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::layout;
    use std::collections::BTreeMap;

    #[test]
    fn values_change_nothing_and_kinds_do() {
        let of = |x: f64, list: &[u16]| {
            layout(&(x, list.to_vec(), Some(BTreeMap::from([(1u8, [x; 2])])))).expect("sound")
        };
        assert_eq!(of(1.0, &[1, 2, 3]), "(f64, [u16], ?map [u8 to (f64, f64)])");
        assert_eq!(of(1.0, &[7]), of(-5.0, &[2, 2]));
        assert_eq!(layout(&(Vec::<u8>::new(), None::<u8>, "a")).expect("sound"), "([], ?, &str)");
    }
}
