//! Laws of contact that are refused before a run starts.

use crate::model::in_range::out_of_range;
use crate::model::limit::{normal, radii_by_material};
use crate::model::quantity::material_names;
use crate::model::{Allowed, Check, SetupError, Subject};
use crate::setup::{ContactLaw, Setup};
use laws::effects::{Contradiction, Description, Elastic, Key as NumberKey, Slot, active, by_modulus};
use laws::simd::Precision;

/// Radius below which the square of a torque is too small for single precision [m].
const SMALLEST_NARROW: f64 = 1e-5;

/// Rare effects are compiled for double precision only.
pub fn precision(setup: &Setup) -> Result<(), SetupError> {
    if setup.precision == Precision::Double {
        return Ok(());
    }
    let smallest = radii_by_material(setup).iter().flatten().map(|r| r.0).fold(f64::INFINITY, f64::min);
    let fine = smallest >= SMALLEST_NARROW;
    let check = Check(|| Subject::Precision(setup.precision));
    check.within("radius", smallest, "m", fine, format!("radius ≥ {SMALLEST_NARROW:e}"))?;
    let rare = |c: &&ContactLaw| active(c).any(|d| !d.every_precision);
    setup.contacts.iter().find(rare).map_or(Ok(()), |c| {
        let effects = active(c).filter(|d| !d.every_precision).map(|d| d.name).collect();
        let between = material_names(setup, c.between);
        Err(SetupError::PrecisionWithout { precision: setup.precision, effects, between })
    })
}

pub fn contacts(setup: &Setup) -> Result<(), SetupError> {
    for c in &setup.contacts {
        let between = material_names(setup, c.between);
        effects(&between, c)?;
        bound_grains(&between, c, setup)?;
    }
    Ok(())
}

/// Every number that the effects of a law take, and none that they do not.
fn effects(between: &[String; 2], law: &ContactLaw) -> Result<(), SetupError> {
    let asked: Vec<&Description> = active(law).collect();
    let has = |slot: Slot| asked.iter().any(|d| d.slot == slot);
    let value = |key: &str| law.number(key).unwrap_or(f64::NAN);
    let refuse = |key: &'static str, unit, values: String| {
        let quantity = Subject::Contact(Some(between.clone())).quantity(key);
        Err(out_of_range(quantity, value(key), unit, values))
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
    if used("stiffness") && !by_modulus(law) && law.number("stiffness").is_none() {
        return refuse("stiffness", "N/m", "laws with a stiffness or a modulus".to_owned());
    }
    match law.numbers().find(|(key, _)| !used(key)) {
        Some((key, _)) => refuse(key, "", "numbers that this law takes".to_owned()),
        None => Ok(()),
    }
}

/// Cohesion that would pull grains into each other, beyond the guard, without any load.
fn bound_grains(between: &[String; 2], c: &ContactLaw, setup: &Setup) -> Result<(), SetupError> {
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
    let check = Check(|| Subject::Contact(Some(between.clone())));
    let value = c.number(key).unwrap_or(0.0);
    check.within(key, value, unit, share < setup.guards.overlap, Allowed::BelowOverlapGuard)
}
