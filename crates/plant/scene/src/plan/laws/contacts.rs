//! Which `[[contact]]` holds for which pair of materials: the most specific one.

use crate::check::Check;
use crate::error::Result;
use crate::keys::Contact;
use dem::effects::{Elastic, active, by_modulus, needed};
use dem::setup::{self, ContactLaw};
use geom::sphere::volume;
use std::cmp::Reverse;

/// One law for every pair that some entry of the scene matches. `largest` is the largest particle radius [m].
///
/// # Errors
/// An unknown material; two entries that are equally specific and differ.
pub(in crate::plan) fn resolve(
    check: &Check,
    entries: &[Contact],
    materials: &[setup::Material],
    largest: f64,
) -> Result<Vec<ContactLaw>> {
    for (i, entry) in entries.iter().enumerate() {
        for (k, name) in entry.between.iter().enumerate().filter(|(_, name)| *name != "*") {
            check.material(&format!("contact.{i}.between.{k}"), name, materials)?;
        }
    }
    let mut found = Vec::new();
    for a in 0..materials.len() {
        for b in a..materials.len() {
            let Some(entry) = best(check, entries, &materials[a].name, &materials[b].name)? else { continue };
            let mut law = entry.law.clone();
            law.between = (a as u16, b as u16);
            let linear = active(&law).any(|d| d.keys.iter().any(|key| key.name == STIFFNESS));
            if linear && !by_modulus(&law) && law.number(STIFFNESS).is_none() {
                law.set(STIFFNESS, stiffness(entry, &materials[a], &materials[b], largest));
            }
            found.push(needed(&law).0);
        }
    }
    Ok(found)
}

/// k_n of linear laws.
const STIFFNESS: &str = "stiffness";

/// What an entry asks for and its contact does not have: key with value, and why.
pub fn dropped(entry: &Contact) -> Vec<(String, String)> {
    let why = |instead: Option<&str>| match instead {
        None => "has no effect, and is not computed".to_owned(),
        Some(other) => format!("has no effect: \"{other}\" is computed instead"),
    };
    needed(&entry.law).1.into_iter().map(|d| (d.numbers, why(d.instead))).collect()
}

/// How specific an entry is for a pair, when it matches: the number of names that are no "*".
fn matches(entry: &Contact, a: &str, b: &str) -> Option<usize> {
    let fits = |pattern: &str, name: &str| pattern == "*" || pattern == name;
    let [p, q] = &entry.between;
    let hit = (fits(p, a) && fits(q, b)) || (fits(p, b) && fits(q, a));
    hit.then(|| [p, q].iter().filter(|s| s.as_str() != "*").count())
}

/// Which entry holds between two materials: the first of the most specific ones.
pub fn most_specific(entries: &[Contact], a: &str, b: &str) -> Option<usize> {
    let ranked = |(i, entry)| Some((matches(entry, a, b)?, Reverse(i)));
    entries.iter().enumerate().filter_map(ranked).max().map(|(_, Reverse(i))| i)
}

/// The entry that holds between two materials; refuses another one that is as specific and says otherwise.
fn best<'e>(check: &Check, entries: &'e [Contact], a: &str, b: &str) -> Result<Option<&'e Contact>> {
    let Some(first) = most_specific(entries, a, b) else { return Ok(None) };
    let best = &entries[first];
    for (i, entry) in entries.iter().enumerate().skip(first + 1) {
        let differs = || Contact { between: best.between.clone(), ..entry.clone() } != *best;
        if matches(entry, a, b) == matches(best, a, b) && differs() {
            let why =
                format!("contact.{first} says otherwise about {a} and {b}, and neither is more specific");
            let cure = format!("add a [[contact]] between = [\"{a}\", \"{b}\"]");
            let value = format!("{:?}", entry.between);
            return Err(check.wrong(&format!("contact.{i}.between"), value, &why, &cure));
        }
    }
    Ok(Some(best))
}

/// ```text
/// k = 16/15 √R* E* (15 m* v² / (16 √R* E*))^(1/5)      R* = R/2, m* = m/2
/// ```
///
/// The stiffness that stores as much at Hertz's deepest overlap for the characteristic speed v, for a pair of
/// the largest particles (E* of the pair of materials, the density of the heavier).
fn stiffness(entry: &Contact, a: &setup::Material, b: &setup::Material, largest: f64) -> f64 {
    let v = entry.characteristic_velocity.unwrap_or(1.0);
    let mass = volume(1.0) * largest.powi(3) * a.density.max(b.density) / 2.0;
    let stem = (largest / 2.0).sqrt() * Elastic::of(a, b).modulus;
    16.0 / 15.0 * stem * libm::pow(15.0 * mass * v * v / (16.0 * stem), 0.2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::Text;

    fn entry(a: &str, b: &str, restitution: f64) -> Contact {
        let law = ContactLaw::new((0, 0), "hertz").with("restitution", restitution);
        Contact { between: [a.into(), b.into()], law, characteristic_velocity: None }
    }

    fn solved(entries: &[Contact]) -> Result<Vec<ContactLaw>> {
        let text = Text::new("s", String::new());
        let material =
            |name: &str| setup::Material { name: name.into(), density: 1e3, young: 1e6, poisson: 0.3 };
        resolve(&Check { text: &text }, entries, &[material("sinter"), material("steel")], 0.01)
    }

    /// Every coefficient of 0 leaves the engine, and `--explain` lists it.
    #[test]
    fn what_does_nothing_is_dropped() {
        let mut nothing = entry("*", "*", 0.1);
        nothing.law.choose("law", "jkr");
        for key in ["work_of_adhesion", "sliding_friction", "rolling_resistance", "twisting_resistance"] {
            nothing.law.set(key, 0.0);
        }
        let kept = solved(std::slice::from_ref(&nothing)).unwrap().swap_remove(0);
        assert_eq!(kept, ContactLaw::new((0, 0), "hertz").with("restitution", 0.1));
        let keys: Vec<String> = dropped(&nothing).into_iter().map(|(key, _)| key).collect();
        let all = [
            "work_of_adhesion = 0 J/m²",
            "sliding_friction = 0",
            "rolling_resistance = 0",
            "twisting_resistance = 0",
        ];
        assert_eq!(keys, all);
    }

    #[test]
    fn the_most_specific_entry_holds() {
        let found =
            solved(&[entry("*", "*", 0.1), entry("steel", "*", 0.2), entry("steel", "sinter", 0.3)]).unwrap();
        let e = |a, b| found.iter().find(|c| c.between == (a, b)).unwrap().number("restitution").unwrap();
        assert_eq!((e(0, 0), e(0, 1), e(1, 1)), (0.1, 0.3, 0.2));
    }

    #[test]
    fn contradictions_are_refused_and_repetitions_are_not() {
        let message = solved(&[entry("sinter", "*", 0.1), entry("*", "steel", 0.2)]).unwrap_err().to_string();
        assert!(message.contains("sinter and steel") && message.contains("add a [[contact]]"), "{message}");
        assert!(solved(&[entry("sinter", "*", 0.1), entry("*", "steel", 0.1)]).is_ok());
        // The cure works wherever it is written.
        let cured = [entry("sinter", "*", 0.1), entry("*", "steel", 0.2), entry("steel", "sinter", 0.3)];
        assert!(solved(&cured).is_ok());
        let message = solved(&[entry("sintr", "*", 0.1)]).unwrap_err().to_string();
        assert!(message.contains("did you mean 'sinter'?"), "{message}");
    }

    #[test]
    fn pairs_that_nothing_matches_have_no_law() {
        assert_eq!(solved(&[entry("sinter", "sinter", 0.1)]).unwrap().len(), 1);
    }
}
