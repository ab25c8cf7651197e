//! Rigid clumps pass planes as one: their centre is tested, they keep their spin in zones, and come in as they were recorded.

use super::zone;
use dem::setup::*;
use dem::{ClumpState, SetupError, Simulation};
use geom::{Moments, Vec3};
use grainpipe_tests::setups::{HOOKE, empty, grain, particles, run_until};
use nalgebra::UnitQuaternion;

/// Three spheres that are in one line in no frame.
fn hook() -> ClumpShape {
    let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
    let spheres = [(at(0.0, 0.0, 0.0), 0.006), (at(0.01, 0.0, 0.0), 0.005), (at(0.012, 0.008, 0.002), 0.004)];
    ClumpShape::new("hook", 0, &spheres, &Moments::of_union(&spheres).expect("spheres that touch"))
}

const LENGTH: f64 = 0.06;

fn setup() -> Setup {
    let mut setup = empty(HOOKE, 0.5);
    setup.step = Step::Fixed(5e-5);
    setup.clumps.shapes = vec![hook()];
    setup
}

fn body(id: u32, x: f64) -> Body {
    let orientation = UnitQuaternion::from_euler_angles(0.3, -0.8, 0.5);
    let (position, velocity) = (Vec3::new(x, 0.0, 0.0), Vec3::new(1.0, 0.1, -0.2));
    Body { id, shape: 0, scale: 1.0, position, orientation, velocity, spin: Vec3::new(20.0, -35.0, 10.0) }
}

/// A clump that flies through the storage plane of x = 0.10003 m.
fn upstream() -> Setup {
    let mut setup = setup();
    setup.outlets = vec![zone(0.100_03, LENGTH)];
    setup.clumps.placed = vec![body(7, 0.0)];
    setup
}

fn state(sim: &mut Simulation) -> ClumpState {
    sim.clumps().expect("within the guards")[0]
}

/// The only crossing until a time.
fn crossing(sim: &mut Simulation, until: f64) -> Crossing {
    run_until(sim, until);
    let mut found = sim.take_crossings();
    assert_eq!(found.len(), 1, "one row for the whole clump");
    found.remove(0)
}

#[test]
fn a_clump_is_recorded_when_its_centre_passes() {
    let mut sim = Simulation::new(upstream()).expect("sound");
    let c = crossing(&mut sim, 0.13);
    assert!((c.time - 0.100_03).abs() < 1e-12, "{}", c.time);
    let p = c.particle;
    assert_eq!((p.id, p.radius), (7, hook().reach()));
    assert!((p.position - p.velocity * c.time).norm() < 1e-12, "{}", p.position);
    // Nothing turns it but itself: a run without the plane has these axes and this spin.
    let mut whole = Simulation::new(Setup { outlets: vec![], ..upstream() }).expect("sound");
    run_until(&mut whole, 0.1 - 1e-9);
    let (before, clump) = (state(&mut whole), c.clump.expect("a clump"));
    let turned = before.orientation.angle_to(&clump.orientation);
    // Its spin changes on the way, with L that stays.
    let miss = turned - 3e-5 * before.spin.norm();
    assert!(miss.abs() < 1e-6, "turned on by {turned}, {miss} too much");
    assert!((p.spin - before.spin).norm() < 3e-3 * before.spin.norm(), "{} after {}", p.spin, before.spin);
}

#[test]
fn a_clump_keeps_its_form_and_spin_in_the_zone_and_leaves_it_whole() {
    let mut sim = Simulation::new(upstream()).expect("sound");
    let c = crossing(&mut sim, 0.13);
    let members = sim.particles().expect("within the guards");
    assert_eq!(members.len(), 3);
    let centre = c.particle.position + c.particle.velocity * (sim.time() - c.time);
    let turn = UnitQuaternion::from_scaled_axis(c.particle.spin * (sim.time() - c.time))
        * c.clump.expect("a clump").orientation;
    let shape = hook();
    for (m, (place, _)) in members.iter().zip(&shape.spheres) {
        let r = turn * (shape.frame * place);
        let miss = (m.position - centre - r).norm();
        assert!(miss < 1e-12, "{miss} m");
        let velocity = c.particle.velocity + c.particle.spin.cross(&r);
        let miss = (m.velocity - velocity).norm() + (m.spin - c.particle.spin).norm();
        assert!(miss < 1e-10, "{miss} m/s and rad/s");
    }
    let body = state(&mut sim);
    let miss = (body.position - centre).norm() + 1e-5 * body.orientation.angle_to(&turn);
    assert!(miss < 1e-12, "{miss}");
    assert!((body.spin - c.particle.spin).norm() < 1e-10, "{}", body.spin);
    run_until(&mut sim, 0.17);
    assert!(sim.particle_count() == 0 && sim.clumps().expect("fine").is_empty(), "all of it has left");
}

/// One leaves, one stays, and another comes: rows, bodies and members stay together, also after lists were rebuilt and after a resume.
#[test]
fn who_stays_is_who_it_was() {
    let mut setup = upstream();
    setup.clumps.placed = vec![body(7, 0.0), body(20, -0.3), body(30, -0.8)];
    setup.clumps.placed[1].velocity = Vec3::new(0.3, 0.0, 0.0);
    setup.particles = vec![grain(50, Vec3::new(-0.2, 0.1, 0.0))];
    setup.skin = Some(0.002);
    let mut sim = Simulation::new(setup.clone()).expect("sound");
    run_until(&mut sim, 0.2);
    let saved = sim.checkpoint().to_static();
    let mut again = Simulation::resume(setup, saved).expect("its own state");
    run_until(&mut sim, 0.4);
    run_until(&mut again, 0.4);
    let (one, other) = (sim.clumps().expect("fine"), again.clumps().expect("fine"));
    assert_eq!(one, other, "the same bits");
    let ids: Vec<u32> = one.iter().map(|b| b.id).collect();
    assert_eq!(ids, [20, 30]);
    assert!(
        (one[0].position - Vec3::new(-0.3 + 0.3 * sim.time(), 0.0, 0.0)).norm() < 1e-9,
        "{}",
        one[0].position
    );
    let members = sim.particles().expect("fine");
    assert_eq!(members.iter().map(|p| p.id).collect::<Vec<_>>(), [20, 21, 22, 30, 31, 32, 50]);
}

/// Replayed as it was recorded, a clump flies on as in the undivided run.
#[test]
fn a_clump_comes_in_as_it_was_recorded() {
    let mut sim = Simulation::new(upstream()).expect("sound");
    let c = crossing(&mut sim, 0.13);
    let ahead = LENGTH / c.particle.velocity.x;
    let mut setup = setup();
    setup.inlets = vec![zone(0.100_03, LENGTH)];
    setup.clumps.entries = vec![ClumpScales { shape: 0, least: 1.0, most: 1.0 }];
    let mut down = Simulation::new(setup).expect("sound");
    let particle = Particle { position: c.particle.position - c.particle.velocity * ahead, ..c.particle };
    let clump = c.clump.map(|clump| clump.turned(&(c.particle.spin * -ahead)));
    down.enter(Entry { time: c.time - ahead, inlet: 0, particle, clump, turn: None, cluster: 0 })
        .expect("in time");
    let mut whole = Simulation::new(Setup { outlets: vec![], ..upstream() }).expect("sound");
    for until in [0.1003, 0.2, 0.5] {
        run_until(&mut down, until);
        run_until(&mut whole, until);
        let (a, b) = (state(&mut down), state(&mut whole));
        assert!((a.position - b.position).norm() < 1e-9, "{}", a.position - b.position);
        // Within the step of its passage it turns at a constant rate, not with a constant angular momentum.
        let apart = a.orientation.angle_to(&b.orientation);
        assert!(apart < 1e-4 * (0.1 + until), "{apart} rad apart at {until} s");
        let miss = (a.angular_momentum - b.angular_momentum).norm() / b.angular_momentum.norm();
        assert!(miss < 1e-5, "{miss} of the angular momentum at {until} s");
    }
}

/// Along a recorded path it is where the undivided run has it, and turned as there, all of its members; and the ledger closes.
#[test]
fn a_clump_follows_what_it_did_upstream() {
    let mut up = upstream();
    up.outlets[0].motion = ZoneMotion::Recorded;
    let mut sim = Simulation::new(up.clone()).expect("sound");
    let mut setup = setup();
    (setup.inlets, setup.clumps.entries, setup.ledger) =
        (up.outlets.clone(), vec![ClumpScales { shape: 0, least: 1.0, most: 1.0 }], true);
    let mut down = Simulation::new(setup).expect("sound");
    let mut first = true;
    while sim.time() < 0.13 {
        let time = sim.time();
        let samples = if sim.steps().is_multiple_of(10) { sim.sample_paths() } else { Vec::new() };
        for s in samples {
            let (p, clump) = (s.particle, s.clump);
            let turn = clump.map(|c| c.orientation);
            let at = Sample { time, position: p.position, velocity: p.velocity, spin: p.spin, turn };
            if std::mem::take(&mut first) {
                down.enter(Entry { time, inlet: 0, particle: p, clump, turn: None, cluster: 0 })
                    .expect("in time");
            } else {
                down.guide(p.id, Guide::At(at)).expect("in order");
            }
        }
        sim.step().expect("free");
        for c in sim.take_crossings() {
            let (p, turn) = (c.particle, c.clump.map(|c| c.orientation));
            let at = Sample { time: c.time, position: p.position, velocity: p.velocity, spin: p.spin, turn };
            down.guide(p.id, Guide::Free(at)).expect("in order");
        }
    }
    let mut whole = Simulation::new(Setup { outlets: vec![], ..up }).expect("sound");
    let start = down.energy().expect("sound").balance();
    for until in [0.05, 0.08, 0.1, 0.1003, 0.2, 0.5] {
        run_until(&mut down, until);
        run_until(&mut whole, until);
        let (here, there) = (particles(&mut down), particles(&mut whole));
        assert!(here.len() == 3 && here.iter().zip(&there).all(|(a, b)| a.id == b.id));
        // Between samples it turns at a constant rate.
        let worst =
            here.iter().zip(&there).map(|(a, b)| (a.position - b.position).norm()).fold(0.0, f64::max);
        assert!(worst < 2e-6 * (0.1 + until), "{worst} m apart at {until} s");
        let e = down.energy().expect("sound");
        assert!((e.balance() - start).abs() <= 1e-8 * e.translation, "{e:?}");
    }
}

#[test]
fn what_planes_cannot_do_with_clumps_is_refused() {
    let mut setup = upstream();
    setup.outlets[0].test = ZoneTest::Lowest;
    let refused = Simulation::new(setup).err().expect("refused");
    assert!(matches!(refused, SetupError::ClumpOutlet(_)), "{refused}");
    let mut short = upstream();
    short.outlets[0].length = 0.02;
    let refused = Simulation::new(short).err().expect("refused");
    assert!(matches!(refused, SetupError::ZoneTooShort { .. }), "{refused}");
}
