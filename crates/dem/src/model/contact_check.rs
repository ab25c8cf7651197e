//! Laws of contact that are refused before a run starts.

use crate::effects::{Contradiction, Description, Elastic, Key as NumberKey, Slot, active};
use crate::model::check::within;
use crate::model::error::SetupError;
use crate::model::limit::{normal, radii_by_material};
use crate::setup::{ContactLaw, Setup};
use crate::simd::number::Precision;

/// Radius below which the square of a couple is too small for single precision [m].
const SMALLEST_NARROW: f64 = 1e-5;

/// Rare effects are compiled for double precision only.
pub fn precision(setup: &Setup) -> Result<(), SetupError> {
    if setup.precision == Precision::Double {
        return Ok(());
    }
    let smallest = radii_by_material(setup).iter().flatten().map(|r| r.0).fold(f64::INFINITY, f64::min);
    let fine = smallest >= SMALLEST_NARROW;
    within(
        format!("precision \"{}\": radius", setup.precision.name()),
        smallest,
        "m",
        fine,
        "radius ≥ 1e-5 (leave the key out for double precision)",
    )?;
    let rare = |c: &&ContactLaw| active(c).any(|d| !d.every_precision);
    setup.contacts.iter().find(rare).map_or(Ok(()), |c| {
        let name = |m: u16| setup.materials[m as usize].name.as_str();
        let names: Vec<&str> = active(c).filter(|d| !d.every_precision).map(|d| d.name).collect();
        let what = format!("{} ({}–{})", names.join(", "), name(c.between.0), name(c.between.1));
        Err(SetupError::PrecisionWithout { precision: setup.precision.name(), what })
    })
}

pub fn contacts(setup: &Setup) -> Result<(), SetupError> {
    for c in &setup.contacts {
        let name = |m: u16| setup.materials[m as usize].name.as_str();
        let at = format!("contact {}–{}", name(c.between.0), name(c.between.1));
        effects(&at, c)?;
        bound_grains(&at, c, setup)?;
    }
    Ok(())
}

/// Every number that the effects of a law take, and none that they do not.
fn effects(at: &str, law: &ContactLaw) -> Result<(), SetupError> {
    let asked: Vec<&Description> = active(law).collect();
    let has = |slot: Slot| asked.iter().any(|d| d.slot == slot);
    let value = |key: &str| law.number(key).unwrap_or(f64::NAN);
    let refuse = |key: &str, unit, range: String| {
        Err(SetupError::Range { what: format!("{at}: {key}"), value: value(key), unit, range })
    };
    if !has(Slot::Normal) {
        return refuse("law", "", "the normal laws that there are".to_owned());
    }
    for d in &asked {
        let given = |key: &&NumberKey| key.required || law.number(key.name).is_some();
        if let Some(key) = d.keys.iter().filter(given).find(|key| !key.range.holds(value(key.name))) {
            return refuse(key.name, key.unit, key.range.to_string());
        }
        let first = d.keys.first().map_or(("", ""), |key| (key.name, key.unit));
        if let Some(slot) = d.needs.filter(|slot| !has(*slot)) {
            let range = format!("laws with {} (nothing else turns a particle)", slot.key());
            return refuse(first.0, first.1, range);
        }
        if let Some((_, why)) = d.excludes.filter(|(slot, _)| has(*slot)) {
            return refuse(first.0, first.1, format!("laws without cohesion: {why}"));
        }
        if let Some(Contradiction { key, why, .. }) = (d.contradiction)(law) {
            return refuse(key, "", format!("what the law allows: it {why}"));
        }
    }
    let used = |key: &str| asked.iter().any(|d| d.keys.iter().any(|k| k.name == key));
    match law.numbers().find(|(key, _)| !used(key)) {
        Some((key, _)) => refuse(key, "", "numbers that this law takes".to_owned()),
        None => Ok(()),
    }
}

/// Cohesion that would pull grains into each other, beyond the guard, without any load.
fn bound_grains(at: &str, c: &ContactLaw, setup: &Setup) -> Result<(), SetupError> {
    let sizes = radii_by_material(setup);
    let both = [c.between.0, c.between.1].map(|m| sizes[m as usize]);
    let Some(smallest) = both.iter().flatten().map(|r| r.0).reduce(f64::min) else { return Ok(()) };
    let largest = both.iter().flatten().map(|r| r.1).fold(0.0, f64::max);
    let elastic = Elastic::of(&setup.materials[c.between.0 as usize], &setup.materials[c.between.1 as usize]);
    let density = c.number("cohesion_energy_density").unwrap_or(0.0);
    let share = normal(c).map_or(0.0, |law| (law.unloaded_overlap)(c, elastic, density, [smallest, largest]));
    let pulls = active(c)
        .filter(|d| d.slot <= Slot::Cohesion)
        .flat_map(|d| d.keys)
        .find(|key| key.unit.starts_with('J'));
    let (key, unit) = pulls.map_or(("law", ""), |key| (key.name, key.unit));
    let range = "what the stiffness bears: grains without load would overlap by more than guards.overlap";
    within(format!("{at}: {key}"), c.number(key).unwrap_or(0.0), unit, share < setup.guards.overlap, range)
}
