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
    let list = item.as_array_mut().ok_or(format!("'{name}' is not a list that could hold entry {index}"))?;
    let len = list.len();
    let slot = list.get_mut(index).ok_or(format!("'{name}' has {len} entries, no {index}"))?;
    match rest {
        [] => *slot = value,
        [..] => {
            let table = slot.as_inline_table_mut();
            put(table.ok_or(format!("'{name}.{index}' is not a table"))?, rest, value)?;
        }
    }
    Ok(())
}
