//! `[[contact]]`, whose keys are those of the engine's effects.

use super::table::{OneOf, REQUIRED, Row, TableShape};
use super::value::{In, KeyUnit, KeyValue, Word, begins_as_number, quoted};
use super::whole::whole_as_number;
use dem::effects::{DESCRIPTIONS, Description, Key, NORMAL_DAMPING, RESTITUTION, keys, models};
use dem::setup::ContactLaw;
use serde::de::{self, DeserializeSeed, Deserializer, Error, MapAccess, Unexpected, Visitor};
use std::fmt;
use std::sync::LazyLock;

/// `[[contact]]`
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// Two names of materials; "*" stands for every one.
    pub between: [String; 2],
    /// Models and numbers as the engine has them; its materials are not known yet.
    pub law: ContactLaw,
    /// Speed of impact at which a linear law is as deep as "hertz" [m/s], instead of `stiffness`.
    pub characteristic_velocity: Option<f64>,
}

/// Keys of a `[[contact]]` that are not the engine's.
const BETWEEN: &str = "between";
const CHARACTERISTIC_VELOCITY: &str = "characteristic_velocity";

/// A `[[contact]]` in one line.
const EXAMPLE: &str = "{ between = [\"*\", \"*\"], restitution = 0.5 }";
/// Two materials.
const PAIR: &str = "[\"*\", \"*\"]";

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

/// The keys as people read about them.
fn rows() -> Vec<Row> {
    let text = |name: &str, kind: &str, default: &str, doc: &str, example: &str| Row {
        name: name.to_owned(),
        kind: kind.to_owned(),
        unit: "",
        range: String::new(),
        default: default.to_owned(),
        doc: doc.to_owned(),
        example: example.to_owned(),
        table: None,
    };
    let model = |(key, values): (&str, Vec<&str>)| {
        let default = DESCRIPTIONS.iter().filter_map(|d| d.model).find(|m| m.key == key && m.default);
        let default = default.map_or("none".to_owned(), |m| format!("\"{}\"", m.value));
        let doc = match key {
            "law" => "Normal force: see the effects above",
            "cohesion" => "A pull that is added to the normal force",
            "rolling_model" => "What `rolling_resistance` is: a spring, or a torque of one size",
            _ => "Which model",
        };
        let example = format!("\"{}\"", values.last().copied().unwrap_or_default());
        text(key, &quoted(values.iter().copied()), &default, doc, &example)
    };
    let number = |key: &Key| {
        let table: Vec<String> = table_keys(key.name).map(|(_, short)| format!("`{short}`")).collect();
        let kind = if table.is_empty() {
            "number".to_owned()
        } else {
            format!("number or table of {}", table.join(", "))
        };
        // A table that stands instead of a number has all of its keys.
        let default = if key.name.contains('.') { REQUIRED.to_owned() } else { required_with(key.name) };
        Row { unit: key.unit, range: ranges(key), ..text(key.name, &kind, &default, key.doc, key.example) }
    };
    let between = text(BETWEEN, "2 names", REQUIRED, "Names of two materials; \"*\" stands for any", PAIR);
    let speed = "Instead of `stiffness`: the speed of impact at which two of the largest grains store as much as with \"hertz\"";
    let speed = text(CHARACTERISTIC_VELOCITY, "number", "–", speed, "1");
    let speed = Row { unit: "m/s", range: "above 0".to_owned(), ..speed };
    let mut all: Vec<Row> =
        [between].into_iter().chain(models().into_iter().map(model)).chain(keys().map(number)).collect();
    let at = all.iter().position(|row| row.name == "stiffness").map_or(all.len(), |at| at + 1);
    all.insert(at, speed);
    all
}

/// The range of a number, and those of effects that have another one.
fn ranges(key: &Key) -> String {
    let mut all = key.range.to_string();
    let own = |d: &&Description| d.keys.iter().find(|k| k.name == key.name && k.range != key.range).copied();
    for (effect, other) in DESCRIPTIONS.iter().filter_map(|d| Some((d, own(d)?))) {
        all += &format!(" ({} with \"{}\")", other.range, effect.model.map_or(effect.name, |m| m.value));
    }
    all
}

/// What asks for a number that must be there, in words; "none" where nothing does.
fn required_with(name: &str) -> String {
    let takes = |d: &&&Description| d.keys.iter().any(|k| k.name == name && k.required);
    let model = |d: &&Description| d.model.map(|m| format!("\"{}\"", m.value));
    let mut all: Vec<String> = DESCRIPTIONS.iter().filter(takes).filter_map(model).collect();
    all.dedup();
    if all.is_empty() { "none".to_owned() } else { format!("required with {}", all.join(", ")) }
}

/// Reads a number, or text with a unit.
fn number(unit: &'static str) -> In<f64> {
    In::new(KeyUnit::of(unit))
}

impl KeyValue for Contact {
    fn kind() -> String {
        "table".to_owned()
    }

    fn table() -> Option<TableShape> {
        Some(TableShape { name: "Contact", section: true, example: EXAMPLE.to_owned(), rows: rows() })
    }

    fn read<'de, D: Deserializer<'de>>(_: KeyUnit, from: D) -> Result<Contact, D::Error> {
        from.deserialize_map(ContactVisitor)
    }
}

struct ContactVisitor;

impl<'de> Visitor<'de> for ContactVisitor {
    type Value = Contact;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "a table, such as {EXAMPLE}")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Contact, A::Error> {
        let (mut between, mut characteristic_velocity) = (None, None);
        let mut law = ContactLaw::new((0, 0), "hertz");
        while let Some(key) = map.next_key_seed(OneOf(&KEYS))? {
            if key == BETWEEN {
                between = Some(map.next_value_seed(In::<[String; 2]>::new(KeyUnit::of_key("", PAIR)))?);
            } else if key == CHARACTERISTIC_VELOCITY {
                characteristic_velocity = Some(map.next_value_seed(number("m/s"))?);
            } else if let Some((key, values)) = models().into_iter().find(|m| m.0 == key) {
                law.choose(key, map.next_value_seed(Word(values))?);
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

    whole_as_number! { () }

    fn visit_str<E: Error>(self, text: &str) -> Result<(), E> {
        if !begins_as_number(text) {
            return Err(E::invalid_type(Unexpected::Str(text), &self));
        }
        let value = KeyUnit::of(unit_of(self.key)).parse(text)?;
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
