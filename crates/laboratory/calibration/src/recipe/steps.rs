//! Steps: parameters that are fitted to parts of the curves, while the others are held.

use super::check::whole;
use super::keys::{PartKeys, RecipeKeys, StepKeys};
use super::text::Text;
use super::{Parameter, Test, blanks, with};
use crate::error::{CalibrateError, Result, hint};
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;

/// A part of a test's curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Index of the test.
    pub test: usize,
    /// Where the part begins.
    pub from: f64,
    /// Where it ends.
    pub until: f64,
}

#[derive(Debug, Clone)]
pub struct Step {
    pub name: String,
    /// Indices of the parameters that are fitted.
    pub fit: Vec<usize>,
    /// What they are fitted to.
    pub to: Vec<Part>,
    /// What other blanks of the commands stand for.
    pub with: BTreeMap<String, String>,
    /// The earlier step, of other specimens, whose emulators its own ones correct.
    pub refines: Option<usize>,
    /// Trials that it may take.
    pub trials: usize,
    /// Trials that fill the space, before the others.
    pub first: usize,
    /// Trials that are proposed at once.
    pub batch: usize,
}

/// Most trials of a step.
const MOST: u64 = 100_000;

pub(super) fn steps(
    text: &Text,
    keys: &RecipeKeys,
    parameters: &[Parameter],
    (tests, names): (&[Test], &[&str]),
) -> Result<Vec<Step>> {
    let measured = |test: usize| tests[test].target.is_some();
    let all_tests: Vec<Part> = (0..tests.len()).filter(|k| measured(*k)).map(whole_curve).collect();
    if all_tests.is_empty() {
        let message = "no test has data: give data or value in the recipe, or --data FILE".to_owned();
        return Err(CalibrateError::Recipe { place: text.place(None), message });
    }
    if keys.step.is_empty() {
        let fit = (0..parameters.len()).collect();
        let with = with::of_step(text, &keys.settings, None, tests.iter(), (names, 0..0))?;
        let name = "all".to_owned();
        let [trials, first, batch] = numbers(text, keys, None, (&name, parameters.len()))?;
        let steps = vec![Step { name, fit, to: all_tests, with, refines: None, trials, first, batch }];
        refuse_idle(text, keys, &steps)?;
        return Ok(steps);
    }
    let step = |(k, entry): (usize, &Spanned<StepKeys>)| {
        let key = entry.get_ref();
        let before = &keys.step[..k];
        if before.iter().any(|b| b.get_ref().name == key.name) {
            let message = format!("name = \"{}\": is there twice: give the steps different names", key.name);
            return Err(text.refuse(&entry.span(), message));
        }
        let fit = fit(text, key, parameters)?;
        let to: Vec<Part> = match &key.to {
            None => all_tests.clone(),
            Some(parts) if parts.get_ref().is_empty() => {
                return Err(text.refuse(&parts.span(), "to = []: name a test"));
            }
            Some(parts) => {
                parts.get_ref().iter().map(|p| part(text, &parts.span(), p, tests)).collect::<Result<_>>()?
            }
        };
        let of = |test: &usize| to.iter().any(|p| p.test == *test);
        let runs = (0..tests.len()).filter(of).map(|test| &tests[test]);
        let has =
            |p: usize| runs.clone().any(|t| blanks::names(&t.command).contains(&&parameters[p].name[..]));
        if let Some(&p) = fit.iter().find(|p| !has(**p)) {
            let message = format!(
                "step '{}' fits '{1}', and no test that it fits to has the blank {{{1}}}: add the test to 'to'",
                key.name, parameters[p].name
            );
            return Err(text.refuse(&key.fit.span(), message));
        }
        let with = with::of_step(text, &keys.settings, Some(key), runs, (names, entry.span()))?;
        let refines = key.refines.as_ref().map(|name| earlier(text, name, before)).transpose()?;
        let name = key.name.clone();
        let [trials, first, batch] = numbers(text, keys, Some(key), (&name, fit.len()))?;
        Ok(Step { name, fit, to, with, refines, trials, first, batch })
    };
    let steps: Vec<Step> = keys.step.iter().enumerate().map(step).collect::<Result<_>>()?;
    refuse_idle(text, keys, &steps)?;
    for (k, step) in steps.iter().enumerate() {
        let Some(earlier) = step.refines.map(|r| &steps[r]) else { continue };
        let why = if earlier.with == step.with {
            "its specimens are the same: a step with the same 'with' uses their trials without it"
        } else if earlier.fit != step.fit {
            "it fits other parameters: give both steps the same fit"
        } else if let Some(part) = step.to.iter().find(|p| !earlier.to.contains(p)) {
            &format!(
                "it does not fit to this part of test '{}': give both steps the same to",
                tests[part.test].name
            )
        } else {
            continue;
        };
        let span = keys.step[k].get_ref().refines.as_ref().map_or(0..0, Spanned::span);
        return Err(text.refuse(&span, format!("refines = \"{}\": {why}", earlier.name)));
    }
    Ok(steps)
}

/// Refuses numbers of trials that no step goes by.
fn refuse_idle(text: &Text, keys: &RecipeKeys, steps: &[Step]) -> Result<()> {
    let own: Vec<&StepKeys> = keys.step.iter().map(Spanned::get_ref).collect();
    let all = |has: fn(&StepKeys) -> bool| !own.is_empty() && own.iter().all(|key| has(key));
    let settings = &keys.settings;
    for (name, given, idle) in [
        ("trials", &settings.trials, all(|key| key.trials.is_some())),
        ("first", &settings.first, all(|key| key.first.is_some())),
        ("batch", &settings.batch, all(|key| key.batch.is_some())),
    ] {
        if let Some(given) = given.as_ref().filter(|_| idle) {
            let message = format!("{name}: changes nothing: every step gives its own; leave it out");
            return Err(text.refuse(&given.span(), message));
        }
    }
    for (k, key) in keys.parameter.iter().enumerate() {
        let start =
            key.get_ref().start.as_ref().filter(|_| steps.first().is_some_and(|s| s.fit.contains(&k)));
        if let Some(start) = start {
            let message =
                "start: changes nothing: the first step fits the parameter; leave it out, or give it a prior";
            return Err(text.refuse(&start.span(), message));
        }
    }
    let more = |step: &Step| step.first < step.trials;
    let of_step =
        |(key, step): (&&StepKeys, &Step)| key.batch.as_ref().filter(|_| !more(step)).map(Spanned::span);
    let alone = own.iter().zip(steps).find_map(of_step);
    let shared = settings.batch.as_ref().filter(|_| !steps.iter().any(more)).map(Spanned::span);
    match alone.or(shared) {
        None => Ok(()),
        Some(span) => Err(text.refuse(
            &span,
            "batch: changes nothing: all trials come first; give more trials, or fewer in first",
        )),
    }
}

fn whole_curve(test: usize) -> Part {
    Part { test, from: f64::NEG_INFINITY, until: f64::INFINITY }
}

/// The step of a name among those before.
fn earlier(text: &Text, name: &Spanned<String>, before: &[Spanned<StepKeys>]) -> Result<usize> {
    let known = before.iter().map(|b| b.get_ref().name.as_str());
    known.clone().position(|k| k == name.get_ref()).ok_or_else(|| {
        let hint = hint(name.get_ref(), known);
        text.refuse(&name.span(), format!("refines: no step '{}' comes before{hint}", name.get_ref()))
    })
}

/// Trials, first trials and batch of a step, by its name and number of parameters.
fn numbers(
    text: &Text,
    keys: &RecipeKeys,
    own: Option<&StepKeys>,
    (name, parameters): (&str, usize),
) -> Result<[usize; 3]> {
    let settings = &keys.settings;
    let key = |own: Option<&Option<Spanned<i64>>>, all: &Option<Spanned<i64>>| {
        own.and_then(Option::as_ref).or(all.as_ref()).map(|s| Spanned::new(s.span(), *s.get_ref()))
    };
    let n = parameters as u64;
    let trials = whole(text, "trials", &key(own.map(|o| &o.trials), &settings.trials), 30 * n, [3, MOST])?;
    let default = (10 * n).min(trials);
    let first = whole(text, "first", &key(own.map(|o| &o.first), &settings.first), default, [3, MOST])?;
    let batch = whole(text, "batch", &key(own.map(|o| &o.batch), &settings.batch), 8, [1, 1000])?;
    if first > trials || first < n + 2 {
        let given = own
            .and_then(|o| o.first.as_ref().or(o.trials.as_ref()))
            .or(settings.first.as_ref().or(settings.trials.as_ref()));
        let span = given.map_or(0..0, Spanned::span);
        let message = format!(
            "step '{name}' has {n} parameters, trials = {trials} and first = {first}: give first from {} to trials, and trials of {} or more",
            n + 2,
            10 * n
        );
        return Err(text.refuse(&span, message));
    }
    Ok([trials, first, batch].map(|n| n as usize))
}

fn fit(text: &Text, key: &StepKeys, parameters: &[Parameter]) -> Result<Vec<usize>> {
    let names = key.fit.get_ref().list();
    if names == ["all"] {
        return Ok((0..parameters.len()).collect());
    }
    let span = key.fit.span();
    let find = |name: &String| {
        let known = parameters.iter().map(|p| p.name.as_str());
        known
            .clone()
            .position(|k| k == name)
            .ok_or_else(|| text.refuse(&span, format!("fit: no parameter '{name}'{}", hint(name, known))))
    };
    let mut found: Vec<usize> = names.iter().map(find).collect::<Result<_>>()?;
    found.sort_unstable();
    found.dedup();
    if found.is_empty() || found.len() != names.len() {
        return Err(text.refuse(&span, "fit: name each parameter once, or write fit = \"all\""));
    }
    Ok(found)
}

fn part(text: &Text, span: &Range<usize>, key: &PartKeys, tests: &[Test]) -> Result<Part> {
    let (name, from, until) = match key {
        PartKeys::Test(name) => (name, None, None),
        PartKeys::Part(part) => (&part.test, part.from.as_ref(), part.until.as_ref()),
    };
    let known = tests.iter().map(|t| t.name.as_str());
    let Some(test) = known.clone().position(|k| k == name) else {
        return Err(text.refuse(span, format!("to: no test '{name}'{}", hint(name, known))));
    };
    let Some(target) = &tests[test].target else {
        return Err(text.refuse(span, format!("to: test '{name}' has no data")));
    };
    let end = |number: Option<&super::keys::Number>, key: &str, default: f64| {
        number.map_or(Ok(default), |n| text.number(n, &target.x_unit, span, key))
    };
    let (from, until) = (end(from, "from", f64::NEG_INFINITY)?, end(until, "until", f64::INFINITY)?);
    if target.points.iter().filter(|p| p.x >= from && p.x <= until).count() == 0 {
        let ends =
            [target.points.first(), target.points.last()].map(|p| p.map_or(0.0, |p| p.x)).map(super::shown);
        let message = format!(
            "to: no point of test '{name}' lies from {from} to {until}: its data reach from {} to {}",
            ends[0], ends[1]
        );
        return Err(text.refuse(span, message));
    }
    Ok(Part { test, from, until })
}
