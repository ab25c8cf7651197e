//! The text of a scene: places of keys in it, and the changes of `--set`.

use crate::error::{Place, SceneError};
use toml_edit::{DocumentMut, Item, Table, TableLike, Value};

/// A scene as it was written, with the name of its file for messages.
#[derive(Debug, Clone)]
pub struct Text {
    /// The file, or `-`.
    pub name: String,
    /// What it holds.
    pub toml: String,
    /// What it held before it was changed, and the changes.
    changed: Option<(String, Vec<String>)>,
}

impl Text {
    /// A scene's text under the name of its file.
    pub fn new(name: &str, toml: String) -> Text {
        Text { name: name.to_owned(), toml, changed: None }
    }

    /// Changes values: each override is `KEY=VALUE`, the key dotted with indices for lists
    /// (`contact.0.restitution=0.3`). Comments and order stay.
    ///
    /// # Errors
    /// A text without `=`, a key that leads nowhere.
    pub fn set(&mut self, overrides: &[String]) -> Result<(), SceneError> {
        if overrides.is_empty() {
            return Ok(());
        }
        let mut document = self.document()?;
        for text in overrides {
            let refuse = |why: String| SceneError::Override { text: text.clone(), why };
            let Some((key, value)) = text.split_once('=') else {
                return Err(refuse("'=' is missing: use KEY=VALUE, such as time.until=0.5".into()));
            };
            let path: Vec<&str> = key.trim().split('.').collect();
            put(document.as_table_mut(), &path, parse_value(value.trim())).map_err(refuse)?;
        }
        let written = std::mem::replace(&mut self.toml, document.to_string());
        self.changed = Some((written, overrides.to_vec()));
        Ok(())
    }

    /// The override that a key's value comes from, or that leads to or through it.
    pub(crate) fn set_by(&self, key: &str) -> Option<&str> {
        let leads = |to: &str, key: &str| {
            key.strip_prefix(to).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        let names = |text: &&String| {
            let to = text.split('=').next().unwrap_or_default().trim();
            // Of a whole entry, something else may be wrong than what was changed in it.
            leads(to, key) || (leads(key, to) && !key.ends_with(|c: char| c.is_ascii_digit()))
        };
        self.changed
            .iter()
            .flat_map(|(_, overrides)| overrides.iter().rev().find(names))
            .map(String::as_str)
            .next()
    }

    /// The text before its changes; `None` where there are none.
    pub(crate) fn written(&self) -> Option<Text> {
        self.changed.as_ref().map(|(toml, _)| Text::new(&self.name, toml.clone()))
    }

    /// What a reader has to look at who sees only the file: the changes.
    pub(crate) fn changes(&self, overrides: &[&str]) -> Place {
        let list: String = overrides.iter().map(|text| format!(" --set {text}")).collect();
        Place { file: format!("{} with{list}", self.name), at: None }
    }

    /// The text as a document that can be edited.
    ///
    /// # Errors
    /// Anything that is no TOML.
    pub fn document(&self) -> Result<DocumentMut, SceneError> {
        self.toml.parse::<DocumentMut>().map_err(|e| SceneError::Syntax {
            place: self.at(e.span().map(|s| s.start)),
            message: e.message().trim().to_owned(),
        })
    }

    /// Line and column of a byte.
    pub(crate) fn at(&self, offset: Option<usize>) -> Place {
        let at = offset.map(|offset| {
            let before = &self.toml[..self.toml.floor_char_boundary(offset)];
            let line_start = before.rfind('\n').map_or(0, |i| i + 1);
            (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
        });
        Place { file: self.name.clone(), at }
    }

    /// The line that holds a byte.
    pub(crate) fn line(&self, offset: Option<usize>) -> &str {
        let at = self.toml.floor_char_boundary(offset.unwrap_or(self.toml.len()));
        let (before, after) = self.toml.split_at(at);
        let start = before.rfind('\n').map_or(0, |i| i + 1);
        &self.toml[start..at + after.find('\n').unwrap_or(after.len())]
    }

    /// Where the value of a dotted key stands; its nearest written parent when it is not written.
    pub(crate) fn place(&self, key: &str) -> Place {
        if let Some(text) = self.set_by(key) {
            return self.changes(&[text]);
        }
        if let Some(written) = self.written() {
            return written.place(key);
        }
        let Ok(document) = toml_edit::Document::parse(self.toml.as_str()) else { return self.at(None) };
        let mut item: &Item = document.as_item();
        let mut found = None;
        for part in key.split('.') {
            let next = match part.parse::<usize>() {
                Ok(index) => item.get(index),
                Err(_) => item.get(part),
            };
            let Some(next) = next else { break };
            found = next.span().map(|s| s.start).or(found);
            item = next;
        }
        self.at(found)
    }
}

/// A TOML value, or the text itself: `contact.0.law=hooke` needs no quotes that a shell would eat.
fn parse_value(text: &str) -> Value {
    text.parse::<Value>().unwrap_or_else(|_| Value::from(text))
}

/// Puts `value` at the path, making tables that are missing.
fn put(table: &mut dyn TableLike, path: &[&str], value: Value) -> Result<(), String> {
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
        None => Err(format!("'{first}' cannot be made")),
    }
}

fn put_into(item: &mut Item, name: &str, path: &[&str], value: Value) -> Result<(), String> {
    let Ok(index) = path[0].parse::<usize>() else {
        let table = item.as_table_like_mut();
        return put(table.ok_or(format!("'{name}' is no table that could hold '{}'", path[0]))?, path, value);
    };
    let rest = &path[1..];
    if let Some(list) = item.as_array_of_tables_mut() {
        let len = list.len();
        let table = list.get_mut(index);
        let table =
            table.ok_or(format!("'{name}' has entries 0 to {}, no {index}", len.saturating_sub(1)))?;
        return if rest.is_empty() {
            Err(format!("'{name}.{index}' is a table: name one of its keys"))
        } else {
            put(table, rest, value)
        };
    }
    let list = item.as_array_mut().ok_or(format!("'{name}' is no list that could hold entry {index}"))?;
    let len = list.len();
    let slot = list.get_mut(index).ok_or(format!("'{name}' has {len} entries, no {index}"))?;
    match rest {
        [] => *slot = value,
        [..] => {
            let table = slot.as_inline_table_mut();
            put(table.ok_or(format!("'{name}.{index}' is no table"))?, rest, value)?;
        }
    }
    Ok(())
}
