//! Which `[[contact]]` holds for which pair of materials: the most specific one.

use crate::check::Check;
use crate::error::{SceneError, nearest};
use crate::model::{Contact, Friction, Law, RollingModel, Weakening};
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
        Some(Friction::Weakening(w)) if w.at_rest == 0.0 && w.dynamic == 0.0 => (None, None),
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

/// What an entry asks for and its contact does not have: key with value, and why.
pub(crate) fn dropped(entry: &Contact, kept: &setup::Contact) -> Vec<(String, &'static str)> {
    const NOTHING: &str = "does nothing, and nothing of it is computed";
    let mut found = Vec::new();
    if entry.law == Law::Jkr && kept.law == setup::Law::Hertz {
        let why = "law = \"jkr\" that does not adhere is \"hertz\", which is computed in its place";
        found.push(("work_of_adhesion = 0".to_owned(), why));
    }
    match entry.sliding_friction.filter(|_| kept.sliding_friction.is_none()) {
        None => {}
        Some(Friction::Constant(mu)) => found.push((format!("sliding_friction = {mu}"), NOTHING)),
        Some(Friction::Weakening(w)) => {
            let Weakening { at_rest, dynamic, speed } = w;
            let table = format!("{{ static = {at_rest}, dynamic = {dynamic}, speed = {speed} }}");
            found.push((format!("sliding_friction = {table}"), NOTHING));
        }
    }
    for (key, asked, kept) in [
        ("cohesion_energy_density", entry.cohesion_energy_density, kept.cohesion),
        ("rolling_resistance", entry.rolling_resistance, kept.rolling_resistance),
        ("twisting_resistance", entry.twisting_resistance, kept.twisting_resistance),
    ] {
        if let (Some(value), None) = (asked, kept) {
            found.push((format!("{key} = {value}"), NOTHING));
        }
    }
    found
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

    /// Every coefficient of 0 leaves the engine and is told, and one that is not stays and is not.
    #[test]
    fn what_does_nothing_is_dropped_and_told() {
        let weakening =
            |at_rest, dynamic| Some(Friction::Weakening(Weakening { at_rest, dynamic, speed: 1.0 }));
        let of = |value: f64| Contact {
            law: Law::Jkr,
            work_of_adhesion: Some(value),
            sliding_friction: Some(Friction::Constant(value)),
            rolling_resistance: Some(value),
            twisting_resistance: Some(value),
            ..entry("*", "*", 0.1)
        };
        let told = |entry: Contact| {
            let kept = solved(std::slice::from_ref(&entry)).unwrap().swap_remove(0);
            let keys = dropped(&entry, &kept).into_iter().map(|(key, _)| key).collect::<Vec<_>>();
            (kept, keys.join(", "))
        };
        let (kept, keys) = told(of(0.0));
        assert_eq!(kept, setup::Contact::new((0, 0), setup::Law::Hertz, 0.1));
        let all =
            "work_of_adhesion = 0, sliding_friction = 0, rolling_resistance = 0, twisting_resistance = 0";
        assert_eq!(keys, all);
        assert_eq!(told(of(0.5)).1, "");
        let cohesion = Some(crate::model::Cohesion::Sjkr);
        let sticky = Contact { cohesion, cohesion_energy_density: Some(0.0), ..entry("*", "*", 0.1) };
        assert_eq!(told(sticky).1, "cohesion_energy_density = 0");
        let rubs = |friction| told(Contact { sliding_friction: friction, ..entry("*", "*", 0.1) });
        let (kept, keys) = rubs(weakening(0.0, 0.0));
        assert_eq!((kept.sliding_friction, kept.weakening), (None, None));
        assert_eq!(keys, "sliding_friction = { static = 0, dynamic = 0, speed = 1 }");
        let (kept, keys) = rubs(weakening(0.0, 0.2));
        assert!(kept.sliding_friction == Some(0.0) && kept.weakening.is_some() && keys.is_empty());
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
