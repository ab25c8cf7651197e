//! Puts the values of `--set` into a document; comments and order stay.

use toml_edit::{Item, Table, TableLike, Value};

/// A TOML value, or the text itself: `contact.0.law=hooke` needs no quotes that a shell would eat.
pub(super) fn value(text: &str) -> Value {
    text.parse::<Value>().unwrap_or_else(|_| Value::from(text))
}

/// Puts `value` at the path, making tables that are missing.
pub(super) fn put(table: &mut dyn TableLike, path: &[&str], value: Value) -> Result<(), String> {
    let (first, rest) = (path[0], &path[1..]);
    if first.is_empty() {
        return Err("a part of the key is empty".into());
    }
    if rest.is_empty() {
        table.insert(first, Item::Value(value));
        return Ok(());
    }
    if table.get(first).is_none() {
        if rest[0].parse::<usize>().is_ok() {
            return Err(format!("the scene has no list '{first}'"));
        }
        table.insert(first, Item::Table(Table::new()));
    }
    match table.get_mut(first) {
        Some(item) => put_into(item, first, rest, value),
        None => Err(format!("'{first}' cannot be added")),
    }
}

fn put_into(item: &mut Item, name: &str, path: &[&str], value: Value) -> Result<(), String> {
    let (first, rest) = (path[0], &path[1..]);
    let Ok(index) = first.parse::<usize>() else {
        let table = item.as_table_like_mut();
        return put(table.ok_or(format!("'{name}' is not a table that could hold '{first}'"))?, path, value);
    };
    if let Some(list) = item.as_array_of_tables_mut() {
        let last = list.len().saturating_sub(1);
        let table = list.get_mut(index).ok_or(format!("'{name}' has entries 0 to {last}, no {index}"))?;
        return match rest {
            [] => Err(format!("'{name}.{index}' is a table: name one of its keys")),
            [..] => put(table, rest, value),
        };
    }
    match item.as_value_mut() {
        Some(list) => put_into_list(list, name, (index, rest), value),
        None => Err(no_list(name, index)),
    }
}

/// Puts `value` into the entry of a list, or into a list or a table in it.
fn put_into_list(
    list: &mut Value,
    name: &str,
    (index, path): (usize, &[&str]),
    value: Value,
) -> Result<(), String> {
    let list = list.as_array_mut().ok_or_else(|| no_list(name, index))?;
    let len = list.len();
    let slot = list.get_mut(index).ok_or_else(|| {
        let entries = if len == 1 { "entry" } else { "entries" };
        format!("'{name}' has {len} {entries}, no {index}")
    })?;
    let entry = format!("{name}.{index}");
    match path {
        [] => {
            *slot = value;
            Ok(())
        }
        [first, rest @ ..] => match first.parse() {
            Ok(index) => put_into_list(slot, &entry, (index, rest), value),
            Err(_) => match slot.as_inline_table_mut() {
                Some(table) => put(table, path, value),
                None => Err(format!("'{entry}' is not a table that could hold '{first}'")),
            },
        },
    }
}

/// Why a value has no entry of this number.
fn no_list(name: &str, index: usize) -> String {
    format!("'{name}' is not a list that could hold entry {index}")
}
