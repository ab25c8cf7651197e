//! Storage and calculation planes at their limits.

use crate::variants::{run, simulation, variants};
use dem::setup::*;
use dem::{Setup, Simulation};
use geom::{Plane, Vec3};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::grain;
use scene::advice::explain_setup_error;

const SHORT: Case = case(
    "Rest and extremes",
    "a zone shorter than the largest particle is refused, with the length it needs",
);
const BOTH: Case = case(
    "Rest and extremes",
    "several crossings of a storage plane in one step: each is recorded at its time and position",
);
const ASTRIDE: Case = case(
    "Rest and extremes",
    "a contact across a storage plane: its force has no jump at the crossing, largest change per step over that of other steps",
);

fn zone(x: f64, length: f64) -> Zone {
    Zone::new(Plane { point: Vec3::new(x, 0.0, 0.0), normal: Vec3::x() }, length)
}

#[test]
fn a_zone_shorter_than_the_largest_particle_is_refused() {
    for variant in variants() {
        for length in [0.0, 0.0199, 0.02, f64::NAN] {
            let mut out = variant.smooth(0.5);
            out.particles = vec![grain(1, Vec3::zeros()), Particle { radius: 0.003, ..grain(2, Vec3::x()) }];
            out.outlets = vec![zone(0.1, length)];
            let mut into = variant.smooth(0.5);
            (into.smallest_entry, into.largest_entry, into.entry_materials) = (0.003, 0.01, vec![0]);
            into.inlets = vec![zone(0.1, length)];
            for (what, setup) in [("outlet", out), ("inlet", into)] {
                let said = explain_setup_error(&Simulation::new(setup).err().expect("refused"));
                SHORT.refused(
                    &format!("{}, {what} of {length} m", variant.name()),
                    &said,
                    &["2.0000e-2 m", "2.4000e-2 m"],
                );
            }
        }
    }
}

/// Six grains pass in one step, two of them at the same instant, in a random order of their ids.
#[test]
fn crossings_in_one_step_are_all_recorded() {
    for variant in variants() {
        let mut setup = Setup { step: Step::Fixed(1e-4), ..variant.smooth(0.5) };
        setup.outlets = vec![zone(0.1, 0.03)];
        let share = [0.3, 0.9, 0.0001, 0.5, 0.5, 0.7];
        setup.particles = (0..6u32)
            .map(|k| {
                // At this share of the step after the tenth it is on the plane.
                let x = 0.1 - 1e-4 * (10.0 + share[k as usize]);
                let velocity = Vec3::x();
                Particle { velocity, ..grain(40 - 3 * k, Vec3::new(x, 0.05 * f64::from(k), 0.0)) }
            })
            .collect();
        let mut sim = simulation(setup);
        run(&mut sim, 10);
        assert!(sim.take_crossings().is_empty(), "not yet");
        run(&mut sim, 1);
        let found = sim.take_crossings();
        let mut expected: Vec<(f64, u32)> =
            (0..6u32).map(|k| (1e-4 * (10.0 + share[k as usize]), 40 - 3 * k)).collect();
        expected.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
        assert_eq!(found.len(), 6, "{}", variant.name());
        let mut worst: f64 = 0.0;
        for (c, (time, _)) in found.iter().zip(&expected) {
            worst = worst.max((c.time - time).abs()).max((c.particle.position.x - 0.1).abs());
        }
        BOTH.within(&variant.name(), worst, "s and m", 1e-15);
        let mut ids: Vec<u32> = found.iter().map(|c| c.particle.id).collect();
        ids.sort_unstable();
        assert_eq!(ids, [25, 28, 31, 34, 37, 40], "{}", variant.name());
    }
}

/// One grain pushes another through the plane: while the first is handed over, the second feels no jerk.
#[test]
fn a_contact_astride_the_plane_goes_on() {
    for variant in variants() {
        let mut setup = variant.rough(0.5, 0.5);
        setup.step = Step::Auto(0.1);
        setup.outlets = vec![zone(0.0, 0.03)];
        let moving = |id, x: f64, v: [f64; 3]| Particle {
            velocity: Vec3::from(v),
            ..grain(id, Vec3::new(x, 0.0, 0.0))
        };
        setup.particles = vec![moving(1, -0.0011, [1.0, 0.0, 0.0]), moving(2, -0.0211, [1.2, 0.02, 0.0])];
        let mut sim = simulation(setup);
        let (mut before, mut at_hand_over, mut others) = (Vec3::zeros(), 0.0f64, 0.0f64);
        let (mut handed, mut held) = (None, 0.0);
        for step in 0..4000u64 {
            run(&mut sim, 1);
            let records = sim.record_contacts().expect("fine");
            // On the one that is not handed over.
            let force = records.iter().map(|c| if c.i == 2 { c.force } else { -c.force }).sum::<Vec3>();
            let jump = (force - before).norm();
            if !sim.take_crossings().is_empty() {
                (handed, held) = (Some(step), force.norm());
                assert!(force.norm() > 0.1, "{}: the two touch: {force:?}", variant.name());
            }
            match handed {
                Some(h) if step <= h + 1 => at_hand_over = at_hand_over.max(jump),
                // The jump of a contact that is made or broken is its own (adhesion).
                _ if force != Vec3::zeros() && before != Vec3::zeros() => others = others.max(jump),
                _ => {}
            }
            before = force;
            if handed.is_some() && force == Vec3::zeros() {
                break;
            }
        }
        assert!(handed.is_some(), "{}", variant.name());
        assert!(
            held > 3.0 * others,
            "{}: to let go would be seen: {held} N, steps of {others} N",
            variant.name()
        );
        ASTRIDE.within(&variant.name(), at_hand_over / others, "–", 1.0);
    }
}
