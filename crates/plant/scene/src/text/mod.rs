//! The text of a scene: places of keys in it, the changes of `--set`, and reading it into keys.
//!
//! [`Text`] keeps what was written, so that every error names file, line and column, also after `--set` changed the text. Uses the keys
//! and the errors; knows nothing of what values mean.

mod missing;
mod overrides;
mod parse;
mod rebase;

pub(crate) use parse::{parse, parse_made};
pub use rebase::rebase;

use crate::error::{Place, Result, SceneError};
use overrides::put;
use toml_edit::{DocumentMut, Item};

/// Names in a dotted key, at most: `wall.0.motion.rotate.about.0` has six, and there is room for keys to come.
const DEEPEST: usize = 12;
/// Options of tools that change a key, and the key: `--until=0.5` is an override, too.
const OPTIONS: [(&str, &str); 1] = [("--until", "time.until")];
/// Characters of an override that a message shows.
const SHOWN: usize = 120;

/// The beginning of a long text.
fn short(text: &str) -> String {
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// Key and value of an override.
fn split(text: &str) -> Option<(&str, &str)> {
    let (given, value) = text.split_once('=')?;
    let given = given.trim();
    let option = OPTIONS.iter().find(|(option, _)| *option == given);
    Some((option.map_or(given, |(_, key)| key), value.trim()))
}

/// A scene as it was written, with the name of its file for messages.
#[derive(Debug, Clone)]
pub struct Text {
    /// The file, or `-`.
    pub name: String,
    /// Its text, with the changes of `--set`.
    pub toml: String,
    /// Its text before the changes, where there are any: what the reader sees.
    before: Option<String>,
    /// The changes.
    overrides: Vec<String>,
}

impl Text {
    /// A scene's text under the name of its file.
    pub fn new(name: &str, toml: String) -> Text {
        Text { name: name.to_owned(), toml, before: None, overrides: Vec::new() }
    }

    /// Changes values: each override is `KEY=VALUE`, the key dotted with indices for lists
    /// (`contact.0.restitution=0.3`), or an option that stands for a key (`--until=0.5`), as messages name it. Comments and order stay.
    ///
    /// # Errors
    /// A text without `=`, a key that leads nowhere.
    pub fn set(&mut self, overrides: &[String]) -> Result<()> {
        if overrides.is_empty() {
            return Ok(());
        }
        let mut document = self.document()?;
        for text in overrides {
            let refuse = |why: String| SceneError::Override { text: short(text), why };
            let Some((key, value)) = split(text) else {
                return Err(refuse("'=' is missing: use KEY=VALUE, such as time.until=0.5".into()));
            };
            let path: Vec<&str> = key.split('.').collect();
            if path.len() > DEEPEST {
                let why = format!("has {} names: a key of a scene has at most {DEEPEST}", path.len());
                return Err(refuse(why));
            }
            put(document.as_table_mut(), &path, overrides::value(value)).map_err(refuse)?;
        }
        self.before = Some(std::mem::replace(&mut self.toml, document.to_string()));
        self.overrides = overrides.to_vec();
        Ok(())
    }

    /// Another scene that a program has made from this one, with its keys at the same places in their lists: errors name places in this file.
    pub fn made_into(&self, toml: String) -> Text {
        let before = self.before.clone().unwrap_or_else(|| self.toml.clone());
        Text { name: self.name.clone(), toml, before: Some(before), overrides: self.overrides.clone() }
    }

    /// The override that a key's value comes from: of the key itself, or of a key above or below it.
    pub(crate) fn set_by(&self, key: &str) -> Option<&str> {
        let leads = |to: &str, key: &str| {
            key.strip_prefix(to).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        let names = |text: &&String| {
            let to = split(text).map_or("", |(key, _)| key);
            // An error of a whole entry may have another cause than the key that was changed in it.
            leads(to, key) || (leads(key, to) && !key.ends_with(|c: char| c.is_ascii_digit()))
        };
        self.overrides.iter().rev().find(names).map(String::as_str)
    }

    /// The place of an error that the changes cause: the reader sees only the file.
    pub(crate) fn changes(&self, overrides: &[&str]) -> Place {
        let option = |text: &&str| if text.starts_with("--") { "" } else { "--set " };
        let list: String = overrides.iter().map(|text| format!(" {}{}", option(text), short(text))).collect();
        Place { file: format!("{} with{list}", self.name), at: None }
    }

    /// The text as a document that can be edited.
    ///
    /// # Errors
    /// Text that is not TOML.
    pub fn document(&self) -> Result<DocumentMut> {
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
        if let Some(before) = &self.before {
            return Text::new(&self.name, before.clone()).place(key);
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
