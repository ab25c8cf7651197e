//! The time step that an accuracy asks for: `accuracy = "1%"` in `[time]`.
//!
//! ```text
//! ln safety = interpolated between the measured points (ln error, ln safety) of the law, at 0.9 of the error asked for
//! ```
//!
//! The curve of each normal law, with contacts sampled and averaged, was measured with this engine (`data/impact-error.csv` says how, and `make -C pipelines
//! accuracy` measures it again): the largest error in the restitution of a head-on impact of two equal spheres, over where in
//! a step the contact begins, over restitutions, and, where stiffness grows with depth, at an impact nearly as deep as
//! the guard lets it be, over the share of the critical step. Gentler impacts last longer, and friction makes the critical step
//! shorter: both are resolved better at the same share. The tenth is kept for what lies between the points. What many grains do together may need more or less: cost-curve
//! measures that.

use crate::check::Check;
use crate::error::Result;
use crate::keys::{Accuracy, ELASTIC, SAFETY, SAFETY_ELASTIC, Sampling, Time};
use dem::effects::{Slot, active, by_modulus};
use dem::setup::ContactLaw;
use serde::Serialize;
use std::collections::BTreeSet;
use std::fmt::Write;

/// The measured curves.
const CURVES: &str = include_str!("../../../data/impact-error.csv");
/// Share of the wanted error that the step is chosen for: the curves were measured at a few phases of a step only.
const AIM: f64 = 0.9;
/// Their file, for messages.
const FILE: &str = "crates/plant/scene/data/impact-error.csv";

/// A point of a curve: share of the critical step [–], error [–].
#[derive(Debug, Clone, Copy, PartialEq)]
struct Measured {
    /// Share of the critical step [–].
    safety: f64,
    /// Largest error of the restitution at this share or a smaller one [–].
    error: f64,
}

/// The measured curve of a normal law with contacts sampled or averaged, from small steps to large ones.
fn curve(law: &str, sampling: Sampling) -> Vec<Measured> {
    let contacts = match sampling {
        Sampling::Sampled => "sampled",
        Sampling::Averaged => "averaged",
    };
    let mut points: Vec<Measured> = Vec::new();
    for line in CURVES.lines() {
        let mut cells = line.split(',');
        if cells.next() != Some(law) || cells.next() != Some(contacts) {
            continue;
        }
        let mut number = || cells.next().and_then(|cell| cell.trim().parse::<f64>().ok());
        if let Some((safety, error)) = number().zip(number()) {
            points.push(Measured { safety, error });
        }
    }
    points.sort_by(|a, b| a.safety.total_cmp(&b.safety));
    // A larger step may have a smaller error by accident: it does not count.
    let mut worst = 0.0;
    for point in &mut points {
        worst = point.error.max(worst);
        point.error = worst;
    }
    points
}

/// The smallest accuracy that a step was measured to reach, by law and `time.contacts`, in Markdown.
pub fn smallest_accuracies() -> String {
    let mut out = String::from("| law | averaged | sampled |\n|---|---|---|\n");
    for law in ["hertz", "hooke", "jkr", "walton_braun"] {
        let least = [Sampling::Averaged, Sampling::Sampled].map(|contacts| {
            let first = curve(law, contacts).first().copied();
            first.map_or("not measured".to_owned(), |point| percent(point.error / AIM))
        });
        // Writing to a string does not fail.
        let _ = writeln!(out, "| {law} | {} |", least.join(" | "));
    }
    out
}

/// The largest share of the critical step whose error is not above `wanted`; `None` when no measured one is.
fn safety(curve: &[Measured], wanted: f64) -> Option<f64> {
    let good = curve.iter().rposition(|p| p.error <= wanted)?;
    let (a, Some(b)) = (curve.get(good)?, curve.get(good + 1)) else { return curve.last().map(|p| p.safety) };
    if a.error <= 0.0 {
        return Some(a.safety);
    }
    let share = libm::log(wanted / a.error) / libm::log(b.error / a.error);
    Some(a.safety * libm::exp(share * libm::log(b.safety / a.safety)))
}

/// The share of the critical step that a scene asks for, and on which curve it relies, when it asks for an accuracy.
///
/// # Errors
/// An accuracy that no measured step reaches.
pub(in crate::plan) fn choose(
    check: &Check,
    time: &Time,
    contacts: &[ContactLaw],
) -> Result<(f64, Option<String>)> {
    let Some(Accuracy(wanted)) = time.accuracy else {
        let given = time.safety.map(|safety| (safety, None));
        return Ok(given.unwrap_or_else(|| default_safety(time.contacts, contacts)));
    };
    let mut best: Option<(f64, &str)> = None;
    for law in laws(contacts) {
        let measured = curve(law, time.contacts);
        let Some(smallest) = measured.first() else {
            let why = format!("was not measured for law = \"{law}\"");
            let cure = "give time.safety instead, and measure with cost-curve what it costs";
            return Err(check.wrong("time.accuracy", percent(wanted), &why, cure));
        };
        let Some(safety) = safety(&measured, AIM * wanted) else {
            let (least, at) = (percent(smallest.error / AIM), smallest.safety);
            let reached = format!("{least} at {at} of the critical step");
            let why = format!("is less than any measured step reaches with law \"{law}\": {reached}");
            let cure = format!("ask for {least} or more, or give time.safety below {at} instead");
            return Err(check.wrong("time.accuracy", percent(wanted), &why, &cure));
        };
        if best.is_none_or(|(least, _)| safety < least) {
            best = Some((safety, law));
        }
    }
    // Nothing touches: every step is exact.
    let Some((safety, law)) = best else { return Ok((SAFETY, None)) };
    let (wanted, shown) = (percent(wanted), geom::Shown(safety));
    let curve = format!("from the measured error of an impact with law \"{law}\" ({FILE})");
    Ok((safety, Some(format!("time.accuracy {wanted}: safety {shown}, {curve}"))))
}

/// What an impact is off by at a time step, by the measured curves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ImpactError {
    /// Normal law of the contacts that are off most.
    pub law: &'static str,
    /// Largest error of the restitution [–]; as an `accuracy`, which asks for the same step.
    pub error: f64,
    /// Whether the step is shorter than the shortest that was measured: `error` is then that of this one.
    pub at_most: bool,
    /// Share of the critical step within 1 % [–]; `None` where none was measured to reach that.
    pub within_percent: Option<f64>,
}

/// What an impact is off by where the time step is a share of the critical step; `None` without contacts, for laws that were not measured, and for steps longer than any that
/// was.
pub fn impact_error(contacts: &[ContactLaw], sampling: Sampling, share: f64) -> Option<ImpactError> {
    let mut worst: Option<ImpactError> = None;
    for law in laws(contacts) {
        let measured = curve(law, sampling);
        let (error, at_most) = error_at(&measured, share)?;
        let within_percent = safety(&measured, AIM * 0.01);
        let found = ImpactError { law, error: error / AIM, at_most, within_percent };
        worst = Some(worst.filter(|worst| worst.error >= found.error).unwrap_or(found));
    }
    worst
}

/// The error at a share of the critical step, and whether the share is below all that were measured; `None` above them.
fn error_at(curve: &[Measured], share: f64) -> Option<(f64, bool)> {
    let (first, last) = (curve.first()?, curve.last()?);
    if share <= first.safety {
        return Some((first.error, share < first.safety));
    }
    // Rounded by what a number in a scene has for digits.
    if share > last.safety * (1.0 + 1e-6) {
        return None;
    }
    let after = curve.iter().position(|p| p.safety >= share).unwrap_or(curve.len() - 1);
    let (a, b) = (curve[after - 1], curve[after]);
    if !(a.error > 0.0) {
        return Some((b.error, false));
    }
    let part = libm::log(share / a.safety) / libm::log(b.safety / a.safety);
    Some((a.error * libm::exp(part * libm::log(b.error / a.error)), false))
}

/// The share of the critical step where a scene says nothing, and why where it is not the usual one.
///
/// Without friction a contact of a linear law lasts six steps at the usual share. Where it is sampled, its force begins with a jump of one step's
/// length: a gas of 216 such grains gains 8 % of its energy a second at e = 1; at [`SAFETY_ELASTIC`] less than 0.6 %, of either sign. Averaged
/// contacts gain more where the damping is not matched to the step: a gas of Walton and Braun's law at e = 1 trebles its energy in half a second,
/// one with a `normal_damping` of 1e-3 kg/s gains 75 % in 0.3 s; at [`SAFETY_ELASTIC`] both stay within 3 % of a step of a tenth.
/// Friction makes the critical step four times shorter, and dissipation hides the gain.
fn default_safety(sampling: Sampling, contacts: &[ContactLaw]) -> (f64, Option<String>) {
    let rubs = |law: &ContactLaw| active(law).any(|d| d.slot == Slot::Sliding && !(d.idle)(law));
    let gains = |law: &ContactLaw| gains(sampling, law);
    match contacts.iter().find_map(gains) {
        Some(what) if !contacts.iter().any(rubs) => {
            let how = if sampling == Sampling::Averaged { "an averaged" } else { "a sampled" };
            let why = format!("{how} linear law without friction and with {what} gains energy");
            (
                SAFETY_ELASTIC,
                Some(format!("safety {SAFETY_ELASTIC} instead of {SAFETY}: {why} in longer steps")),
            )
        }
        _ => (SAFETY, None),
    }
}

/// What makes a contact gain energy in longer steps; none where it does not.
fn gains(sampling: Sampling, law: &ContactLaw) -> Option<String> {
    let linear = by_modulus(law) || law.number("stiffness").is_some();
    let given = law.number("normal_damping").map(|_| "a normal_damping that is given".to_owned());
    let elastic = law.number("restitution").filter(|e| *e > ELASTIC);
    let elastic = elastic.map(|e| format!("restitution {}", geom::Shown(e)));
    let matched = sampling == Sampling::Averaged && !laws(std::slice::from_ref(law)).contains("walton_braun");
    given.or(elastic.filter(|_| !matched)).filter(|_| linear)
}

fn percent(share: f64) -> String {
    format!("{} %", geom::Shown(100.0 * share))
}

/// Names of the normal laws in force, each once.
fn laws(contacts: &[ContactLaw]) -> BTreeSet<&'static str> {
    let name = |law: &ContactLaw| active(law).find(|d| d.slot == Slot::Normal).map(|d| d.name);
    contacts.iter().filter_map(name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_measured_points_it_is_interpolated() {
        let point = |safety, error| Measured { safety, error };
        let curve = [point(0.01, 1e-4), point(0.1, 1e-2), point(0.8, 0.3)];
        assert!((safety(&curve, 1e-3).unwrap() - 0.1f64.powf(1.5)).abs() < 1e-12);
        assert_eq!(safety(&curve, 1e-2), Some(0.1));
        assert_eq!(safety(&curve, 0.5), Some(0.8));
        assert_eq!(safety(&curve, 1e-5), None);
    }

    #[test]
    fn every_law_has_a_curve_that_only_rises() {
        for law in ["hooke", "hertz", "jkr"] {
            let [sampled, averaged] = [Sampling::Sampled, Sampling::Averaged].map(|s| curve(law, s));
            for curve in [&sampled, &averaged] {
                assert!(curve.len() >= 5, "{law}: {curve:?}");
                assert!(curve.windows(2).all(|w| w[0].safety < w[1].safety && w[0].error <= w[1].error));
            }
            // The same hundredth takes at least three times fewer steps.
            let [before, after] = [sampled, averaged].map(|c| safety(&c, 0.009).expect("measured"));
            assert!(after > 3.0 * before, "{law}: {before}, {after}");
        }
    }

    #[test]
    fn the_error_at_the_step_of_an_accuracy_is_that_accuracy() {
        for law in ["hooke", "hertz", "jkr"] {
            for sampling in [Sampling::Sampled, Sampling::Averaged] {
                let curve = curve(law, sampling);
                let (least, most) = (curve[0].error / AIM, curve[curve.len() - 1].error / AIM);
                for part in [0.1, 0.5, 0.9] {
                    let wanted = least * libm::pow(most / least, part);
                    let share = safety(&curve, AIM * wanted).expect("measured");
                    let (error, at_most) = error_at(&curve, share).expect("measured");
                    // Where an error does not grow with the step, the longest such step is taken.
                    assert!(!at_most && error <= AIM * wanted * (1.0 + 1e-9), "{law}: {error}, {wanted}");
                    let next = error_at(&curve, 1.01 * share).map_or(f64::INFINITY, |e| e.0);
                    assert!(next > AIM * wanted, "{law}: {next}, {wanted}");
                }
                assert!(error_at(&curve, 0.5 * curve[0].safety).expect("short").1, "{law}");
                assert_eq!(error_at(&curve, 1.1 * curve[curve.len() - 1].safety), None, "{law}");
            }
        }
    }
}
