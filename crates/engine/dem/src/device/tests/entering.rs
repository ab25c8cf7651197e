//! Grains that come in while a device makes the steps.

use super::meshes::Random;
use super::*;
use crate::state::Forces;

/// A trough in which some grains lie, and an inlet above it, through which others come in at random times; everything else is drawn.
fn drawn(seed: u64) -> (Setup, Vec<Entry>) {
    let mut random = Random(seed.wrapping_mul(7919).wrapping_add(3));
    let effects = every_composition()[random.below(6)];
    let mut setup = if random.below(2) == 0 { trough(effects) } else { shaken(effects) };
    setup.particles.truncate(random.below(120));
    let plane = Plane::new(Vec3::new(0.0, 0.0, 0.07), -Vec3::z()).expect("a plane");
    let mut zone = Zone::new(plane, 0.03);
    zone.motion = [ZoneMotion::Constant, ZoneMotion::Ballistic][random.below(2)];
    zone.test = ZoneTest::ALL[random.below(2)];
    setup.inlets = vec![zone];
    setup.entry_materials = vec![0, 1];
    (setup.smallest_entry, setup.largest_entry) = (0.005, 0.0095);
    if random.below(2) == 0 {
        setup.sampling = Sampling::Sampled;
    }
    if random.below(3) == 0 {
        setup.periodic = [None; 3];
    }
    setup.guards.cuts = random.below(2) as u32;
    // Insertions look for room.
    if setup.guards.cuts == 0 && random.below(4) > 0 {
        zone.motion = ZoneMotion::Constant;
        zone.when_blocked = Some(
            [WhenBlocked::Wait, WhenBlocked::Skip, WhenBlocked::Stop][random.below(5).saturating_sub(2)],
        );
        setup.inlets = vec![zone];
    }
    let mut time = 0.001;
    let entries = (0..60)
        .map(|k| {
            // Some together, some long after the others.
            time += [0.0, 1e-5, 2e-4, 4e-3][random.below(4)];
            let particle = Particle {
                id: 2000 + 7 * k,
                material: random.below(2) as u16,
                radius: 0.005 + 0.0045 * random.next(),
                position: Vec3::new(0.02 + 0.12 * random.next(), 0.02 + 0.16 * random.next(), 0.1),
                velocity: Vec3::new(random.next() - 0.5, random.next() - 0.5, -0.5 - random.next()),
                spin: Vec3::new(random.next(), 0.0, 20.0 * random.next()),
            };
            Entry { time, inlet: 0, particle, clump: None, turn: None, cluster: 0 }
        })
        .collect();
    if random.below(3) == 0 {
        let law = [DragLaw::Stokes, DragLaw::SchillerNaumann][random.below(2)];
        let viscosity = [1.8e-5, 1e-2][random.below(2)];
        setup.drag = Some(Drag {
            law,
            viscosity,
            density: 900.0 * random.next(),
            velocity: Vec3::x(),
            buoyancy: random.below(2) == 0,
        });
    }
    if random.below(4) == 0 {
        setup.local_damping = Some(0.6 * random.next());
    }
    (setup, entries)
}

/// Makes steps up to one as a run does, and notes how the run ended.
fn run(sim: &mut Simulation, entries: &[Entry], next: &mut usize, last: u64) -> Result<(), Halt> {
    while sim.steps() < last {
        let horizon = sim.time() + sim.look_ahead();
        while entries.get(*next).is_some_and(|e| e.time <= horizon) {
            sim.enter(entries[*next]).expect("in time");
            *next += 1;
        }
        sim.advance(last, &mut |_| true)?;
    }
    Ok(())
}

#[test]
fn the_same_bits_where_grains_come_in() {
    let (mut entered, mut stopped, mut on_device, mut no_room) = (0, 0, 0, 0);
    for seed in 0..90 {
        let sims = [false, true].map(|there| {
            let mut sim = Simulation::new(drawn(seed).0).expect("sound");
            if there {
                sim.use_device(Box::new(Local::default())).expect("nothing that it does not compute");
            }
            sim
        });
        let ([mut host, mut device], [mut next, mut next_there]) = (sims, [0, 0]);
        let entries = drawn(seed).1;
        for last in [100, 600, 601, 1500, 4000] {
            let [a, b] = [(&mut host, &mut next), (&mut device, &mut next_there)]
                .map(|(sim, next)| run(sim, &entries, next, last).map_err(|halt| halt.to_string()));
            assert_eq!(a, b, "drawing {seed}");
            assert_eq!(host.steps(), device.steps(), "drawing {seed}");
            if a.is_err() {
                stopped += 1;
                break;
            }
            assert!(bits(&mut device) == bits(&mut host), "drawing {seed}, step {last}");
            let [a, b] = [&device, &host].map(|sim| &sim.state.contacts.history);
            assert!(a[..] == b[..], "drawing {seed}, step {last}: histories");
            assert_eq!(format!("{:?}", device.returned()), format!("{:?}", host.returned()));
        }
        entered += host.particle_count();
        no_room += host.returned().inserts.iter().map(|i| i.waited + i.skipped).sum::<u64>();
        on_device += usize::from(device.device_times().is_some_and(|times| times.stepping > 0.0));
    }
    assert!(entered > 3000 && on_device == 90 && no_room > 100, "{entered} {on_device} {no_room}");
    assert!(stopped > 5 && stopped < 65, "{stopped}");
}

/// A grain comes in onto another, until their overlap is just too deep: while it is in the zone, when it begins to move, or later.
#[test]
fn the_same_guard_when_a_grain_begins_to_move() {
    let grain = |id, z: f64, speed: f64| Particle {
        id,
        material: 0,
        radius: 0.009,
        position: Vec3::new(0.08, 0.1, z),
        velocity: Vec3::z() * -speed,
        spin: Vec3::zeros(),
    };
    let with = |overlap| {
        let mut setup = trough(every_composition()[2]);
        setup.particles = vec![grain(1, 0.05, 0.0)];
        setup.walls.clear();
        setup.gravity = Vec3::zeros();
        setup.guards.overlap = overlap;
        let plane = Plane::new(Vec3::new(0.0, 0.0, 0.0672), -Vec3::z()).expect("a plane");
        setup.inlets = vec![Zone::new(plane, 0.03)];
        setup.entry_materials = vec![0];
        (setup.smallest_entry, setup.largest_entry) = (0.005, 0.0095);
        setup
    };
    let particle = grain(2, 0.0972, 2.0);
    let entries = [Entry { time: 1e-4, inlet: 0, particle, clump: None, turn: None, cluster: 0 }];
    let mut kinds = [0, 0];
    for k in 0..300 {
        let setup = || with(0.02 + 4e-4 * f64::from(k));
        let mut host = Simulation::new(setup()).expect("sound");
        let mut device = there(setup(), Local::default());
        let [a, b] = [&mut host, &mut device]
            .map(|sim| run(sim, &entries, &mut 0, 4000).map_err(|halt| halt.to_string()));
        assert_eq!(a, b, "{k}");
        assert_eq!(host.steps(), device.steps(), "{k}");
        let [a, b] = [&host, &device].map(|sim| &sim.state);
        assert_eq!(a.forces == Forces::Known, b.forces == Forces::Known, "{k}");
        assert!(
            a.particles.rows == b.particles.rows && a.contacts.history[..] == b.contacts.history[..],
            "{k}"
        );
        let known = a.forces == Forces::Known;
        if known {
            assert!(a.contacts.sums.forces[..] == b.contacts.sums.forces[..], "{k}");
            assert!(a.particles.acceleration == b.particles.acceleration, "{k}");
        }
        kinds[usize::from(known)] += 1;
    }
    assert!(kinds[0] > 0 && kinds[1] > 0, "{kinds:?}");
}

/// What a guard takes out of the calculation stays in the lists of a device.
#[test]
fn what_a_guard_takes_out_is_refused() {
    let (mut setup, _) = drawn(0);
    (setup.guards.cuts, setup.guards.zones) = (1, CameBack::IsRemoved);
    let mut sim = Simulation::new(setup).expect("sound");
    let refused = sim.use_device(Box::new(Local::default())).expect_err("it does not compute that");
    assert_eq!(refused, ["grains that are taken out where they go back through an inlet"]);
}
