//! Recorded paths: sampled upstream, followed downstream.

use super::{flight, zone};
use dem::setup::*;
use dem::{Setup, Simulation};
use geom::Vec3;
use grainpipe_tests::setups::{HOOKE, empty, grain, particles, plane, run_until, with_friction};
use std::collections::BTreeMap;

fn recorded(x: f64, length: f64) -> Zone {
    Zone { motion: ZoneMotion::Recorded, ..zone(x, length) }
}

/// A fast grain hits a slow one just before the storage plane of x = 0.1 m.
fn two() -> Setup {
    let mut setup = flight();
    setup.outlets = vec![recorded(0.1, 0.03)];
    let moving = |id, x: f64, v: f64| Particle {
        velocity: Vec3::new(v, 0.0, 0.5),
        ..grain(id, Vec3::new(x, 0.0, 0.0))
    };
    setup.particles = vec![moving(1, 0.0, 1.0), moving(2, 0.06, 0.4)];
    setup
}

/// What a stage upstream tells: for each grain its samples, and how its path ends.
type Told = BTreeMap<u32, (Vec<(f64, Particle)>, Guide)>;

fn tell(setup: Setup, until: f64, every: u64) -> Told {
    let mut sim = Simulation::new(setup).expect("sound");
    let mut told = Told::new();
    while sim.time() < until {
        if sim.steps().is_multiple_of(every) {
            let time = sim.time();
            for s in sim.sample_paths() {
                let path = told.entry(s.particle.id).or_insert((Vec::new(), Guide::Gone));
                if !s.gone {
                    path.0.push((time, s.particle));
                }
            }
        }
        sim.step().expect("within the guards");
        for c in sim.take_crossings() {
            let end = Guide::Free(sample(c.time, &c.particle));
            told.get_mut(&c.particle.id).expect("it was on its way").1 = end;
        }
    }
    told
}

fn sample(time: f64, p: &Particle) -> Sample {
    Sample { time, position: p.position, velocity: p.velocity, spin: p.spin, turn: None }
}

fn downstream(told: &Told) -> Simulation {
    let mut setup = empty(HOOKE, 0.5);
    (setup.step, setup.gravity) = (Step::Fixed(1e-4), Vec3::new(0.0, 0.0, -9.81));
    setup.inlets = vec![recorded(0.1, 0.03)];
    guided(setup, told)
}

/// A stage downstream that gets its whole inlet at once.
fn guided(mut setup: Setup, told: &Told) -> Simulation {
    (setup.smallest_entry, setup.largest_entry, setup.entry_materials) = (0.01, 0.01, vec![0]);
    let mut sim = Simulation::new(setup).expect("sound");
    let mut paths: Vec<_> = told.values().collect();
    paths.sort_by(|a, b| a.0[0].0.total_cmp(&b.0[0].0));
    for (samples, end) in paths {
        let (time, particle) = samples[0];
        sim.enter(Entry { time, inlet: 0, particle, clump: None, turn: None, cluster: 0 }).expect("in order");
        for (time, p) in &samples[1..] {
            sim.guide(p.id, Guide::At(sample(*time, p))).expect("in order");
        }
        sim.guide(particle.id, *end).expect("its end");
    }
    sim
}

/// In the zone and behind it grains are where those of the undivided run are, though they have hit each other in the zone.
#[test]
fn grains_follow_what_they_did_upstream() {
    let told = tell(two(), 0.3, 5);
    assert!(told.values().all(|t| t.0.len() > 4 && matches!(t.1, Guide::Free(_))));
    let mut down = downstream(&told);
    let mut whole = Simulation::new(Setup { outlets: vec![], ..two() }).expect("sound");
    let (mut both, mut worst) = (0, 0.0f64);
    for step in 1..30 {
        let until = 0.01 * f64::from(step);
        run_until(&mut whole, until);
        run_until(&mut down, until);
        for p in particles(&mut down) {
            let all = particles(&mut whole);
            let there = all.iter().find(|q| q.id == p.id).expect("it is there, too");
            worst = worst.max((p.position - there.position).norm());
            both += 1;
        }
    }
    assert!(both > 30, "{both} grains compared");
    // Within a sample of the impact the path is smoothed, by a share of what grains overlap.
    assert!(worst < 2e-6, "{worst} m apart");
    assert_eq!(down.particle_count(), 2);
}

/// One that turns round before the plane is out downstream as soon as it is out of the samples.
#[test]
fn a_grain_that_goes_back_leaves_the_stage_downstream() {
    let mut setup = two();
    setup.gravity = Vec3::new(-9.81, 0.0, 0.0);
    setup.particles.truncate(1);
    // v²/2g: it turns at 0.09 m.
    setup.particles[0].velocity = Vec3::new((2.0f64 * 9.81 * 0.09).sqrt(), 0.0, 0.0);
    let told = tell(setup, 0.4, 5);
    assert!(told[&1].1 == Guide::Gone && told[&1].0.len() > 5);
    let (first, last) = (told[&1].0[0].0, told[&1].0.last().expect("some").0);
    let mut down = downstream(&told);
    run_until(&mut down, 0.5 * (first + last));
    assert_eq!(down.particle_count(), 1);
    run_until(&mut down, last + 2e-3);
    assert_eq!(down.particle_count(), 0);
    // The same grain may come again.
    let again = Entry {
        time: last + 0.1,
        inlet: 0,
        particle: grain(1, Vec3::new(0.08, 0.0, 0.0)),
        clump: None,
        turn: None,
        cluster: 0,
    };
    down.enter(again).expect("its id is free again");
}

/// One that is out of the samples for a moment, and seen again before the stage downstream has come to that: it goes on.
#[test]
fn a_grain_that_is_seen_again_goes_on() {
    let told = tell(two(), 0.3, 5);
    let (samples, end) = &told[&1];
    let (mut whole, mut again) = (downstream(&BTreeMap::new()), downstream(&BTreeMap::new()));
    let enter = |sim: &mut Simulation, (time, particle): (f64, Particle)| {
        sim.enter(Entry { time, inlet: 0, particle, clump: None, turn: None, cluster: 0 }).expect("in order");
    };
    for (k, &(time, p)) in samples.iter().enumerate() {
        if k == 0 {
            [&mut whole, &mut again].into_iter().for_each(|sim| enter(sim, (time, p)));
            continue;
        }
        whole.guide(1, Guide::At(sample(time, &p))).expect("in order");
        if k == 3 {
            again.guide(1, Guide::Gone).expect("in order");
            enter(&mut again, (time, p));
        } else {
            again.guide(1, Guide::At(sample(time, &p))).expect("in order");
        }
    }
    [&mut whole, &mut again].into_iter().for_each(|sim| sim.guide(1, *end).expect("its end"));
    for until in [0.05, 0.09, 0.2] {
        run_until(&mut whole, until);
        run_until(&mut again, until);
        assert_eq!(particles(&mut whole), particles(&mut again), "{until} s");
    }
    assert_eq!(whole.particle_count(), 1);
}

/// Grains roll along a plane, faster and faster, also in the zone: with them comes the energy of the spin that they are released with.
#[test]
fn the_ledger_closes_with_grains_that_turn_on_their_way_in() {
    let mut setup = with_friction(empty(HOOKE, 0.5), 0.5);
    (setup.step, setup.gravity, setup.ledger) = (Step::Fixed(2e-5), Vec3::new(4.0, 0.0, -9.0), true);
    setup.walls = vec![plane(Vec3::z())];
    let mut up = setup.clone();
    up.outlets = vec![recorded(0.3, 0.2)];
    up.particles = (0..4).map(|k| grain(k, Vec3::new(-0.03 * f64::from(k), 0.0, 0.01))).collect();
    let told = tell(up, 0.6, 10);
    assert!(told.len() == 4 && told.values().all(|t| matches!(t.1, Guide::Free(s) if s.spin.y > 50.0)));
    setup.inlets = vec![recorded(0.3, 0.2)];
    let mut down = guided(setup, &told);
    let start = down.energy().expect("sound").balance();
    run_until(&mut down, 0.7);
    let e = down.energy().expect("sound");
    assert_eq!(down.particle_count(), 4);
    // What the plane is pressed in by at the release is not told.
    let open = (e.balance() - start).abs() / e.translation;
    assert!(e.entered > 1e-3 && open < 2e-3, "{open} of {e:?}");
}

/// Behind the storage plane grains fall, as they would in the plant: those that pass slowly are out of the way of the next.
#[test]
fn grains_fall_behind_the_plane() {
    let mut setup = two();
    setup.gravity = Vec3::new(9.81, 0.0, 0.0);
    setup.particles.truncate(1);
    let start = setup.particles[0];
    setup.particles[0].velocity = Vec3::zeros();
    let mut sim = Simulation::new(setup).expect("sound");
    let fallen = |s: f64| (2.0 * s / 9.81).sqrt();
    run_until(&mut sim, fallen(0.12 - start.position.x));
    assert_eq!(sim.take_crossings().len(), 1);
    let there = particles(&mut sim)[0].position.x;
    let expected = start.position.x + 0.5 * 9.81 * sim.time().powi(2);
    assert!((there - expected).abs() < 1e-9, "{there} m instead of {expected} m");
}

/// Paths are part of the state.
#[test]
fn paths_resume_exactly() {
    let told = tell(two(), 0.3, 5);
    let mut whole = downstream(&told);
    let mut parts = downstream(&told);
    let setup = || {
        let mut setup = empty(HOOKE, 0.5);
        (setup.step, setup.gravity) = (Step::Fixed(1e-4), Vec3::new(0.0, 0.0, -9.81));
        setup.inlets = vec![recorded(0.1, 0.03)];
        (setup.smallest_entry, setup.largest_entry, setup.entry_materials) = (0.01, 0.01, vec![0]);
        setup
    };
    for until in [0.08, 0.09, 0.1, 0.11, 0.2] {
        run_until(&mut whole, until);
        run_until(&mut parts, until);
        parts = Simulation::resume(setup(), parts.checkpoint().to_static()).expect("the same setup");
        assert_eq!(particles(&mut whole), particles(&mut parts), "{until} s");
    }
}

/// A fast grain runs into a slow one that has just passed the plane: the slow one gives way as in the plant that is not divided, and the fast one passes
/// at the speed that it has after the collision. Each is there until the exclusion plane, and the ledger closes.
#[test]
fn behind_a_plane_of_recorded_paths_grains_give_way() {
    let mut setup = empty(HOOKE, 0.5);
    (setup.step, setup.ledger) = (Step::Fixed(2e-6), true);
    setup.outlets = vec![recorded(0.0, 0.05)];
    let moving = |id, x: f64, v: f64| Particle { velocity: Vec3::x() * v, ..grain(id, Vec3::x() * x) };
    setup.particles = vec![moving(1, -0.001, 0.2), moving(2, -0.03, 1.0)];
    let mut sim = Simulation::new(setup).expect("sound");
    let mut passed = Vec::new();
    let (mut left, mut balance) = (Vec::new(), Vec::new());
    while sim.time() < 0.25 {
        sim.step().expect("no guard");
        passed.extend(sim.take_crossings());
        let there = sim.particles().expect("ready").len();
        left.resize(2 - there, sim.time());
        balance.push(sim.energy().expect("ready").balance());
    }
    let speeds: Vec<(u32, f64)> = passed.iter().map(|c| (c.particle.id, c.particle.velocity.x)).collect();
    let [(1, first), (2, second)] = speeds[..] else { panic!("{speeds:?}") };
    assert!((first - 0.2).abs() < 1e-12, "{first}");
    // Equal masses, restitution 0.5: (1 + 0.2)/2 ∓ 0.5 (1 − 0.2)/2.
    assert!((second - 0.4).abs() < 1e-3, "{second}");
    // The first collided 0.01125 s after the start and went on at 0.8 m/s; the second passes at 0.4 m/s.
    let meet = 0.009 / 0.8;
    let ends = [meet + (0.051 - 0.2 * meet) / 0.8, meet + (0.08 - meet) / 0.4];
    for (left, end) in left.iter().zip(ends) {
        assert!((left - end).abs() < 2e-3, "{left} and not {end}");
    }
    let drift = balance.iter().map(|b| (b - balance[0]).abs()).fold(0.0, f64::max);
    let held = sim.returned().held_back[0];
    let mass = dem::mass(0.01, 2500.0);
    // What the second lost to the first.
    assert!((held.impulse / (0.6 * mass) - 1.0).abs() < 1e-3, "{held:?}");
    assert!(drift < 1e-12 * mass, "{drift:e} J");
}
