//! Blanks of the commands that are no parameters: each step may fill them in its own way, such as with the number of grains of its specimens.

use super::check::OWN_BLANKS;
use super::keys::{Number, RecipeKeys, SettingsKeys, StepKeys};
use super::text::Text;
use super::{Parameter, Test, blanks};
use crate::error::Result;
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;

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

/// What the blanks of a step's commands stand for: its own values, then those of the settings; `tests` are those that it fits to, and its place is named
/// by `span`.
pub(super) fn of_step<'a>(
    text: &Text,
    settings: &SettingsKeys,
    step: Option<&StepKeys>,
    tests: impl Iterator<Item = &'a Test> + Clone,
    (names, span): (&[&str], Range<usize>),
) -> Result<BTreeMap<String, String>> {
    let mut all = BTreeMap::new();
    for with in settings.with.iter().chain(step.and_then(|s| s.with.as_ref())) {
        for (name, value) in with.get_ref() {
            all.insert(name.clone(), shown(text, with, name, value)?);
        }
    }
    let uses = |name: &str| tests.clone().any(|t| blanks::names(&t.command).contains(&name));
    let place = step.map_or(String::new(), |s| format!("step '{}': ", s.name));
    let own = step.and_then(|s| s.with.as_ref());
    if let Some((with, name)) = own.and_then(|w| Some((w, w.get_ref().keys().find(|name| !uses(name))?))) {
        let message = format!(
            "{place}with: '{name}' changes nothing: no test that it fits to has the blank {{{name}}}"
        );
        return Err(text.refuse(&with.span(), message));
    }
    for test in tests.clone() {
        let open = |name: &&str| names.contains(name) && !all.contains_key(*name);
        if let Some(name) = blanks::names(&test.command).into_iter().find(open) {
            let message = format!(
                "{place}nothing fills the blank {{{name}}} of test '{}': add with = {{ {name} = … }} to the step, or to [settings] for all steps",
                test.name
            );
            return Err(text.refuse(&span, message));
        }
    }
    Ok(all)
}

/// A value as a command gets it.
fn shown(
    text: &Text,
    with: &Spanned<BTreeMap<String, Number>>,
    name: &str,
    value: &Number,
) -> Result<String> {
    let plain = |t: &str| !t.is_empty() && t.chars().all(|c| c.is_alphanumeric() || "._-+%,:=/".contains(c));
    match value {
        Number::Whole(n) => Ok(n.to_string()),
        Number::Plain(v) if v.is_finite() => Ok(blanks::shown(*v)),
        Number::Plain(v) => Err(text.refuse(&with.span(), format!("with: {name} = {v}: give a finite number"))),
        Number::Text(t) if plain(t) => Ok(t.clone()),
        Number::Text(t) => Err(text.refuse(
            &with.span(),
            format!("with: {name} = \"{t}\": a command gets it as it is: give one word, such as \"0.002\" or \"fine.toml\""),
        )),
    }
}

fn lists(keys: &RecipeKeys) -> impl Iterator<Item = &Spanned<BTreeMap<String, Number>>> {
    let steps = keys.step.iter().filter_map(|s| s.get_ref().with.as_ref());
    keys.settings.with.iter().chain(steps)
}
