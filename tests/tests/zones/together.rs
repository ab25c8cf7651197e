//! Several planes: two in one step, an inlet and an outlet in one stage, the way back through them.

use super::zone;
use dem::Simulation;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::setups::{HOOKE, empty, grain, run_until};
use scene::advice::explain_halt;

/// Two planes within one step, the later one first in the list: the first that is passed records.
#[test]
fn of_two_planes_in_one_step_the_first_records() {
    let mut setup = empty(HOOKE, 0.5);
    setup.step = Step::Fixed(3e-4);
    setup.outlets = vec![zone(0.100_15, 0.03), zone(0.1, 0.03)];
    setup.particles = vec![Particle { velocity: Vec3::x(), ..grain(1, Vec3::new(0.0, 0.0, 0.0)) }];
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, 0.12);
    let found = sim.take_crossings();
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].outlet, 1);
    assert!((found[0].time - 0.1).abs() < 1e-12, "{}", found[0].time);
}

/// A middle stage: what comes in by the inlet is recorded at the outlet, also where both lie within one step.
#[test]
fn a_middle_stage_lets_in_and_records() {
    for gap in [0.05, 4e-5] {
        let mut setup = empty(HOOKE, 0.5);
        setup.step = Step::Fixed(1e-4);
        setup.inlets = vec![zone(0.0, 0.03)];
        setup.outlets = vec![zone(gap, 0.03)];
        (setup.smallest_entry, setup.largest_entry, setup.entry_materials) = (0.01, 0.01, vec![0]);
        let mut sim = Simulation::new(setup).expect("sound");
        let particle = Particle { velocity: Vec3::x(), ..grain(5, Vec3::new(-0.03, 0.0, 0.0)) };
        sim.enter(Entry { time: 0.001_03, inlet: 0, particle, clump: None, turn: None, cluster: 0 })
            .expect("in time");
        run_until(&mut sim, 0.2);
        let found = sim.take_crossings();
        assert_eq!(found.len(), 1, "gap {gap} m");
        assert!((found[0].time - (0.031_03 + gap)).abs() < 1e-12, "{}", found[0].time);
        assert_eq!(sim.particle_count(), 0);
    }
}

/// Seen behind the calculation plane it is counted once for each time; through the whole zone it stops the run.
#[test]
fn a_grain_that_goes_back_through_the_calculation_plane_is_counted() {
    let mut setup = empty(HOOKE, 0.5);
    setup.step = Step::Fixed(1e-4);
    setup.gravity = Vec3::new(-9.81, 0.0, 0.0);
    setup.inlets = vec![zone(0.0, 0.03)];
    (setup.smallest_entry, setup.largest_entry, setup.entry_materials) = (0.01, 0.01, vec![0]);
    setup.guards.cuts = 1;
    let mut sim = Simulation::new(setup).expect("sound");
    let particle = Particle { velocity: Vec3::x(), ..grain(5, Vec3::new(-0.03, 0.0, 0.0)) };
    sim.enter(Entry { time: 5e-5, inlet: 0, particle, clump: None, turn: None, cluster: 0 })
        .expect("in time");
    // Free at 0.0301 s, 50 µm past the plane; back on it 0.20392 s later, 0.03 m behind it soon after.
    let mut stopped = None;
    while stopped.is_none() && sim.time() < 0.3 {
        sim.step().expect("fine");
        let back = sim.look_back();
        let (counted, time) = (sim.returned().inlets[0], sim.time());
        assert_eq!(counted, u64::from(time > 0.234_02), "{time} s");
        stopped = back.err().map(|halt| (time, explain_halt(&halt)));
    }
    let (time, said) = stopped.expect("the run stops");
    assert!(
        said.contains("particle 5") && said.contains("inlet 0") && said.contains("guards.zones"),
        "{said}"
    );
    assert!(time > 0.26, "{time} s");
}

/// A free grain from beyond the storage plane comes upstream: counted, and recorded when it passes.
#[test]
fn a_grain_that_comes_upstream_is_counted_and_recorded_when_it_passes() {
    let mut setup = empty(HOOKE, 0.5);
    setup.step = Step::Fixed(1e-4);
    setup.gravity = Vec3::new(9.81, 0.0, 0.0);
    setup.outlets = vec![zone(0.0, 0.03)];
    setup.particles = vec![Particle { velocity: -Vec3::x(), ..grain(1, Vec3::new(0.01, 0.0, 0.0)) }];
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, 0.3);
    assert_eq!(sim.returned().outlets, [1]);
    assert_eq!(sim.take_crossings().len(), 1);
}

/// A moving wall in the zone does not move what travels there, and goes on moving what is free.
#[test]
fn a_moving_wall_in_the_zone_does_not_touch_what_travels() {
    let mut setup = empty(HOOKE, 0.5);
    setup.step = Step::Fixed(1e-4);
    setup.outlets = vec![zone(0.0, 0.1)];
    let spheres = (0..5).map(|k| (Vec3::new(0.05, 0.01 * f64::from(k), 0.0), 0.01)).collect();
    let motion = Motion { velocity: Vec3::new(0.0, -0.5, 0.0), ..Motion::still() };
    setup.walls = vec![Wall { motion, ..Wall::new("gate", 1, WallShape::Spheres(spheres)) }];
    setup.particles = vec![Particle { velocity: Vec3::x(), ..grain(1, Vec3::new(-0.012, 0.0, 0.0)) }];
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, 0.1);
    let p = sim.particles().expect("fine")[0];
    assert!((p.position - Vec3::new(sim.time() - 0.012, 0.0, 0.0)).norm() < 1e-12, "{}", p.position);
}

/// An entry that appears on top of a free grain stops the run, which names the one that comes in, its inlet and what to do.
#[test]
fn an_entry_on_top_of_a_free_grain_stops_the_run() {
    let mut setup = empty(HOOKE, 0.5);
    setup.step = Step::Fixed(1e-4);
    setup.inlets = vec![zone(0.0, 0.03)];
    setup.guards.cuts = 1;
    (setup.smallest_entry, setup.largest_entry, setup.entry_materials) = (0.01, 0.01, vec![0]);
    setup.particles = vec![grain(1, Vec3::new(-0.02, 0.0, 0.0))];
    let mut sim = Simulation::new(setup).expect("sound");
    let particle = Particle { velocity: Vec3::x(), ..grain(5, Vec3::new(-0.03, 0.0, 0.0)) };
    sim.enter(Entry { time: 0.001, inlet: 0, particle, clump: None, turn: None, cluster: 0 })
        .expect("in time");
    let mut said = None;
    while said.is_none() && sim.time() < 0.01 {
        said = sim.step().err().map(|halt| explain_halt(&halt));
    }
    let said = said.expect("the run stops");
    let words = [
        "particle 5 comes in by inlet 0",
        "on top of particle 1",
        "1.000e-2 m",
        "100.0 %",
        "stage-replay --ahead",
    ];
    for word in words {
        assert!(said.contains(word), "'{word}' is not in {said}");
    }
}
