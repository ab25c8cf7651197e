//! The text of a recipe: places, and errors in plain words.

use super::keys::{Number, RecipeKeys};
use crate::error::{CalibrateError, Location, Result, hint};
use std::ops::Range;

/// A recipe's text and its name.
pub(super) struct Text<'a> {
    pub name: &'a str,
    pub toml: &'a str,
}

impl Text<'_> {
    pub fn place(&self, start: Option<usize>) -> Location {
        let at = start.map(|start| {
            let before = self.toml.get(..start).unwrap_or_default();
            let line = before.matches('\n').count() + 1;
            (line, before.chars().rev().take_while(|c| *c != '\n').count() + 1)
        });
        Location { file: self.name.to_owned(), at }
    }

    /// An error at a span.
    pub fn refuse(&self, span: &Range<usize>, message: impl Into<String>) -> CalibrateError {
        CalibrateError::Recipe { place: self.place(Some(span.start)), message: message.into() }
    }

    pub fn parse(&self) -> Result<RecipeKeys> {
        toml::from_str(self.toml).map_err(|error| self.refused(&error))
    }

    fn refused(&self, error: &toml::de::Error) -> CalibrateError {
        let (span, message) = (error.span(), error.message().trim());
        let unknown = message.strip_prefix("unknown field `");
        let split = |rest: &'_ str| -> Option<(String, String)> {
            rest.rsplit_once("`, expected ")
                .or(rest.rsplit_once("`, there are "))
                .map(|(a, b)| (a.to_owned(), b.to_owned()))
        };
        let message = match unknown.and_then(split) {
            Some((key, known)) => {
                let known: Vec<&str> = known.split('`').skip(1).step_by(2).collect();
                format!("unknown key '{key}'{}", hint(&key, known.iter().copied()))
            }
            None if message.starts_with("duplicate key") && self.line(span.as_ref()).starts_with('[') => {
                SEVERAL.to_owned()
            }
            None => plain(message),
        };
        CalibrateError::Recipe { place: self.place(span.map(|s| s.start)), message }
    }

    /// The line of a span.
    fn line(&self, span: Option<&Range<usize>>) -> &str {
        let start = span.map_or(0, |s| s.start);
        let begin = self.toml.get(..start).and_then(|t| t.rfind('\n')).map_or(0, |k| k + 1);
        self.toml.get(begin..).and_then(|t| t.lines().next()).unwrap_or_default()
    }

    /// A number in `unit`; text is converted. `unit` is the text of the recipe, "" for none.
    pub fn number(&self, number: &Number, unit: &str, span: &Range<usize>, key: &str) -> Result<f64> {
        let value = match number {
            Number::Whole(v) => *v as f64,
            Number::Plain(v) => *v,
            Number::Text(text) => {
                let end = text
                    .trim()
                    .find(|c: char| c.is_alphabetic() && c != 'e' && c != 'E' || c == '%' || c == '°');
                let (digits, own) = text.trim().split_at(end.unwrap_or(text.trim().len()));
                let value: f64 = digits.trim().parse().map_err(|_| {
                    self.refuse(
                        span,
                        format!(
                            "{key} = \"{text}\": has no number in front: write a number, or text with a unit"
                        ),
                    )
                })?;
                let to = if unit.is_empty() || unit == "–" || unit == "-" { "1" } else { unit };
                let own = if own.is_empty() { to } else { own };
                let ratio = geom::units::ratio(own, to).ok_or_else(|| {
                    let known = if geom::units::in_si(own).is_some() {
                        "has another dimension than"
                    } else {
                        "is not known; expected"
                    };
                    self.refuse(span, format!("{key} = \"{text}\": the unit '{own}' {known} '{to}'"))
                })?;
                value * ratio
            }
        };
        match value.is_finite() && value.abs() < 1e100 {
            true => Ok(value),
            false => Err(self.refuse(span, format!("{key} = {value}: give a finite number"))),
        }
    }
}

const SEVERAL: &str = "this table is one of a list: write it with two brackets, such as [[parameter]]";

/// The parser's message in plain words.
fn plain(message: &str) -> String {
    let shown: String = message.chars().take(400).collect();
    let text = shown.replace('`', "'").replace("invalid type: ", "wrong kind of value: ");
    if let Some(key) = text.strip_prefix("missing field '").and_then(|rest| rest.strip_suffix('\'')) {
        let example = match key {
            "name" => "name = \"friction\"",
            "command" => "command = \"model {friction} --seed {seed}\"",
            "fit" => "fit = [\"friction\"], or fit = \"all\"",
            "test" => "test = \"the name of a [[test]]\"",
            other => other,
        };
        return format!("'{key}' is missing: add it, such as {example}");
    }
    if text.contains("map, expected a sequence") {
        return SEVERAL.to_owned();
    }
    text.replace("unknown variant", "unknown word").replace("i64", "a whole number").replace(
        "data did not match any variant of untagged enum PartKeys",
        "expected the name of a test, or { test = …, from = …, until = … }",
    )
}
