//! Which keys of a scene call for what its engine does, and which are dropped.

use dem::setup::{self, Setup};
use scene::Scene;
use scene::keys::{Output, Wall};
use scene::plan::{dropped as dropped_of, most_specific};

/// Names of the two materials of a contact or a bond.
pub(super) fn pair(setup: &Setup, between: (u16, u16)) -> String {
    let name = |m: u16| setup.materials[m as usize].name.as_str();
    format!("{}–{}", name(between.0), name(between.1))
}

/// Adds a pair to those of a key.
pub(super) fn add_pair<K: PartialEq>(found: &mut Vec<(K, Vec<String>)>, key: K, pair: String) {
    match found.iter_mut().find(|(known, _)| *known == key) {
        Some((_, pairs)) => pairs.push(pair),
        None => found.push((key, vec![pair])),
    }
}

/// The entry that a contact comes from; `None`: a wall file.
pub(super) fn entry(scene: &Scene, setup: &Setup, c: &setup::ContactLaw) -> Option<usize> {
    let name = |m: u16| setup.materials[m as usize].name.as_str();
    most_specific(&scene.keys.contact, name(c.between.0), name(c.between.1))
}

/// What a scene asks for and cannot matter: key and pairs, and why.
pub(super) fn dropped(scene: &Scene, setup: &Setup) -> Vec<String> {
    let mut found = Vec::new();
    for c in &setup.contacts {
        let Some(at) = entry(scene, setup, c) else { continue };
        for (key, why) in dropped_of(&scene.keys.contact[at]) {
            add_pair(&mut found, (format!("contact.{at}.{key}"), why), pair(setup, c.between));
        }
    }
    let contacts =
        found.into_iter().map(|((key, why), pairs)| format!("{key} ({}): {why}", pairs.join(", ")));
    let used = |i: usize| setup.contacts.iter().any(|c| entry(scene, setup, c) == Some(i));
    let idle = (0..scene.keys.contact.len()).filter(|i| !used(*i));
    let idle = idle.map(|i| format!("contact.{i}: holds for no two materials that can meet"));
    let still = setup.walls.iter().filter(|w| !w.moves()).filter_map(|w| wall(scene, w));
    let mut still: Vec<String> = still
        .filter(|(_, entry)| entry.motion.is_some())
        .map(|(at, _)| format!("wall.{at}.motion: moves nothing"))
        .collect();
    still.dedup();
    contacts.chain(idle).chain(still).collect()
}

/// The entry that a wall comes from, with its number; `None`: a wall of the command line alone.
fn wall<'s>(scene: &'s Scene, wall: &setup::Wall) -> Option<(usize, &'s Wall)> {
    let comes = |(at, entry): &(usize, &Wall)| {
        let own = entry.name.clone().unwrap_or_else(|| format!("wall.{at}"));
        // A box has a wall for each face, a file one for each material: their names go on behind a blank.
        wall.name.strip_prefix(&own).is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
    };
    scene.keys.wall.iter().enumerate().find(comes)
}

/// Keys of the walls that move by themselves, or that follow a force.
pub(super) fn motions(scene: &Scene, setup: &Setup, servo: bool) -> String {
    let moving = setup.walls.iter().filter(|w| if servo { w.servo.is_some() } else { w.motion.moves() });
    let mut keys: Vec<String> = moving
        .map(|w| match wall(scene, w) {
            Some((at, entry)) if servo || entry.motion.is_some() => {
                let name = entry.name.as_ref().map_or(String::new(), |name| format!(" ({name})"));
                format!("wall.{at}.{}{name}", if servo { "servo" } else { "motion" })
            }
            _ => format!("the wall file of {}", w.name),
        })
        .collect();
    keys.dedup();
    keys.join(", ")
}

/// Keys of the walls whose surface moves on them.
pub(super) fn belts(scene: &Scene, setup: &Setup) -> String {
    let belts = setup.walls.iter().filter(|w| w.surface.moves());
    let mut keys: Vec<String> = belts
        .map(|w| match wall(scene, w) {
            Some((at, entry)) if entry.surface_velocity.is_some() || entry.surface_rotation.is_some() => {
                let turns = entry.surface_rotation.is_some();
                let key = if turns { "surface_rotation" } else { "surface_velocity" };
                let name = entry.name.as_ref().map_or(String::new(), |name| format!(" ({name})"));
                format!("wall.{at}.{key}{name}")
            }
            _ => format!("velocity in the wall file of {}", w.name),
        })
        .collect();
    keys.dedup();
    keys.join(", ")
}

/// Keys that call for the energy ledger.
pub(super) fn ledger(scene: &Scene) -> String {
    let Output { energy, contacts, wear, .. } = scene.keys.output;
    let guard = scene.keys.guards.energy_share().map(|share| format!("guards.energy = {share}"));
    let energy = energy.then(|| "output.energy = true".to_owned());
    // The work of sliding is known to the ledger alone.
    let contacts = contacts.then(|| "output.contacts = true".to_owned());
    let wear = wear.then(|| "output.wear = true".to_owned());
    [energy, contacts, wear, guard].into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// Keys of so many entries.
pub(super) fn numbered(key: &str, count: usize) -> String {
    match count {
        0..=3 => (0..count).map(|k| format!("{key}.{k}")).collect::<Vec<_>>().join(", "),
        _ => format!("{key}.0 to {key}.{}", count - 1),
    }
}
