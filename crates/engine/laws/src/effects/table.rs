//! The effects as a table for people: docs/reference/scene.md holds it, and a test compares.

use super::{DESCRIPTIONS, Description};
use alloc::borrow::ToOwned;
use alloc::string::String;
use alloc::vec::Vec;
use alloc::{format, vec};
use core::fmt::Write;

/// The table in Markdown: a row for each effect.
pub fn table() -> String {
    let mut out = String::from("| effect | asked for by | what it does | history [B] |\n|---|---|---|---|\n");
    for effect in DESCRIPTIONS {
        let bytes = size_of::<f64>() * effect.columns();
        // Writing to a string does not fail.
        let _ = writeln!(out, "| {} | {} | {} | {bytes} |", effect.name, asked_by(effect), what(effect));
    }
    out
}

fn asked_by(effect: &Description) -> String {
    let model = effect.model.map(|m| format!("`{} = \"{}\"`", m.key, m.value));
    // A normal law is chosen by its name, and a default model by its number.
    let numbers =
        effect.keys.iter().filter(|_| effect.normal.is_none() && effect.model.is_none_or(|m| m.default));
    let numbers = numbers.map(|key| format!("`{}`", key.name));
    model
        .filter(|_| effect.model.is_some_and(|m| !m.default || effect.normal.is_some()))
        .into_iter()
        .chain(numbers)
        .collect::<Vec<_>>()
        .join(", ")
}

fn what(effect: &Description) -> String {
    let kept = effect.history.iter().map(|field| format!("keeps {} [{}]", field.doc, field.unit));
    let needs = effect.needs.map(|slot| format!("needs `{}`", slot.key()));
    let precision = (!effect.every_precision).then(|| "double precision only".to_owned());
    let more: Vec<String> = kept.chain(needs).chain(precision).collect();
    [vec![effect.doc.to_owned()], more].concat().join("; ")
}
