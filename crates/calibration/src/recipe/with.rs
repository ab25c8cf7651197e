//! Blanks of the commands that are no parameters: each step may fill them in its own way, such as with the number of grains of its specimens.

use super::check::OWN_BLANKS;
use super::keys::{Number, RecipeKeys, SettingsKeys, StepKeys};
use super::text::Text;
use super::{Parameter, Test, blanks};
use crate::error::Result;
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;

type With = Option<Spanned<BTreeMap<String, Number>>>;

/// The names that any `with` fills.
///
/// # Errors
/// A name that cannot be a blank, or that stands for something else.
pub(super) fn names<'a>(text: &Text, keys: &'a RecipeKeys, parameters: &[Parameter]) -> Result<Vec<&'a str>> {
    let mut found = Vec::new();
    for with in lists(keys) {
        for name in with.get_ref().keys() {
            if !blanks::is_word(name) || OWN_BLANKS.contains(&name.as_str()) {
                let message = format!(
                    "with: '{name}': give a word of letters, digits, '.', '_' and '-', other than seed and here"
                );
                return Err(text.refuse(&with.span(), message));
            }
            if parameters.iter().any(|p| p.name == *name) {
                let message = format!(
                    "with: '{name}' is a parameter: a step that does not fit it holds it (start = …); leave it out"
                );
                return Err(text.refuse(&with.span(), message));
            }
            found.push(name.as_str());
        }
    }
    Ok(found)
}

/// Refuses values that no command gets.
pub(super) fn refuse_unused(text: &Text, keys: &RecipeKeys, tests: &[Test]) -> Result<()> {
    let unused = |name: &&String| !tests.iter().any(|t| blanks::names(&t.command).contains(&name.as_str()));
    for with in lists(keys) {
        if let Some(name) = with.get_ref().keys().find(unused) {
            let message = format!("with: '{name}' changes nothing: no command has the blank {{{name}}}");
            return Err(text.refuse(&with.span(), message));
        }
    }
    let Some(settings) = keys.settings.with.as_ref().filter(|_| !keys.step.is_empty()) else { return Ok(()) };
    let own = |step: &Spanned<StepKeys>, name: &str| {
        step.get_ref().with.as_ref().is_some_and(|w| w.get_ref().contains_key(name))
    };
    match settings.get_ref().keys().find(|name| keys.step.iter().all(|step| own(step, name))) {
        None => Ok(()),
        Some(name) => {
            let message = format!("with: '{name}' changes nothing: every step gives its own; leave it out");
            Err(text.refuse(&settings.span(), message))
        }
    }
}

/// What the blanks stand for in a step: its own values, then those of the settings; `tests` are those that it runs, and its place is named by `span`.
pub(super) fn of_step<'a>(
    text: &Text,
    settings: &SettingsKeys,
    step: Option<&StepKeys>,
    tests: impl Iterator<Item = &'a Test>,
    (names, span): (&[&str], Range<usize>),
) -> Result<BTreeMap<String, String>> {
    let list = |with: &With| -> Vec<(String, String)> {
        with.iter().flat_map(|w| w.get_ref()).map(|(name, value)| (name.clone(), shown(value))).collect()
    };
    let mut all: BTreeMap<String, String> = list(&settings.with).into_iter().collect();
    all.extend(step.map_or(Vec::new(), |s| list(&s.with)));
    for test in tests {
        let open = |name: &&str| names.contains(name) && !all.contains_key(*name);
        if let Some(name) = blanks::names(&test.command).into_iter().find(open) {
            let place = step.map_or(String::new(), |s| format!("step '{}': ", s.name));
            let message = format!(
                "{place}nothing fills the blank {{{name}}} of test '{}': add with = {{ {name} = … }} to the step, or to [settings] for all steps",
                test.name
            );
            return Err(text.refuse(&span, message));
        }
    }
    Ok(all)
}

fn shown(value: &Number) -> String {
    match value {
        Number::Whole(n) => n.to_string(),
        Number::Plain(v) => blanks::shown(*v),
        Number::Text(t) => t.clone(),
    }
}

fn lists(keys: &RecipeKeys) -> impl Iterator<Item = &Spanned<BTreeMap<String, Number>>> {
    let steps = keys.step.iter().filter_map(|s| s.get_ref().with.as_ref());
    keys.settings.with.iter().chain(steps)
}
