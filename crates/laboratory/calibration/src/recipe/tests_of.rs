//! Checks of tests, and their data.

use super::blanks::{self, shown};
use super::check::{OWN_BLANKS, number, whole};
use super::keys::{Number, TestKeys};
use super::text::Text;
use super::{CalibrationSettings, GivenData, Test};
use crate::error::{CalibrateError, Result, hint};
use crate::measured::target::{Asked, Units, curve, value};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// The tests, and warnings; `blanks` are those that something fills.
pub(super) fn tests(
    text: &Text,
    keys: &[Spanned<TestKeys>],
    blanks: &[&str],
    settings: &CalibrationSettings,
    files: (&Path, &GivenData),
) -> Result<(Vec<Test>, Vec<String>)> {
    let given = given(files.1, keys)?;
    let (mut tests, mut warnings): (Vec<Test>, Vec<String>) = (Vec::new(), Vec::new());
    for (k, key) in keys.iter().enumerate() {
        let key = key.get_ref();
        let name = key.name.get_ref();
        let safe = !name.is_empty()
            && name.len() <= 80
            && !name.contains(['/', '\\', '\n', '='])
            && !name.starts_with('.');
        if !safe {
            return Err(text.refuse(
                &key.name.span(),
                format!("name = \"{name}\": give a short name without '/', '\\' and '=' that does not begin with '.'"),
            ));
        }
        if tests.iter().any(|t| t.name == *name) {
            return Err(text.refuse(
                &key.name.span(),
                format!("name = \"{name}\": is there twice: give the tests different names"),
            ));
        }
        let command = match (&key.command, tests.last()) {
            (Some(command), _) => command.get_ref().clone(),
            (None, Some(before)) => before.command.clone(),
            (None, None) => {
                let message = "has no command: the first test needs one; later ones share the command of the test before";
                return Err(text.refuse(&key.name.span(), message));
            }
        };
        if let Some(own) = &key.command {
            blanks_are_known(text, own, blanks)?;
        }
        tests.push(test(text, (key, command), (files.0, given.get(&k).map(Vec::as_slice)), &mut warnings)?);
    }
    if settings.seeds > 1 && !tests.iter().any(Test::is_random) {
        let message =
            format!("seeds = {}: no command has the blank {{seed}}: leave seeds out", settings.seeds);
        return Err(CalibrateError::Recipe { place: text.place(None), message });
    }
    Ok((tests, warnings))
}

/// Files of the command line by test.
fn given(data: &GivenData, keys: &[Spanned<TestKeys>]) -> Result<BTreeMap<usize, Vec<PathBuf>>> {
    let names: Vec<&str> = keys.iter().map(|k| k.get_ref().name.get_ref().as_str()).collect();
    let mut found: BTreeMap<usize, Vec<PathBuf>> = BTreeMap::new();
    let without = |k: &usize| keys[*k].get_ref().data.is_none() && keys[*k].get_ref().value.is_none();
    let mut open = (0..keys.len()).filter(without).collect::<Vec<_>>().into_iter();
    for text in data {
        let named =
            text.split_once('=').filter(|(name, _)| !Path::new(text).exists() || names.contains(name));
        let (test, file) = match named {
            Some((name, file)) => match names.iter().position(|n| *n == name) {
                Some(test) => (test, file),
                None => {
                    let hint = hint(name, names.iter().copied());
                    return Err(CalibrateError::Usage(format!("--data {text}: no test '{name}'{hint}")));
                }
            },
            None if keys.len() == 1 => (0, text.as_str()),
            None => match open.next() {
                Some(test) => (test, text.as_str()),
                None => {
                    let message =
                        format!("--data {text}: every test of the recipe has data: write --data TEST={text}");
                    return Err(CalibrateError::Usage(message));
                }
            },
        };
        found.entry(test).or_default().push(PathBuf::from(file));
    }
    Ok(found)
}

fn blanks_are_known(text: &Text, key: &Spanned<String>, blanks: &[&str]) -> Result<()> {
    let command = key.get_ref();
    if command.trim().is_empty() || command.contains('\0') {
        return Err(
            text.refuse(&key.span(), "command: is empty: give a shell line that prints a number or a table")
        );
    }
    let known = || blanks.iter().copied().chain(OWN_BLANKS);
    match blanks::names(command).into_iter().find(|name| !known().any(|k| k == *name)) {
        None => Ok(()),
        Some(name) => {
            let known: Vec<&str> = known().collect();
            let hint = hint(name, known.iter().copied());
            let message = format!(
                "command: nothing fills the blank {{{name}}}{hint}; braces of the shell need a blank inside: {{ {name}; }}"
            );
            Err(text.refuse(&key.span(), message))
        }
    }
}

fn test(
    text: &Text,
    (key, command): (&TestKeys, String),
    files: (&Path, Option<&[PathBuf]>),
    warnings: &mut Vec<String>,
) -> Result<Test> {
    let name = key.name.get_ref().clone();
    let unit = |unit: &Option<Spanned<String>>| unit.as_ref().map(|u| u.get_ref().trim().to_owned());
    let units = Units { x: unit(&key.x_unit), y: unit(&key.y_unit) };
    refuse_unused(text, key, files.1.is_some())?;
    let mut rows = BTreeMap::new();
    for (column, value) in key.rows.iter().flatten() {
        rows.insert(column.clone(), text.number(value, "", &key.name.span(), "rows")?);
    }
    let (deviation, share) = deviation(text, key, &units)?;
    let asked = asked(text, key, (deviation, share), units)?;
    let paths: Vec<PathBuf> = match (files.1, &key.data) {
        (Some(given), _) => given.to_vec(),
        (None, Some(data)) => data.get_ref().list().iter().map(|f| files.0.join(f)).collect(),
        (None, None) => Vec::new(),
    };
    let at = |message: String| match &key.data {
        Some(data) => text.refuse(&data.span(), message),
        None => text.refuse(&key.name.span(), message),
    };
    let target = match (&key.value, paths.is_empty()) {
        (Some(value), true) => {
            let y =
                text.number(value.get_ref(), asked.units.y.as_deref().unwrap_or(""), &value.span(), "value")?;
            if deviation.is_none() {
                return Err(text.refuse(
                    &value.span(),
                    format!("value of test '{name}' has no deviation: add deviation = 0.5, or \"5 %\""),
                ));
            }
            Some(self::value(&asked, &[y]).map_err(at)?)
        }
        (None, true) => None,
        _ => Some(curve(&asked, &paths, warnings).map_err(|e| match e {
            CalibrateError::Usage(message) => at(message),
            other => other,
        })?),
    };
    if target.is_none() && deviation.is_none() {
        let message = format!(
            "test '{name}' has neither data nor value: give --data FILE or data; a test that --design may propose needs deviation"
        );
        return Err(text.refuse(&key.name.span(), message));
    }
    Ok(Test {
        name,
        command,
        read: key.read.clone(),
        x: key.x.as_ref().map(|x| x.get_ref().clone()),
        y: key.y.as_ref().map(|y| y.get_ref().clone()),
        rows,
        pick: key.pick.unwrap_or_default(),
        target,
        deviation,
        share,
        units: asked.units,
    })
}

/// Keys that change nothing.
fn refuse_unused(text: &Text, key: &TestKeys, given: bool) -> Result<()> {
    let no = |span: std::ops::Range<usize>, message: &str| Err(text.refuse(&span, message));
    if key.x.is_some() && key.y.is_none() {
        return no(key.name.span(), "x without y: name the column of y, too");
    }
    if key.value.is_some() && (key.data.is_some() || given || key.x.is_some()) {
        return no(key.name.span(), "value is for a number: leave it out where there are data or x");
    }
    let curve_only = [("from", &key.from), ("until", &key.until), ("correlation", &key.correlation)];
    for (name, number) in curve_only {
        if let Some(number) = number.as_ref().filter(|_| key.x.is_none()) {
            return no(number.span(), &format!("{name} is for a curve: this test has no x"));
        }
    }
    if let Some(points) = key.points.as_ref().filter(|_| key.x.is_none()) {
        return no(points.span(), "points is for a curve: this test has no x");
    }
    if key.pick.is_some() && (key.x.is_some() || key.y.is_none()) {
        return no(key.name.span(), "pick chooses a row of a column y without x: leave it out");
    }
    Ok(())
}

/// A deviation, and whether it is a share.
fn deviation(text: &Text, key: &TestKeys, units: &Units) -> Result<(Option<f64>, bool)> {
    let Some(given) = &key.deviation else { return Ok((None, false)) };
    let share = matches!(given.get_ref(), Number::Text(t) if t.trim().ends_with('%'));
    let unit = if share { "" } else { units.y.as_deref().unwrap_or("") };
    let value = text.number(given.get_ref(), unit, &given.span(), "deviation")?;
    if !(value > 0.0) {
        return Err(
            text.refuse(&given.span(), format!("deviation = {}: give a number above 0", shown(value)))
        );
    }
    Ok((Some(value), share))
}

fn asked(text: &Text, key: &TestKeys, deviation: (Option<f64>, bool), units: Units) -> Result<Asked> {
    let ends = [("from", &key.from), ("until", &key.until)].map(|(name, n)| {
        n.as_ref()
            .map(|n| text.number(n.get_ref(), units.x.as_deref().unwrap_or(""), &n.span(), name))
            .transpose()
    });
    let [from, until] = ends;
    let (from, until) = (from?.unwrap_or(f64::NEG_INFINITY), until?.unwrap_or(f64::INFINITY));
    if from >= until {
        let span = key.from.as_ref().map_or(0..0, Spanned::span);
        return Err(text.refuse(&span, format!("from = {} and until = {} cross", shown(from), shown(until))));
    }
    let discrepancy_is_share = matches!(key.discrepancy.as_ref().map(Spanned::get_ref), Some(Number::Text(t)) if t.trim().ends_with('%'));
    let unit = if discrepancy_is_share { "" } else { units.y.as_deref().unwrap_or("") };
    let discrepancy = number(text, "discrepancy", &key.discrepancy, unit, [0.0, 1e99])?.unwrap_or(0.0);
    let name = |own: &Option<String>, other: &Option<Spanned<String>>| {
        own.clone().or(other.as_ref().map(|o| o.get_ref().clone()))
    };
    Ok(Asked {
        x: name(&key.data_x, &key.x).filter(|_| key.x.is_some()),
        y: name(&key.data_y, &key.y).unwrap_or_else(|| "value".to_owned()),
        from,
        until,
        points: whole(text, "points", &key.points, 30, [2, 500])? as usize,
        deviation: deviation.0,
        share: deviation.1,
        discrepancy: (discrepancy, discrepancy_is_share),
        correlation: number(text, "correlation", &key.correlation, "", [0.0, 1.0])?,
        units,
    })
}
