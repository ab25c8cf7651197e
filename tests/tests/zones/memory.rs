//! What contacts remember goes through a cut: the spring of friction is downstream what it was upstream.

use super::{flight, zone};
use dem::setup::*;
use dem::{ContactRecord, Simulation};
use geom::Vec3;
use grainpipe_tests::setups::{HOOKE, empty, grain, with_friction};

/// Rubs, rolls and twists; with a normal law.
fn rough(setup: Setup, law: &'static str) -> Setup {
    let mut setup = with_friction(setup, 0.5);
    setup.contacts.iter_mut().for_each(|c| {
        c.choose("law", law);
        c.set("rolling_resistance", 0.3);
        c.set("twisting_resistance", 0.3);
    });
    (setup.gravity, setup.step) = (Vec3::zeros(), Step::Fixed(2e-5));
    setup
}

/// Two grains that press each other on their way to the storage plane, one rubbing along the other; the one behind has the lower id where `swapped`.
fn pair(swapped: bool, law: &'static str) -> Setup {
    let mut setup = rough(flight(), law);
    let (ahead, behind) = if swapped { (8, 7) } else { (7, 8) };
    setup.particles =
        vec![grain(ahead, Vec3::new(0.099, 0.0, 0.0)), grain(behind, Vec3::new(0.079_2, 0.001, 0.0))];
    setup.particles.iter_mut().for_each(|p| p.velocity.x = 1.0);
    setup.particles[0].velocity.y = 0.02;
    if law == "walton_braun" {
        // Pressed so that it unloads, and still pushes, at the crossing.
        setup.particles[1].velocity.x = 1.25;
    }
    setup.particles[1].spin = Vec3::new(3.0, 2.0, 1.0);
    setup
}

fn contact(sim: &mut Simulation) -> ContactRecord {
    let found: Vec<ContactRecord> =
        sim.record_contacts().expect("fine").into_iter().filter(|c| c.force != Vec3::zeros()).collect();
    assert_eq!(found.len(), 1, "they touch");
    found[0]
}

/// The first grain has just passed: its crossing, the one behind it, the contact; and the end of the step.
fn passed(swapped: bool, law: &'static str) -> (Crossing, Particle, ContactRecord, f64) {
    let mut sim = Simulation::new(pair(swapped, law)).expect("sound");
    loop {
        sim.step().expect("within the guards");
        if let Some(crossing) = sim.take_crossings().pop() {
            let behind = if swapped { 7 } else { 8 };
            let all = sim.particles().expect("fine");
            let other = *all.iter().find(|p| p.id == behind).expect("it is there");
            return (crossing, other, contact(&mut sim), sim.time());
        }
    }
}

/// Force between the two when the first is free downstream, told what its contact remembers, or not.
fn downstream(
    law: &'static str,
    crossing: &Crossing,
    other: &Particle,
    now: f64,
    told: bool,
) -> ContactRecord {
    let mut setup = rough(empty(HOOKE, 0.5), law);
    setup.inlets = vec![zone(0.100_03, 0.03)];
    (setup.smallest_entry, setup.largest_entry, setup.entry_materials) = (0.01, 0.01, vec![0]);
    setup.guards.motion = 1.0;
    let mut sim = Simulation::new(setup).expect("sound");
    let ahead = 0.0005;
    for (time, p) in [(crossing.time, &crossing.particle), (now, other)] {
        let particle = Particle { position: p.position - p.velocity * ahead, ..*p };
        sim.enter(Entry { time: time - ahead, inlet: 0, particle, clump: None, turn: None, cluster: 0 })
            .expect("in order");
    }
    if told {
        for touch in &crossing.touching {
            let partner = touch.partner.expect("a grain");
            sim.enter_history(PairHistory { id: touch.id, partner, history: touch.history });
        }
    }
    while sim.time() < now - 1e-9 {
        sim.step().expect("within the guards");
    }
    contact(&mut sim)
}

/// Length of a field of a contact's history.
fn length(touch: &Touch, field: &str) -> f64 {
    touch.history.get(field).iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[test]
fn a_contact_goes_on_with_its_springs() {
    for (swapped, law) in [(false, "hooke"), (true, "hooke"), (false, "walton_braun"), (true, "walton_braun")]
    {
        let (crossing, other, upstream, now) = passed(swapped, law);
        let [touch] = &crossing.touching[..] else { panic!("{} contacts", crossing.touching.len()) };
        assert_eq!((touch.id, touch.partner), (crossing.particle.id, Some(other.id)));
        assert!(
            length(touch, "sliding") > 1e-7
                && length(touch, "rolling") > 1e-5
                && length(touch, "twisting") > 1e-5,
            "{:?}",
            touch.history
        );
        assert_eq!(length(touch, "held") > 1e-4, law == "walton_braun", "{:?}", touch.history);
        // On the one that passes.
        let along = |c: &ContactRecord| {
            let force = if c.i == crossing.particle.id { c.force } else { -c.force };
            force - c.normal * force.dot(&c.normal)
        };
        let with = downstream(law, &crossing, &other, now, true);
        let without = downstream(law, &crossing, &other, now, false);
        let size = along(&upstream).norm();
        let (near, far) =
            ((along(&with) - along(&upstream)).norm(), (along(&without) - along(&upstream)).norm());
        // Upstream the first is pushed on from its passage to the end of the step, which the dashpots feel; downstream it is not.
        // What yields slid under another normal force; without its history that is another by far.
        let least = if law == "hooke" { size } else { 0.3 * size };
        assert!(near < 0.02 * size && far > least, "{near} N and {far} N of {size} N apart");
        if law == "walton_braun" {
            let [push, kept, forgotten] = [&upstream, &with, &without].map(|c| c.force.norm());
            assert!(
                (kept / push - 1.0).abs() < 0.02 && (forgotten / push - 1.0).abs() > 0.2,
                "{push}, {kept}, {forgotten} N"
            );
        }
    }
}

/// Nothing is kept of a grain that is free already, or never was announced.
#[test]
fn memory_that_comes_too_late_is_of_no_effect() {
    let (crossing, ..) = passed(false, "hooke");
    let mut setup = rough(empty(HOOKE, 0.5), "hooke");
    setup.inlets = vec![zone(0.100_03, 0.03)];
    (setup.smallest_entry, setup.largest_entry, setup.entry_materials) = (0.01, 0.01, vec![0]);
    let mut sim = Simulation::new(setup).expect("sound");
    let empty = format!("{:?}", sim.checkpoint());
    sim.enter_history(PairHistory { id: 7, partner: 8, history: crossing.touching[0].history });
    assert_eq!(format!("{:?}", sim.checkpoint()), empty);
}
