//! How a `[[contact]]` is read: its keys are those of the engine's effects.

use super::Contact;
use super::unit::{self, Seed};
use dem::effects::{NORMAL_DAMPING, RESTITUTION, keys, models};
use dem::setup::ContactLaw;
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, Unexpected, Visitor};
use serde::{Deserialize, de};
use std::fmt;
use std::marker::PhantomData;
use std::sync::LazyLock;

/// Keys of a `[[contact]]` that are not the engine's.
const BETWEEN: &str = "between";
const CHARACTERISTIC_VELOCITY: &str = "characteristic_velocity";

/// Every key of a `[[contact]]`, in the order of the effects.
static KEYS: LazyLock<Vec<&'static str>> = LazyLock::new(|| {
    let mut all = vec![BETWEEN, CHARACTERISTIC_VELOCITY];
    let named = models().into_iter().map(|(key, _)| key);
    for key in named.chain(keys().map(|key| key.name.split('.').next().unwrap_or_default())) {
        if !all.contains(&key) {
            all.push(key);
        }
    }
    all
});

/// Keys of the table that a key may have instead of a number, such as `static` of `sliding_friction.static`.
fn table_keys(key: &str) -> impl Iterator<Item = (&'static str, &'static str)> {
    keys().filter_map(move |k| Some((k.name, k.name.strip_prefix(key)?.strip_prefix('.')?)))
}

/// The unit of a key of the engine.
fn unit_of(key: &str) -> &'static str {
    keys().find(|k| k.name == key).map_or("", |k| k.unit)
}

/// Reads a number, or text with a unit.
fn number(unit: &'static str) -> Seed<f64> {
    Seed(unit::of(unit), PhantomData)
}

impl<'de> Deserialize<'de> for Contact {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Contact, D::Error> {
        from.deserialize_map(ContactVisitor)
    }
}

struct ContactVisitor;

impl<'de> Visitor<'de> for ContactVisitor {
    type Value = Contact;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("struct Contact")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Contact, A::Error> {
        let (mut between, mut characteristic_velocity) = (None, None);
        let mut law = ContactLaw::new((0, 0), "hertz");
        while let Some(key) = map.next_key_seed(OneOf(&KEYS))? {
            if key == BETWEEN {
                between = Some(map.next_value()?);
            } else if key == CHARACTERISTIC_VELOCITY {
                characteristic_velocity = Some(map.next_value_seed(number("m/s"))?);
            } else if let Some((key, values)) = models().into_iter().find(|m| m.0 == key) {
                law.choose(key, map.next_value_seed(Named(values))?);
            } else {
                map.next_value_seed(Numbers { key, law: &mut law })?;
            }
        }
        let between = between.ok_or_else(|| Error::missing_field(BETWEEN))?;
        if [RESTITUTION, NORMAL_DAMPING].iter().all(|key| law.number(key.name).is_none()) {
            return Err(Error::missing_field(RESTITUTION.name));
        }
        Ok(Contact { between, law, characteristic_velocity })
    }
}

/// A key that is one of these.
struct OneOf(&'static [&'static str]);

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

/// A model that is one of these.
struct Named(Vec<&'static str>);

impl<'de> DeserializeSeed<'de> for Named {
    type Value = &'static str;

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<&'static str, D::Error> {
        from.deserialize_any(self)
    }
}

impl Visitor<'_> for Named {
    type Value = &'static str;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "one of \"{}\"", self.0.join("\", \""))
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<&'static str, E> {
        let known = self.0.iter().find(|k| **k == name).copied();
        known.ok_or_else(|| {
            let all = self.0.iter().map(|k| format!("`{k}`")).collect::<Vec<_>>().join(", ");
            E::custom(format_args!("unknown variant `{name}`, expected one of {all}"))
        })
    }
}

/// A number, or a table of numbers where some effect takes one.
struct Numbers<'a> {
    key: &'static str,
    law: &'a mut ContactLaw,
}

impl<'de> DeserializeSeed<'de> for Numbers<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<(), D::Error> {
        if table_keys(self.key).next().is_some() {
            return from.deserialize_any(self);
        }
        self.law.set(self.key, number(unit_of(self.key)).deserialize(from)?);
        Ok(())
    }
}

impl<'de> Visitor<'de> for Numbers<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let of = |(name, short): (&str, &str)| {
            let example = keys().find(|k| k.name == name).map_or("", |k| k.example);
            format!("{short} = {example}")
        };
        let table = table_keys(self.key).map(of).collect::<Vec<_>>().join(", ");
        write!(f, "a number, such as 0.5, or {{ {table} }}")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<(), E> {
        self.law.set(self.key, value);
        Ok(())
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<(), E> {
        self.visit_f64(value as f64)
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<(), E> {
        if !unit::begins_as_number(text) {
            return Err(E::invalid_type(Unexpected::Str(text), &self));
        }
        let value = unit::of(unit_of(self.key)).parse(text)?;
        self.visit_f64(value)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        // One list for each key that takes a table lasts as long as the program: there are few.
        static TABLE: LazyLock<Vec<(&str, Vec<&str>)>> = LazyLock::new(|| {
            KEYS.iter().map(|key| (*key, table_keys(key).map(|(_, short)| short).collect())).collect()
        });
        let known = TABLE.iter().find(|t| t.0 == self.key).map_or(&[][..], |t| &t.1[..]);
        while let Some(short) = map.next_key_seed(OneOf(known))? {
            let full = table_keys(self.key).find(|k| k.1 == short);
            let unit = full.map_or("", |(full, _)| unit_of(full));
            let value: f64 = map.next_value_seed(number(unit))?;
            full.into_iter().for_each(|(full, _)| self.law.set(full, value));
        }
        let missing = table_keys(self.key).find(|(full, _)| self.law.number(full).is_none());
        missing.map_or(Ok(()), |(_, short)| Err(de::Error::missing_field(short)))
    }
}
