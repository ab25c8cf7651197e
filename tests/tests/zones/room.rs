//! What is inserted comes in where there is room for it, and pushes with no more than it brings.

use super::*;
use dem::{Halt, NoRoom};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// A zone of insertion, downward to z = 0.1 m.
fn insertion(length: f64, when_blocked: WhenBlocked) -> Zone {
    let plane = Plane { point: Vec3::new(0.0, 0.0, 0.1), normal: -Vec3::z() };
    Zone { when_blocked: Some(when_blocked), ..Zone::new(plane, length) }
}

fn entry(id: u32, time: f64, position: Vec3, speed: f64) -> Entry {
    let particle = Particle { velocity: -Vec3::z() * speed, ..grain(id, position) };
    Entry { time, inlet: 0, particle, clump: None, turn: None, cluster: 0 }
}

/// Grains and an insertion among them, without loss.
fn setup(particles: Vec<Particle>, zone: Zone) -> Setup {
    let mut setup = empty(HOOKE, 1.0);
    setup.step = Step::Fixed(1e-5);
    setup.ledger = true;
    setup.particles = particles;
    setup.inlets = vec![zone];
    (setup.smallest_entry, setup.largest_entry) = (0.004, 0.01);
    setup.entry_materials = vec![0];
    setup
}

/// What an insertion found no room for, or why it stopped.
fn run(
    sim: &mut Simulation,
    entries: &[Entry],
    until: f64,
    mut each: impl FnMut(&mut Simulation),
) -> Result<NoRoom, Halt> {
    let mut next = 0;
    while sim.time() < until {
        while entries.get(next).is_some_and(|e| e.time <= sim.time() + sim.look_ahead()) {
            sim.enter(entries[next]).expect("in time");
            next += 1;
        }
        sim.step()?;
        each(sim);
    }
    Ok(sim.returned().inserts[0])
}

/// One grain rests in the entrance, and is hit by nothing that has not hit it with its own momentum.
#[test]
fn a_grain_in_the_entrance_is_not_pushed_away() {
    let resting = Particle { radius: 0.01, ..grain(1, Vec3::new(0.008, 0.0, 0.195)) };
    for when in WhenBlocked::ALL {
        let mut sim = Simulation::new(setup(vec![resting], insertion(0.1, when))).expect("sound");
        let entries = [entry(2, 0.001, Vec3::new(0.0, 0.0, 0.2), 0.1)];
        let found = run(&mut sim, &entries, 0.2, |_| ());
        let none = NoRoom::default();
        match (when, found) {
            (WhenBlocked::Wait, Ok(found)) => assert_eq!(found, NoRoom { waited: 1, waiting: 1, ..none }),
            (WhenBlocked::Skip, Ok(found)) => assert_eq!(found, NoRoom { skipped: 1, ..none }),
            (WhenBlocked::Stop, Err(Halt::NoRoom { id: 2, partner: 1, .. })) => {
                assert!(sim.particles().is_err(), "it stays where it was stopped");
                continue;
            }
            other => panic!("{other:?}"),
        }
        let moves = particles(&mut sim).iter().map(|p| p.velocity.norm()).fold(0.0, f64::max);
        assert!(moves == 0.0, "{when:?}: {moves} m/s");
    }
}

/// One that meets a grain on its way collides with it as two free grains do.
#[test]
fn what_meets_a_grain_on_its_way_is_free_from_then_on() {
    for offset in [0.0, 0.004, 0.009] {
        let resting = grain(1, Vec3::new(offset, 0.0, 0.15));
        let zone = insertion(0.1, WhenBlocked::Wait);
        let mut inserted = Simulation::new(setup(vec![resting], zone)).expect("sound");
        let coming = entry(2, 0.0, Vec3::new(0.0, 0.0, 0.2), 0.5);
        run(&mut inserted, &[coming], 0.2, |_| ()).expect("no guard");
        let mut free = setup(vec![resting, coming.particle], zone);
        free.inlets.clear();
        let mut free = Simulation::new(free).expect("sound");
        run_until(&mut free, 0.2);
        let [a, b] = [&mut inserted, &mut free].map(particles);
        for id in [1, 2] {
            let [a, b] = [&a, &b].map(|all| all.iter().find(|p| p.id == id).expect("there").velocity);
            // Free a step after they meet.
            assert!((a - b).norm() < 2e-3, "{offset}: {id} moves at {a:?}, not {b:?}");
        }
        let energy = inserted.energy().expect("ready");
        assert!(energy.integration.abs() < 1e-3 * energy.translation, "{offset}: {energy:?}");
    }
}

/// Nothing that comes in lands on another grain, all that was given is there, waits or was left out, and no energy comes from nowhere.
#[test]
fn random_insertions_among_moving_grains_never_begin_with_an_overlap() {
    let (mut waited, mut skipped, mut came, mut early) = (0, 0, 0, 0);
    for seed in 0..40 {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let mut draw = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
        let place = |k: u32| Vec3::new(f64::from(k % 4), f64::from(k / 4 % 4), f64::from(k / 16)) * 0.022;
        let there = (0..48).filter(|_| draw(0.0, 1.0) < 0.7).collect::<Vec<u32>>();
        let there = there.iter().map(|&k| Particle {
            radius: draw(0.006, 0.0105),
            velocity: Vec3::new(draw(-0.3, 0.3), draw(-0.3, 0.3), draw(-0.3, 0.3)),
            ..grain(k, place(k) + Vec3::z() * 0.11)
        });
        let there: Vec<Particle> = there.collect();
        let when = [WhenBlocked::Wait, WhenBlocked::Skip][seed as usize % 2];
        let speed = draw(0.2, 1.5);
        let mut time = 0.0;
        let entries: Vec<Entry> = (0..60)
            .map(|k| {
                time += draw(0.0, 0.006);
                let mut entry =
                    entry(100 + k, time, Vec3::new(draw(0.0, 0.066), draw(0.0, 0.066), 0.17), speed);
                entry.particle.radius = draw(0.004, 0.01);
                entry
            })
            .collect();
        let begun = there.len();
        let mut setup = setup(there, insertion(0.07, when));
        // In long steps grains are listed long before they come in, and what is free is elsewhere by then.
        setup.step = Step::Fixed([1e-5, 4e-5][draw(0.0, 2.0) as usize]);
        setup.gravity.z = [0.0, -9.81, 9.81][draw(0.0, 3.0) as usize];
        let mut sim = Simulation::new(setup).expect("sound");
        let mut seen: Vec<u32> = Vec::new();
        let found = run(&mut sim, &entries, 0.25, |sim| {
            let all = particles(sim);
            let dt = sim.dt();
            for new in all.iter().filter(|p| p.id >= 100 && !seen.contains(&p.id)).collect::<Vec<_>>() {
                for other in all.iter().filter(|p| p.id != new.id) {
                    let overlap = new.radius + other.radius - (new.position - other.position).norm();
                    // As fast as the two can have met; a contact that begins in one of the last two steps before it comes in is seen a step later.
                    let fast = speed + other.velocity.norm();
                    assert!(
                        overlap < 3.0 * fast * dt + 1e-8,
                        "seed {seed}: {} onto {}: {overlap} m",
                        new.id,
                        other.id
                    );
                }
                seen.push(new.id);
            }
        });
        let NoRoom { waited: w, waiting, skipped: s } = found.expect("no guard");
        // Of what is due: nothing is decided before.
        let due = entries.iter().filter(|e| e.time <= sim.time()).count() as u64;
        assert_eq!(seen.len() as u64 + waiting + s, due, "seed {seed}");
        assert!(sim.still_to_come() >= waiting, "seed {seed}");
        assert_eq!(sim.particle_count(), begun + seen.len(), "seed {seed}");
        let energy = sim.energy().expect("ready");
        assert!(
            energy.integration.abs() < 2e-3 * (energy.entered + energy.translation),
            "seed {seed}: {} J made of {} J",
            energy.integration,
            energy.entered
        );
        let above = particles(&mut sim).iter().filter(|p| p.id >= 100 && p.position.z > 0.1).count();
        (waited, skipped, came, early) = (waited + w, skipped + s, came + seen.len(), early + above);
    }
    assert!(waited > 100 && skipped > 100 && came > 500 && early > 50, "{waited} {skipped} {came} {early}");
}

/// A wall on the way stops it; one that it touches from the beginning it comes in through.
#[test]
fn a_wall_on_the_way_bears_what_is_inserted() {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let wall = |z: f64| {
        let corners = corners.map(|[x, y]| Vec3::new(x, y, z)).to_vec();
        let mesh = geom::mesh::TriMesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).expect("sound");
        Wall::new("wall", 0, WallShape::Mesh(mesh))
    };
    // Through a lid at the entrance, and onto a floor half-way.
    for (walls, ends) in [(vec![wall(0.2)], -1.0), (vec![wall(0.15)], 1.0)] {
        let mut setup = setup(vec![], insertion(0.1, WhenBlocked::Wait));
        setup.walls = walls;
        let mut sim = Simulation::new(setup).expect("sound");
        run(&mut sim, &[entry(2, 0.0, Vec3::new(0.0, 0.0, 0.2), 0.5)], 0.15, |_| ()).expect("no guard");
        let p = particles(&mut sim)[0];
        assert!((p.velocity.z - 0.5 * ends).abs() < 1e-3, "{p:?}");
        assert!(if ends > 0.0 { p.position.z > 0.15 } else { p.position.z < 0.13 }, "{p:?}");
    }
}
