//! Tables of keys. [`table!`] declares each key of a scene once: name, type, default, unit, range, meaning, example. It becomes the field
//! of a struct, the reader of that field, the check of its range, and a row of docs/reference/scene.md and of `dem-run --keys`.

pub use super::range::Range;
use super::value::{KeyUnit, KeyValue};
use crate::error::Result;
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// One key of a table.
#[derive(Debug, Clone, Copy)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// Its type in words.
    pub kind: fn() -> String,
    /// Unit of plain numbers; "" for none.
    pub unit: &'static str,
    /// What holds without it, in words; [`REQUIRED`] where nothing does.
    pub default: &'static str,
    /// The numbers that it takes.
    pub range: Range,
    /// What it means.
    pub doc: &'static str,
    /// A value in TOML; "" for a table.
    pub example: &'static str,
    /// The table that is its value, if it is one.
    pub table: fn() -> Option<TableShape>,
}

/// What judges the values of keys.
pub trait Judge {
    /// Whether numbers are in the range of their key.
    ///
    /// # Errors
    /// The first that is not.
    fn numbers(&self, at: &str, key: &Key, numbers: &[f64]) -> Result<()>;

    /// Whether each word of a list is there once.
    ///
    /// # Errors
    /// The first that was there before.
    fn once(&self, at: &str, words: &[&str]) -> Result<()>;

    /// Whether a text may be a name.
    ///
    /// # Errors
    /// A text with control characters.
    fn name(&self, at: &str, text: &str) -> Result<()>;
}

/// The default of a key that must be there.
pub const REQUIRED: &str = "required";

/// A key as people read about it.
#[derive(Debug, Clone)]
pub struct Row {
    /// Its name; with dots where it stands in a table inside of the section.
    pub name: String,
    /// Its type in words.
    pub kind: String,
    /// Unit of plain numbers; "" for none.
    pub unit: &'static str,
    /// The numbers that it takes, in words.
    pub range: String,
    /// What holds without it, in words.
    pub default: String,
    /// What it means.
    pub doc: String,
    /// A value in TOML; "" for a table.
    pub example: String,
    /// The table that is its value, if it is one.
    pub(crate) table: Option<TableShape>,
}

impl Row {
    /// Whether the table cannot do without it.
    pub fn is_required(&self) -> bool {
        self.default == REQUIRED
    }
}

impl From<&Key> for Row {
    fn from(key: &Key) -> Row {
        Row {
            name: key.name.to_owned(),
            kind: if key.range == Range::File { "file".to_owned() } else { (key.kind)() },
            unit: key.unit,
            range: key.range.to_string(),
            // Rust wants 1.0 where people write 1.
            default: key
                .default
                .strip_suffix(".0")
                .unwrap_or(key.default)
                .replace(".0,", ",")
                .replace(".0]", "]"),
            doc: key.doc.trim().trim_end_matches('.').to_owned(),
            example: key.example.to_owned(),
            table: (key.table)(),
        }
    }
}

/// What a table looks like from outside.
#[derive(Debug, Clone)]
pub struct TableShape {
    /// Name of its struct: one shape may stand at several places.
    pub name: &'static str,
    /// Whether people read about it in a separate section; otherwise with the key that holds it.
    pub section: bool,
    /// It in TOML, with the keys that it must have, or the first one.
    pub example: String,
    /// Its keys.
    pub rows: Vec<Row>,
}

/// A table of a scene, as [`table!`] declares it.
pub trait Table: Sized {
    /// Name of the struct.
    const NAME: &'static str;
    /// Whether it has a separate section.
    const SECTION: bool;
    /// Its keys.
    const KEYS: &'static [Key];
    /// Their names.
    const NAMES: &'static [&'static str];

    /// Reads it.
    ///
    /// # Errors
    /// Unknown and missing keys, values of another type.
    fn read_keys<'de, A: MapAccess<'de>>(map: A) -> Result<Self, A::Error>;

    /// Checks the range of each value; `at` is the dotted key of the table, "" for the scene.
    ///
    /// # Errors
    /// The first value out of its range.
    fn check_keys(&self, judge: &dyn Judge, at: &str) -> Result<()>;
}

impl<T: Table> KeyValue for T {
    fn kind() -> String {
        "table".to_owned()
    }

    fn table() -> Option<TableShape> {
        let rows = T::KEYS.iter().map(Row::from).collect();
        Some(TableShape { name: T::NAME, section: T::SECTION, example: example(T::KEYS), rows })
    }

    fn read<'de, D: Deserializer<'de>>(_: KeyUnit, from: D) -> Result<T, D::Error> {
        from.deserialize_map(TableVisitor(PhantomData))
    }

    fn check(&self, judge: &dyn Judge, at: &str, _: &Key) -> Result<()> {
        self.check_keys(judge, at)
    }
}

/// A table in TOML that has these keys, with those that it must have, or the first one.
pub(super) fn example(keys: &[Key]) -> String {
    let shown = |key: &Key| match ((key.table)(), key.example) {
        (Some(table), "") => Some(format!("{} = {}", key.name, table.example)),
        (_, "") => None,
        (_, value) => Some(format!("{} = {value}", key.name)),
    };
    let required: Vec<String> = keys.iter().filter(|key| key.default == REQUIRED).filter_map(shown).collect();
    match required.is_empty() {
        true => format!("{{ {} }}", keys.iter().find_map(shown).unwrap_or_default()),
        false => format!("{{ {} }}", required.join(", ")),
    }
}

pub(super) struct TableVisitor<T>(pub PhantomData<T>);

impl<'de, T: Table> Visitor<'de> for TableVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "a table, such as {}", example(T::KEYS))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<T, A::Error> {
        T::read_keys(map)
    }
}

/// A key that is one of these.
pub(super) struct OneOf(pub &'static [&'static str]);

impl<'de> DeserializeSeed<'de> for OneOf {
    type Value = &'static str;

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<&'static str, D::Error> {
        from.deserialize_identifier(self)
    }
}

impl Visitor<'_> for OneOf {
    type Value = &'static str;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a key")
    }

    fn visit_str<E: Error>(self, key: &str) -> Result<&'static str, E> {
        self.0.iter().find(|k| **k == key).copied().ok_or_else(|| E::unknown_field(key, self.0))
    }
}

/// The dotted key of a key in the table at `at`.
pub(super) fn dotted(at: &str, name: &str) -> String {
    if at.is_empty() { name.to_owned() } else { format!("{at}.{name}") }
}

/// Declares a table. A row is `/// meaning`, then `field: Type = default, unit, range, example;` where the default is `required`,
/// `default(VALUE)`, or `absent("in words")` for that of the type; `field as "key"` where the key is a word of Rust.
macro_rules! table {
    (
        $(#[$about:meta])*
        $name:ident $place:ident { $(
            $(#[doc = $doc:literal])+
            $field:ident $(as $key:literal)?: $type:ty =
                $how:ident $(($default:expr))?, $unit:literal, $range:ident $(($($limit:expr),*))?, $example:literal;
        )* }
    ) => {
        $(#[$about])*
        #[derive(Debug, Clone, PartialEq)]
        pub struct $name { $($(#[doc = $doc])+ pub $field: $type,)* }

        impl $crate::keys::table::Table for $name {
            const NAME: &'static str = stringify!($name);
            const SECTION: bool = table!(@section $place);
            const NAMES: &'static [&'static str] = &[$(table!(@key $field $($key)?)),*];
            const KEYS: &'static [$crate::keys::table::Key] = &[$($crate::keys::table::Key {
                name: table!(@key $field $($key)?),
                kind: <$type as $crate::keys::value::KeyValue>::kind,
                unit: $unit,
                default: table!(@shown $how $(($default))?),
                range: $crate::keys::table::Range::$range $(($($limit),*))?,
                doc: concat!($($doc),+),
                example: $example,
                table: <$type as $crate::keys::value::KeyValue>::table,
            }),*];

            fn read_keys<'de, A: serde::de::MapAccess<'de>>(mut map: A) -> std::result::Result<Self, A::Error> {
                $(let mut $field: Option<$type> = None;)*
                while let Some(key) = map.next_key_seed($crate::keys::table::OneOf(Self::NAMES))? {
                    $(if key == table!(@key $field $($key)?) {
                        let unit = $crate::keys::value::KeyUnit::of_key($unit, $example);
                        $field = Some(map.next_value_seed($crate::keys::value::In::<$type>::new(unit))?);
                        continue;
                    })*
                }
                Ok($name { $($field: match $field {
                    Some(value) => value,
                    None => table!(@else $type, table!(@key $field $($key)?), $how $(($default))?),
                },)* })
            }

            fn check_keys(&self, judge: &dyn $crate::keys::table::Judge, at: &str) -> $crate::error::Result<()> {
                // One for each field, in the same order.
                let mut keys = Self::KEYS.iter();
                $(if let Some(key) = keys.next() {
                    let at = $crate::keys::table::dotted(at, key.name);
                    $crate::keys::value::KeyValue::check(&self.$field, judge, &at, key)?;
                })*
                Ok(())
            }
        }
    };
    (@section section) => { true };
    (@section inline) => { false };
    (@key $field:ident) => { stringify!($field) };
    (@key $field:ident $key:literal) => { $key };
    (@shown required) => { $crate::keys::table::REQUIRED };
    (@shown default($value:expr)) => { stringify!($value) };
    (@shown absent($words:expr)) => { $words };
    (@else $type:ty, $key:expr, required) => { return Err(serde::de::Error::missing_field($key)) };
    (@else $type:ty, $key:expr, default($value:expr)) => { $value };
    (@else $type:ty, $key:expr, absent($words:expr)) => { <$type>::default() };
}

pub(super) use table;

/// Declares an enum whose variants are words of a scene: `/// meaning`, then `Variant "word"`.
macro_rules! words {
    (
        $(#[$about:meta])*
        $name:ident { $($(#[$of:meta])* $variant:ident $word:literal,)* }
    ) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $name { $($(#[$of])* $variant,)* }

        impl $name {
            /// All of them.
            pub const ALL: &'static [$name] = &[$($name::$variant),*];

            /// Its word in scenes.
            pub fn name(self) -> &'static str {
                match self { $($name::$variant => $word,)* }
            }
        }

        $crate::keys::value::word_values! { $name }
    };
}

pub(super) use words;
