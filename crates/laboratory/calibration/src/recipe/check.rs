//! Checks of settings and parameters.

use super::keys::{Number, ParameterKeys, PriorKeys, Scale, SettingsKeys};
use super::parameter::{Parameter, Prior};
use super::text::Text;
use super::{CalibrationSettings, Test, blanks};
use crate::error::{CalibrateError, Result};
use crate::measured::prior;
use scene::materials::Range;
use toml::Spanned;

/// Blanks that are not parameters.
pub(super) const OWN_BLANKS: [&str; 2] = ["seed", "here"];
/// Most parameters: the emulator does not reach further.
const MOST_PARAMETERS: usize = 20;

/// A whole number of a key, in a range.
pub(super) fn whole(
    text: &Text,
    key: &str,
    given: &Option<Spanned<i64>>,
    default: u64,
    range: [u64; 2],
) -> Result<u64> {
    let Some(given) = given else { return Ok(default) };
    let value = *given.get_ref();
    match u64::try_from(value).ok().filter(|v| (range[0]..=range[1]).contains(v)) {
        Some(value) => Ok(value),
        None => {
            let [low, high] = range;
            Err(text
                .refuse(&given.span(), format!("{key} = {value}: give a whole number from {low} to {high}")))
        }
    }
}

/// A number of a key, in a range.
pub(super) fn number(
    text: &Text,
    key: &str,
    given: &Option<Spanned<Number>>,
    unit: &str,
    range: [f64; 2],
) -> Result<Option<f64>> {
    let Some(given) = given else { return Ok(None) };
    let value = text.number(given.get_ref(), unit, &given.span(), key)?;
    if value >= range[0] && value <= range[1] {
        return Ok(Some(value));
    }
    let [low, high] = range.map(blanks::shown);
    Err(text.refuse(
        &given.span(),
        format!("{key} = {}: give a number from {low} to {high}", blanks::shown(value)),
    ))
}

pub(super) fn settings(text: &Text, keys: &SettingsKeys) -> Result<CalibrationSettings> {
    Ok(CalibrationSettings {
        seeds: whole(text, "seeds", &keys.seeds, 1, [1, 1000])?,
        seed: whole(text, "seed", &keys.seed, 0, [0, 1 << 40])?,
        interval: number(text, "interval", &keys.interval, "", [0.5, 0.999])?.unwrap_or(0.9),
        failures: number(text, "failures", &keys.failures, "", [0.0, 1.0])?.unwrap_or(0.1),
        timeout: number(text, "timeout", &keys.timeout, "s", [1e-3, 1e8])?,
        abandon: number(text, "abandon", &keys.abandon, "", [0.0, 1e12])?.unwrap_or(1000.0),
    })
}

pub(super) fn parameters(text: &Text, keys: &[Spanned<ParameterKeys>]) -> Result<Vec<Parameter>> {
    if let Some(extra) = keys.get(MOST_PARAMETERS) {
        let message = format!("{} parameters: give at most {MOST_PARAMETERS}", keys.len());
        return Err(text.refuse(&extra.span(), message));
    }
    let mut found: Vec<Parameter> = Vec::new();
    for key in keys {
        let name = key.get_ref().name.get_ref();
        let span = key.get_ref().name.span();
        if !blanks::is_word(name) || OWN_BLANKS.contains(&name.as_str()) {
            let message = format!(
                "name = \"{name}\": give a word of letters, digits, '.', '_' and '-', other than seed and here"
            );
            return Err(text.refuse(&span, message));
        }
        if found.iter().any(|p| p.name == *name) {
            return Err(
                text.refuse(&span, format!("name = \"{name}\": is there twice: leave one of them out"))
            );
        }
        found.push(parameter(text, key)?);
    }
    Ok(found)
}

/// Refuses parameters that no command gets.
pub(super) fn used(text: &Text, parameters: &[Parameter], tests: &[Test]) -> Result<()> {
    let unused = |p: &&Parameter| !tests.iter().any(|t| blanks::names(&t.command).contains(&p.name.as_str()));
    match parameters.iter().find(unused) {
        None => Ok(()),
        Some(p) => {
            let message =
                format!("parameter '{0}' changes nothing: no command has the blank {{{0}}}", p.name);
            Err(CalibrateError::Recipe { place: text.place(None), message })
        }
    }
}

fn parameter(text: &Text, keys: &Spanned<ParameterKeys>) -> Result<Parameter> {
    let (span, keys) = (keys.span(), keys.get_ref());
    let name = keys.name.get_ref().clone();
    let unit = keys.unit.as_ref().map(|u| u.get_ref().trim().to_owned()).unwrap_or_default();
    let unit = if ["-", "–", "1"].contains(&unit.as_str()) { String::new() } else { unit };
    let material = match &keys.prior {
        Some(prior) => match prior.get_ref() {
            PriorKeys::Named(word) if word != "uniform" => {
                Some(prior::of_table(word, &name).map_err(|why| text.refuse(&prior.span(), why))?)
            }
            _ => None,
        },
        None => None,
    };
    let [low, high] = match (&keys.bounds, &material) {
        (Some(bounds), _) => self::bounds(text, bounds, &unit)?,
        (None, Some(found)) => found.wide(),
        (None, None) => {
            return Err(
                text.refuse(&span, format!("parameter '{name}' has no bounds: add bounds = [LOW, HIGH]"))
            );
        }
    };
    let log = keys.scale == Some(Scale::Log) || keys.scale.is_none() && low > 0.0 && high / low >= 30.0;
    if log && low <= 0.0 {
        let message = format!(
            "scale = \"log\" of '{name}': the lower bound {} has no logarithm: give bounds above 0",
            blanks::shown(low)
        );
        return Err(text.refuse(&keys.bounds.as_ref().map_or(span, Spanned::span), message));
    }
    let mut made = Parameter { name, unit, low, high, log, prior: Prior::Uniform, source: None, start: 0.0 };
    made.start = made.value(0.5);
    made.prior = prior(text, keys, &made, material.as_ref())?;
    made.source = material.map(|m| m.source);
    if let Prior::Normal { mean, .. } = made.prior {
        made.start = made.value(mean.clamp(0.0, 1.0));
    }
    if let Some(start) = number(text, "start", &keys.start, &made.unit, [low, high])? {
        made.start = start;
    }
    Ok(made)
}

fn bounds(text: &Text, bounds: &Spanned<Vec<Number>>, unit: &str) -> Result<[f64; 2]> {
    let span = bounds.span();
    let [low, high] = bounds.get_ref().as_slice() else {
        let message = format!("bounds: {} numbers: give two, [LOW, HIGH]", bounds.get_ref().len());
        return Err(text.refuse(&span, message));
    };
    let (low, high) = (text.number(low, unit, &span, "bounds")?, text.number(high, unit, &span, "bounds")?);
    let (a, b) = (blanks::shown(low), blanks::shown(high));
    if low > high {
        return Err(text.refuse(&span, format!("bounds = [{a}, {b}]: they cross: write [{b}, {a}]")));
    }
    if (high - low) <= 1e-6 * low.abs().max(high.abs()) {
        let message = format!("bounds = [{a}, {b}]: leave nothing to find: write the value into the command");
        return Err(text.refuse(&span, message));
    }
    Ok([low, high])
}

fn prior(text: &Text, keys: &ParameterKeys, p: &Parameter, material: Option<&Range>) -> Result<Prior> {
    if let Some(range) = material {
        let ends = range.ends.map(|v| p.coordinate(if p.log { v.max(p.low * 1e-3) } else { v }));
        let mean = 0.5 * (ends[0] + ends[1]);
        // The range of the literature holds nine of ten materials.
        let deviation = (0.5 * (ends[1] - ends[0]) / 1.645).max(1e-3);
        if ends[1] < 0.0 || ends[0] > 1.0 {
            let span = keys.prior.as_ref().map_or(0..0, Spanned::span);
            let [a, b] = range.ends.map(blanks::shown);
            return Err(text.refuse(
                &span,
                format!("the prior of '{}' is from {a} to {b}: this is outside of its bounds", p.name),
            ));
        }
        return Ok(Prior::Normal { mean, deviation });
    }
    let Some(given) = &keys.prior else { return Ok(Prior::Uniform) };
    let PriorKeys::Normal(normal) = given.get_ref() else { return Ok(Prior::Uniform) };
    let span = given.span();
    let mean = text.number(&normal.mean, &p.unit, &span, "mean")?;
    let deviation = text.number(&normal.deviation, &p.unit, &span, "deviation")?;
    if !(deviation > 0.0) || mean < p.low || mean > p.high {
        let message =
            format!("prior of '{}': give a mean between the bounds and a deviation above 0", p.name);
        return Err(text.refuse(&span, message));
    }
    let at = p.coordinate(mean);
    // On a logarithm the deviation is relative.
    let spread = if p.log {
        libm::log1p(deviation / mean) / libm::log(p.high / p.low)
    } else {
        deviation / (p.high - p.low)
    };
    Ok(Prior::Normal { mean: at, deviation: spread.max(1e-3) })
}
