//! What a device does not compute: refused by name before anything starts.

use crate::device::kinds::numbers_of;
use crate::model::Model;
use crate::setup::{CameBack, Setup, WallDetail, Zone, ZoneMotion};
use crate::state::State;
use laws::effects::{ContactLaw, active};
use laws::simd::Precision;

/// Sums of walls, with the key that asks for them.
fn wall_sums(setup: &Setup) -> &'static str {
    match setup.wall_sums {
        WallDetail::Parts => "wear of walls (output.wear, which keeps the energy ledger)",
        _ if setup.walls.iter().any(|wall| wall.servo.is_some()) => {
            "forces on walls over all steps (output.wall_forces; a servo has them, too)"
        }
        _ => "forces on walls over all steps (output.wall_forces)",
    }
}

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
    refuse(!setup.outlets.is_empty(), "grains that leave while it runs");
    refuse(!setup.removals.is_empty(), "grains that are taken out of a region ([[remove]])");
    let enters = !setup.inlets.is_empty();
    let follows = |zone: &Zone| zone.motion == ZoneMotion::Recorded;
    refuse(setup.inlets.iter().any(follows), "grains that come in along recorded paths");
    // Particles that were removed stay in the lists of a device.
    let taken_out = setup.guards.zones == CameBack::IsRemoved && setup.guards.cuts > 0;
    refuse(enters && taken_out, "grains that are taken out where they go back through an inlet");
    refuse(state.sleepers.is_some(), "sleep");
    refuse(state.strained.is_some(), "a strained domain");
    refuse(setup.ledger || setup.guards.energy.is_finite(), "the energy ledger");
    refuse(!state.wall_sums.none(), wall_sums(setup));
    refuse(setup.precision != Precision::Double, "contacts in single precision");
    for (body, wall) in model.walls.iter().zip(&setup.walls) {
        refuse(body.answers(), &format!("wall '{}', which follows a force or stands on a spring", wall.name));
    }
    if setup.precision == Precision::Double {
        for kind in model.kinds.iter().filter(|k| numbers_of(k).is_none()) {
            let (a, b) = kind.between;
            let name = |m: u16| &setup.materials[m as usize].name;
            let of = |law: &&ContactLaw| law.between == (a, b) || law.between == (b, a);
            let effects = setup.contacts.iter().find(of).into_iter().flat_map(active).map(|d| d.name);
            let effects = effects.collect::<Vec<_>>().join(" + ");
            refuse(true, &format!("the contact law of {} and {} ({effects})", name(a), name(b)));
        }
    }
    found.dedup();
    found
}
