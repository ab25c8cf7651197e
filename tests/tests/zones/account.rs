//! The ledger of stages: what grains take along through a cut and bring in again, with walls, with each other, and with the ledger on both sides.

use super::*;
use dem::Energy;
use geom::mesh::TriMesh;

/// Direction of flow down a chute of 30°, and across it.
fn axes() -> [Vec3; 2] {
    let (sin, cos) = 30f64.to_radians().sin_cos();
    [Vec3::new(cos, 0.0, -sin), Vec3::new(sin, 0.0, cos)]
}

/// A chute: a plane, two triangles, or spheres.
fn chutes() -> [(&'static str, WallShape); 3] {
    let [down, up] = axes();
    let at = |u: f64, y: f64| down * u + Vec3::y() * y;
    let corners = [at(-0.5, -0.2), at(0.8, -0.2), at(0.8, 0.2), at(-0.5, 0.2)].to_vec();
    let mesh = TriMesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).expect("sound");
    let row = |k: i32| (-3..=3).map(move |n| at(0.012 * f64::from(k), 0.012 * f64::from(n)) - up * 0.08);
    let spheres = (-15..60).flat_map(row).map(|c| (c, 0.08)).collect();
    let plane = Plane { point: Vec3::zeros(), normal: up };
    [
        ("plane", WallShape::Plane(plane)),
        ("mesh", WallShape::Mesh(mesh)),
        ("spheres", WallShape::Spheres(spheres)),
    ]
}

/// A heap of grains that slides down a chute.
fn plant(shape: WallShape) -> Setup {
    let [down, up] = axes();
    let mut setup = with_friction(empty(HOOKE, 0.5), 0.2);
    setup.step = Step::Fixed(1e-5);
    setup.gravity = Vec3::new(0.0, 0.0, -9.81);
    setup.ledger = true;
    setup.walls = vec![Wall::new("chute", 1, shape)];
    let place = |k: u32| {
        let (i, j, n) = (k % 3, k / 3 % 2, k / 6);
        down * (0.0195 * f64::from(i))
            + Vec3::y() * (0.0195 * f64::from(j))
            + up * (0.0101 + 0.0195 * f64::from(n))
    };
    setup.particles = (0..12).map(|k| Particle { velocity: down * 0.5, ..grain(k, place(k)) }).collect();
    setup
}

fn cut(motion: ZoneMotion) -> Zone {
    Zone { motion, ..Zone::new(Plane { point: axes()[0] * 0.1, normal: axes()[0] }, 0.03) }
}

/// The ledger now and then, and what has crossed.
fn run(mut sim: Simulation, mut feed: Vec<Entry>, until: f64) -> (Vec<Energy>, Vec<Crossing>) {
    let (mut seen, mut crossed) = (Vec::new(), Vec::new());
    let mut next = 0.0;
    feed.reverse();
    while sim.time() < until {
        while let Some(entry) = feed.pop_if(|e| e.time < sim.time() + sim.look_ahead()) {
            sim.enter(entry).expect("in time");
        }
        sim.step().expect("no guard");
        crossed.extend(sim.take_crossings());
        if sim.time() >= next {
            seen.push(sim.energy().expect("ready"));
            next += 0.002;
        }
    }
    (seen, crossed)
}

/// The largest energy that the step has made so far [J].
fn made(seen: &[Energy]) -> f64 {
    seen.iter().map(|e| e.integration.abs()).fold(0.0, f64::max)
}

#[test]
fn a_cut_makes_no_energy_on_either_side() {
    let until = 0.35;
    for (name, shape) in chutes() {
        let whole = plant(shape.clone());
        let (undivided, _) = run(Simulation::new(whole.clone()).expect("sound"), vec![], until);
        let end = undivided.last().expect("it ran");
        let (exchanged, own) = (end.exchanged(), made(&undivided));
        for motion in ZoneMotion::ALL {
            let up = Setup { outlets: vec![cut(motion)], ..whole.clone() };
            let (upstream, crossed) = run(Simulation::new(up).expect("sound"), vec![], until);
            assert_eq!(crossed.len(), 12, "{name}: all pass");
            let mut down = Setup { inlets: vec![cut(motion)], particles: vec![], ..whole.clone() };
            (down.smallest_entry, down.largest_entry, down.entry_materials) = (0.01, 0.01, vec![0]);
            let entry = |c: &Crossing| Entry {
                time: c.time,
                inlet: 0,
                particle: c.particle,
                clump: None,
                turn: None,
                cluster: 0,
            };
            let feed = crossed.iter().map(entry).collect();
            let mut sides = vec![("upstream", upstream)];
            // Along paths what comes in moves as it did upstream, where these make no energy either.
            if motion != ZoneMotion::Recorded {
                sides.push(("downstream", run(Simulation::new(down).expect("sound"), feed, until).0));
            }
            for (side, seen) in &sides {
                let start = seen[0].balance();
                let drift = seen.iter().map(|e| (e.balance() - start).abs()).fold(0.0, f64::max);
                assert!(
                    drift < 1e-12 * exchanged,
                    "{name} {motion:?} {side}: the sum of all terms drifts by {drift:e} J"
                );
                let made = made(seen);
                assert!(
                    made < 1.1 * own,
                    "{name} {motion:?} {side}: the step made {made:e} J, undivided {own:e} J of {exchanged:e} J"
                );
            }
        }
    }
}

/// Grains one above the other begin to fall through a plane: at constant velocity those in the zone are in the way of those that follow; in free fall
/// they are not.
#[test]
fn a_zone_that_holds_back_the_stream_is_measured() {
    let held = |motion: ZoneMotion| {
        let mut setup = empty(HOOKE, 0.5);
        setup.step = Step::Fixed(2e-5);
        setup.gravity = Vec3::new(0.0, 0.0, -9.81);
        setup.outlets =
            vec![Zone { motion, ..Zone::new(Plane { point: Vec3::zeros(), normal: -Vec3::z() }, 0.05) }];
        let column = |k: u32| grain(k, Vec3::z() * (0.02 + 0.0201 * f64::from(k)));
        setup.particles = (0..30).map(column).collect();
        let mut sim = Simulation::new(setup).expect("sound");
        while sim.time() < 0.4 {
            sim.step().expect("no guard");
        }
        sim.returned().held_back[0]
    };
    let [constant, falling] = [ZoneMotion::Constant, ZoneMotion::Ballistic].map(held);
    assert!(falling.passed == 30 && constant.passed < 20, "{} and {} pass", falling.passed, constant.passed);
    assert!(constant.impulse > 0.1 * constant.momentum, "{constant:?}");
    assert!(falling.impulse.abs() < 1e-9 * falling.momentum, "{falling:?}");
    // What passed: each at the speed of its fall.
    let fallen = |k: u32| (2.0 * 9.81 * (0.02 + 0.0201 * f64::from(k))).sqrt();
    let momentum = dem::mass(0.01, 2500.0) * (0..30).map(fallen).sum::<f64>();
    assert!((falling.momentum / momentum - 1.0).abs() < 1e-9, "{} of {momentum}", falling.momentum);
}

/// Grains that pass a stage from its inlet to its outlet without ever being free touch a wall on their way through the zone: what is left of their energies
/// by rounding is nothing that the guard stops for.
#[test]
fn a_stage_without_free_grains_is_not_stopped_for_rounding() {
    let [down, up] = axes();
    let bump = |k: i32| (down * 0.085 - up * 0.08 + Vec3::y() * (0.0037 * f64::from(k)), 0.0803);
    let mut setup = Setup { particles: vec![], ..plant(WallShape::Spheres((-3..9).map(bump).collect())) };
    setup.guards.energy = 0.02;
    let zone = |at: f64| Zone {
        motion: ZoneMotion::Constant,
        ..Zone::new(Plane { point: down * at, normal: down }, 0.03)
    };
    (setup.inlets, setup.outlets) = (vec![zone(0.1)], vec![zone(0.1 + 1e-9)]);
    (setup.smallest_entry, setup.largest_entry, setup.entry_materials) = (0.01, 0.01, vec![0]);
    let entry = |k: u32| {
        let position = down * 0.07 + up * 0.0097 + Vec3::y() * 0.0199 * f64::from(k % 2);
        let particle = Particle { velocity: down * 0.7, ..grain(k, position) };
        Entry {
            time: 0.01 + 0.02 * f64::from(k / 2),
            inlet: 0,
            particle,
            clump: None,
            turn: None,
            cluster: 0,
        }
    };
    let (seen, crossed) = run(Simulation::new(setup).expect("sound"), (0..24).map(entry).collect(), 0.4);
    assert_eq!(crossed.len(), 24);
    assert!(seen.iter().all(|e| e.exchanged() + e.held() < 1e-9), "none is ever free");
}
