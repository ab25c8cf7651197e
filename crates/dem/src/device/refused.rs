//! What a device does not compute: refused by name before anything starts.

use crate::model::{Model, With};
use crate::setup::WallShape;
use crate::simd::Precision;
use crate::state::State;

/// What a scene asks for that a device does not compute; empty: nothing.
pub fn refused(model: &Model, state: &State) -> Vec<String> {
    let (setup, mut found) = (&model.setup, Vec::new());
    let mut refuse = |asked: bool, what: &str| {
        if asked {
            found.push(what.to_owned());
        }
    };
    refuse(!state.bonds.none(), "bonds");
    refuse(!state.clumps.none() || !setup.clumps.entries.is_empty(), "rigid clumps");
    refuse(!state.zones.none(), "grains that enter or leave while it runs");
    refuse(state.sleepers.is_some(), "sleep");
    refuse(state.strained.is_some(), "a strained domain");
    refuse(setup.drag.is_some(), "a fluid");
    refuse(setup.local_damping.is_some(), "local damping");
    refuse(setup.ledger, "the energy ledger");
    refuse(setup.precision != Precision::Double, "single precision");
    for (body, wall) in model.walls.iter().zip(&setup.walls) {
        refuse(body.answers(), &format!("wall '{}', which follows a force or stands on a spring", wall.name));
        refuse(matches!(wall.shape, WallShape::Mesh(_)), &format!("the triangles of wall '{}'", wall.name));
    }
    let name = |m: u16| &setup.materials[m as usize].name;
    for kind in model.kinds.iter().filter(|k| k.kernel.ported().is_none()) {
        let (a, b) = kind.between;
        let with = if let With::Wall(w) = kind.with { &setup.walls[w].name } else { name(b) };
        refuse(true, &format!("the contact law of {} and {with}", name(a)));
    }
    found.dedup();
    found
}
