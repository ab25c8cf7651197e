//! The materials of the walls around a specimen, where the sample defines none of that name.
//!
//! `side`: smooth walls. `plate`: rough plates, as rough as grains among each other.

use crate::composing::compose::Composition;
use toml_edit::{Item, Table, Value};

/// Smooth walls.
pub(crate) const SIDE: &str = "side";
/// Rough plates.
pub(crate) const PLATE: &str = "plate";
/// Keys of a `[[contact]]` that need sliding friction.
const OF_FRICTION: [&str; 4] =
    ["rolling_resistance", "twisting_resistance", "rolling_model", "tangential_damping"];

/// Adds `side` and `plate`, with contacts to every material of the sample.
pub(crate) fn add_materials(scene: &mut Composition) {
    let names: Vec<String> =
        scene.entries("material").filter_map(|m| Some(m.get("name")?.as_str()?.to_owned())).collect();
    let own = |name: &str| names.iter().any(|n| n == name);
    let grains: Vec<&String> = names.iter().filter(|n| ![SIDE, PLATE].contains(&n.as_str())).collect();
    let Some(first) = scene.entries("material").next().map(|table| table.clone()) else { return };
    let contacts: Vec<Table> = scene.entries("contact").map(|table| table.clone()).collect();
    for wall in [SIDE, PLATE].into_iter().filter(|wall| !own(wall)) {
        let mut material = first.clone();
        material.insert("name", toml_edit::value(wall));
        scene.add(&format!("[[material]]\n{}", plain(&material)));
        for grain in &grains {
            let Some(at) = between(&contacts, grain) else { continue };
            let mut contact = contacts[at].clone();
            contact.insert("between", Item::Value([wall, grain.as_str()].iter().copied().collect::<Value>()));
            if wall == SIDE {
                set_friction(&mut contact, 0.0);
            }
            scene.add(&format!("[[contact]]\n{}", plain(&contact)));
        }
    }
}

/// The entry that holds between two grains of a material: the first of the most specific ones.
fn between(contacts: &[Table], grain: &str) -> Option<usize> {
    let names = |table: &Table| -> Option<Vec<String>> {
        table.get("between")?.as_array()?.iter().map(|n| n.as_str().map(str::to_owned)).collect()
    };
    let rank = |table: &Table| {
        let names = names(table)?;
        let fits = names.len() == 2 && names.iter().all(|n| n == grain || n == "*");
        fits.then(|| names.iter().filter(|n| *n == grain).count())
    };
    let ranked =
        contacts.iter().enumerate().filter_map(|(i, table)| Some((rank(table)?, std::cmp::Reverse(i))));
    ranked.max().map(|(_, at)| at.0)
}

/// Sets the sliding friction of a `[[contact]]`; without any, what needs it goes too.
pub(crate) fn set_friction(contact: &mut Table, friction: f64) {
    contact.insert("sliding_friction", toml_edit::value(friction));
    if friction == 0.0 {
        OF_FRICTION.iter().for_each(|key| drop(contact.remove(key)));
    }
}

/// Raises the restitution of a `[[contact]]` to a least value; one with a dashpot of its own keeps it.
pub(crate) fn raise_restitution(contact: &mut Table, least: f64) {
    let own = contact.get("restitution").and_then(|r| {
        let text = r.as_str().and_then(|text| geom::units::parse(text, "").ok());
        r.as_float().or(r.as_integer().map(|i| i as f64)).or(text)
    });
    if own.is_some_and(|own| own < least) {
        contact.insert("restitution", toml_edit::value(least));
    }
}

/// The keys of a table, one in a line, without comments.
fn plain(table: &Table) -> String {
    let line = |(key, item): (&str, &Item)| {
        let value = item.clone().into_value().unwrap_or_else(|_| Value::from(""));
        format!("{key} = {}\n", value.decorated("", ""))
    };
    table.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_low_restitution_is_raised() {
        let raised = |given: &str| {
            let mut scene = Composition::new(format!("[[contact]]\n{given}\n").parse().unwrap());
            scene.entries("contact").for_each(|contact| raise_restitution(contact, 0.9));
            scene.text()
        };
        for low in ["restitution = 0.2", "restitution = 0", "restitution = \"20 %\""] {
            assert!(raised(low).contains("restitution = 0.9"), "{low}");
        }
        for kept in ["restitution = 0.95", "normal_damping = 3"] {
            assert!(raised(kept).contains(kept) && !raised(kept).contains("0.9\n"), "{kept}");
        }
    }

    #[test]
    fn walls_have_the_contacts_of_the_grains() {
        let text = "[[material]]\nname = \"sand\"\nyoung = 1e7 # Pa\n[[contact]]\nbetween = [\"*\", \"*\"]\nsliding_friction = 0.9\n\
            [[contact]]\nbetween = [\"sand\", \"sand\"]\nsliding_friction = { static = 0.5, dynamic = 0.4, speed = 1 }\nrolling_resistance = 0.1\n";
        let mut scene = Composition::new(text.parse().unwrap());
        add_materials(&mut scene);
        let text = scene.text();
        let added = &text[text.find("[[material]]\nname = \"side\"").unwrap()..];
        assert_eq!(
            added,
            "[[material]]\nname = \"side\"\nyoung = 1e7\n\n[[contact]]\nbetween = [\"side\", \"sand\"]\nsliding_friction = 0.0\n\n\
             [[material]]\nname = \"plate\"\nyoung = 1e7\n\n[[contact]]\nbetween = [\"plate\", \"sand\"]\n\
             sliding_friction = { static = 0.5, dynamic = 0.4, speed = 1 }\nrolling_resistance = 0.1\n"
        );
    }
}
