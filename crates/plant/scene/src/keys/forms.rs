//! Values that may be written in two ways: a share, a word or a truth value, one table or a list of them.

use super::table::{Judge, Key, Table, TableShape, TableVisitor, example};
use super::value::{In, KeyUnit, KeyValue};
use super::whole::whole_as_number;
use super::{Accuracy, EnergyGuard};
use crate::error::Result as Checked;
use dem::setup::CameBack;
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Unexpected, Visitor};
use std::fmt;
use std::marker::PhantomData;
use std::ops::Deref;

impl KeyValue for Accuracy {
    fn kind() -> String {
        "text or number".to_owned()
    }

    fn read<'de, D: Deserializer<'de>>(_: KeyUnit, from: D) -> Result<Accuracy, D::Error> {
        from.deserialize_any(Share)
    }

    fn numbers(&self) -> Vec<f64> {
        vec![self.0]
    }
}

struct Share;

impl Visitor<'_> for Share {
    type Value = Accuracy;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a share such as \"1%\" or 0.01")
    }

    fn visit_f64<E: Error>(self, v: f64) -> Result<Accuracy, E> {
        Ok(Accuracy(v))
    }

    whole_as_number! { Accuracy }

    fn visit_str<E: Error>(self, v: &str) -> Result<Accuracy, E> {
        // Units keep the digits: 0.0000001 % is 1e-9, and its number over 100 is less.
        let share = Some(v.trim()).filter(|v| v.ends_with('%')).and_then(|v| geom::units::parse(v, "").ok());
        share.map(Accuracy).ok_or_else(|| E::invalid_value(Unexpected::Str(v), &self))
    }
}

impl KeyValue for CameBack {
    fn kind() -> String {
        "true/false or \"remove\"".to_owned()
    }

    fn read<'de, D: Deserializer<'de>>(_: KeyUnit, from: D) -> Result<CameBack, D::Error> {
        from.deserialize_any(Back)
    }
}

struct Back;

impl Visitor<'_> for Back {
    type Value = CameBack;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("true, false or \"remove\"")
    }

    fn visit_bool<E: Error>(self, stops: bool) -> Result<CameBack, E> {
        Ok(if stops { CameBack::Stops } else { CameBack::Stays })
    }

    fn visit_str<E: Error>(self, v: &str) -> Result<CameBack, E> {
        match v {
            "remove" => Ok(CameBack::IsRemoved),
            _ => Err(E::invalid_value(Unexpected::Str(v), &self)),
        }
    }
}

impl KeyValue for EnergyGuard {
    fn kind() -> String {
        "number or false".to_owned()
    }

    fn read<'de, D: Deserializer<'de>>(_: KeyUnit, from: D) -> Result<EnergyGuard, D::Error> {
        from.deserialize_any(ShareOrOff)
    }

    fn numbers(&self) -> Vec<f64> {
        match self {
            EnergyGuard::Share(share) => vec![*share],
            EnergyGuard::Off => Vec::new(),
        }
    }
}

struct ShareOrOff;

impl Visitor<'_> for ShareOrOff {
    type Value = EnergyGuard;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a share such as 0.02 or \"2%\", or false")
    }

    fn visit_bool<E: Error>(self, guards: bool) -> Result<EnergyGuard, E> {
        if guards { Err(E::invalid_value(Unexpected::Bool(true), &self)) } else { Ok(EnergyGuard::Off) }
    }

    fn visit_f64<E: Error>(self, v: f64) -> Result<EnergyGuard, E> {
        Ok(EnergyGuard::Share(v))
    }

    whole_as_number! { EnergyGuard }

    fn visit_str<E: Error>(self, v: &str) -> Result<EnergyGuard, E> {
        let share = geom::units::parse(v, "").map(EnergyGuard::Share);
        share.map_err(|_| E::invalid_value(Unexpected::Str(v), &self))
    }
}

/// A table, or a list of tables.
#[derive(Debug, Clone, PartialEq)]
pub struct OneOrMore<T>(pub Vec<T>);

impl<T> OneOrMore<T> {
    /// Each table with its dotted key: that of one table alone has no index.
    pub fn entries<'a>(&'a self, at: &'a str) -> impl Iterator<Item = (String, &'a T)> {
        let alone = self.0.len() == 1;
        self.0
            .iter()
            .enumerate()
            .map(move |(k, table)| (if alone { at.to_owned() } else { format!("{at}.{k}") }, table))
    }
}

impl<T> Deref for OneOrMore<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T: Table> KeyValue for OneOrMore<T> {
    fn kind() -> String {
        "table or list of tables".to_owned()
    }

    fn table() -> Option<TableShape> {
        T::table()
    }

    fn read<'de, D: Deserializer<'de>>(_: KeyUnit, from: D) -> Result<OneOrMore<T>, D::Error> {
        from.deserialize_any(TableOrList(PhantomData)).map(OneOrMore)
    }

    fn check(&self, judge: &dyn Judge, at: &str, _: &Key) -> Checked<()> {
        self.entries(at).try_for_each(|(key, table)| table.check_keys(judge, &key))
    }
}

struct TableOrList<T>(PhantomData<T>);

impl<'de, T: Table> Visitor<'de> for TableOrList<T> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "a table, or a list of tables, such as {}", example(T::KEYS))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Vec<T>, A::Error> {
        TableVisitor(PhantomData).visit_map(map).map(|one| vec![one])
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Vec<T>, A::Error> {
        let mut list = Vec::new();
        while let Some(table) = seq.next_element_seed(In::<T>::new(KeyUnit::of("")))? {
            list.push(table);
        }
        Ok(list)
    }
}
