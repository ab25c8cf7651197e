//! Which `[[contact]]` holds for which pair of materials: the most specific one.

use crate::check::Check;
use crate::error::{SceneError, nearest};
use crate::model::{Contact, Friction, Law, RollingModel};
use dem::setup;

/// One law for every pair that some entry of the scene matches. `largest` is the largest particle radius [m].
///
/// # Errors
/// An unknown material; two entries that are equally specific and differ.
pub(crate) fn resolve(
    check: &Check,
    entries: &[Contact],
    materials: &[setup::Material],
    largest: f64,
) -> Result<Vec<setup::Contact>, SceneError> {
    for (i, entry) in entries.iter().enumerate() {
        for (k, name) in entry.between.iter().enumerate() {
            known(check, &format!("contact.{i}.between.{k}"), name, materials)?;
        }
    }
    let mut found = Vec::new();
    for a in 0..materials.len() {
        for b in a..materials.len() {
            let Some(entry) = best(check, entries, &materials[a].name, &materials[b].name)? else { continue };
            found.push(contact(
                entry,
                (a as u16, b as u16),
                law(entry, &materials[a], &materials[b], largest),
            ));
        }
    }
    Ok(found)
}

/// What an entry asks for; an effect that does nothing is absent.
fn contact(entry: &Contact, between: (u16, u16), law: setup::Law) -> setup::Contact {
    let positive = |x: Option<f64>| x.filter(|x| *x > 0.0);
    let (sliding_friction, weakening) = match entry.sliding_friction {
        None => (None, None),
        Some(Friction::Constant(mu)) => (positive(Some(mu)), None),
        Some(Friction::Weakening(w)) => {
            (Some(w.at_rest), Some(setup::Weakening { dynamic: w.dynamic, speed: w.speed }))
        }
    };
    setup::Contact {
        cohesion: positive(entry.cohesion_energy_density.filter(|_| entry.cohesion.is_some())),
        sliding_friction,
        weakening,
        rolling_resistance: positive(entry.rolling_resistance),
        rolling_model: match entry.rolling_model {
            Some(RollingModel::Constant) => setup::RollingModel::Constant,
            Some(RollingModel::Spring) | None => setup::RollingModel::Spring,
        },
        twisting_resistance: positive(entry.twisting_resistance),
        ..setup::Contact::new(between, law, entry.restitution)
    }
}

pub(crate) fn known(
    check: &Check,
    key: &str,
    name: &str,
    materials: &[setup::Material],
) -> Result<(), SceneError> {
    let names = || materials.iter().map(|m| m.name.as_str());
    if name == "*" || names().any(|m| m == name) {
        return Ok(());
    }
    let cure = match nearest(name, names()) {
        Some(near) => format!("did you mean '{near}'?"),
        None => format!("known: {}, and \"*\" for all", names().collect::<Vec<_>>().join(", ")),
    };
    Err(check.wrong(key, format!("\"{name}\""), "no [[material]] has this name", &cure))
}

/// How specific an entry is for a pair, when it matches: the number of names that are no "*".
fn matches(entry: &Contact, a: &str, b: &str) -> Option<usize> {
    let fits = |pattern: &str, name: &str| pattern == "*" || pattern == name;
    let [p, q] = &entry.between;
    let hit = (fits(p, a) && fits(q, b)) || (fits(p, b) && fits(q, a));
    hit.then(|| [p, q].iter().filter(|s| s.as_str() != "*").count())
}

/// Which entry holds between two materials: the first of the most specific ones.
pub(crate) fn most_specific(entries: &[Contact], a: &str, b: &str) -> Option<usize> {
    let mut best: Option<(usize, usize)> = None;
    for (i, entry) in entries.iter().enumerate() {
        best = best.max(matches(entry, a, b).map(|rank| (rank, usize::MAX - i)));
    }
    best.map(|(_, i)| usize::MAX - i)
}

fn best<'e>(
    check: &Check,
    entries: &'e [Contact],
    a: &str,
    b: &str,
) -> Result<Option<&'e Contact>, SceneError> {
    let mut best: Option<(usize, usize)> = None;
    for (i, entry) in entries.iter().enumerate() {
        let Some(rank) = matches(entry, a, b) else { continue };
        match best {
            Some((top, first)) if top == rank => {
                let other = &entries[first];
                if (Contact { between: other.between.clone(), ..entry.clone() }) != *other {
                    let why = format!(
                        "contact.{first} says otherwise about {a} and {b}, and neither is more specific"
                    );
                    let cure = format!("add a [[contact]] between = [\"{a}\", \"{b}\"]");
                    let value = format!("{:?}", entry.between);
                    return Err(check.wrong(&format!("contact.{i}.between"), value, &why, &cure));
                }
            }
            Some((top, _)) if top > rank => {}
            _ => best = Some((rank, i)),
        }
    }
    Ok(best.map(|(_, i)| &entries[i]))
}

/// ```text
/// k = 16/15 √R* E* (15 m* v² / (16 √R* E*))^(1/5)      R* = R/2, m* = m/2
/// ```
///
/// The stiffness that stores as much at Hertz's deepest overlap for the characteristic speed v, for a pair of
/// the largest particles (E* of the pair of materials, the density of the heavier).
fn law(entry: &Contact, a: &setup::Material, b: &setup::Material, largest: f64) -> setup::Law {
    match (entry.law, entry.work_of_adhesion) {
        (Law::Hooke, _) => {}
        (Law::Jkr, Some(work_of_adhesion)) if work_of_adhesion > 0.0 => {
            return setup::Law::Jkr { work_of_adhesion };
        }
        _ => return setup::Law::Hertz,
    }
    let stiffness = entry.stiffness.unwrap_or_else(|| {
        let v = entry.characteristic_velocity.unwrap_or(1.0);
        let modulus =
            1.0 / ((1.0 - a.poisson * a.poisson) / a.young + (1.0 - b.poisson * b.poisson) / b.young);
        let mass = 4.0 / 3.0 * std::f64::consts::PI * largest.powi(3) * a.density.max(b.density) / 2.0;
        let stem = (largest / 2.0).sqrt() * modulus;
        16.0 / 15.0 * stem * libm::pow(15.0 * mass * v * v / (16.0 * stem), 0.2)
    });
    setup::Law::Hooke { stiffness, tangential_ratio: entry.tangential_ratio }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::Text;

    fn entry(a: &str, b: &str, restitution: f64) -> Contact {
        Contact {
            between: [a.into(), b.into()],
            law: Law::Hertz,
            stiffness: None,
            characteristic_velocity: None,
            tangential_ratio: None,
            restitution,
            work_of_adhesion: None,
            cohesion: None,
            cohesion_energy_density: None,
            sliding_friction: None,
            rolling_resistance: None,
            rolling_model: None,
            twisting_resistance: None,
        }
    }

    fn solved(entries: &[Contact]) -> Result<Vec<setup::Contact>, SceneError> {
        let text = Text::new("s", String::new());
        let material =
            |name: &str| setup::Material { name: name.into(), density: 1e3, young: 1e6, poisson: 0.3 };
        resolve(&Check { text: &text }, entries, &[material("sinter"), material("steel")], 0.01)
    }

    #[test]
    fn the_most_specific_entry_holds() {
        let found =
            solved(&[entry("*", "*", 0.1), entry("steel", "*", 0.2), entry("steel", "sinter", 0.3)]).unwrap();
        let e = |a, b| found.iter().find(|c| c.between == (a, b)).unwrap().restitution;
        assert_eq!((e(0, 0), e(0, 1), e(1, 1)), (0.1, 0.3, 0.2));
    }

    #[test]
    fn contradictions_are_refused_and_repetitions_are_not() {
        let message = solved(&[entry("sinter", "*", 0.1), entry("*", "steel", 0.2)]).unwrap_err().to_string();
        assert!(message.contains("sinter and steel") && message.contains("add a [[contact]]"), "{message}");
        assert!(solved(&[entry("sinter", "*", 0.1), entry("*", "steel", 0.1)]).is_ok());
        let message = solved(&[entry("sintr", "*", 0.1)]).unwrap_err().to_string();
        assert!(message.contains("did you mean 'sinter'?"), "{message}");
    }

    #[test]
    fn pairs_that_nothing_matches_have_no_law() {
        assert_eq!(solved(&[entry("sinter", "sinter", 0.1)]).unwrap().len(), 1);
    }
}
