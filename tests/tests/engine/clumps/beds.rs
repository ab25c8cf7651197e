//! Many rigid clumps: their energy, their bits, their step; what is refused.

use super::*;
use grainpipe_tests::same_bits::{Run, particle_bits, steps};

/// Clumps of three kinds and spheres, thrown into a periodic, shaken trough of wall spheres.
fn trough(law: Law, count: u32) -> Setup {
    let mut setup = with_friction(empty(law, 0.4), 0.4);
    setup.contacts.iter_mut().for_each(|c| c.set("rolling_resistance", 0.05));
    setup.gravity = Vec3::new(0.5, 0.0, -9.81);
    setup.periodic = [Some((0.0, 0.3)), Some((0.0, 0.3)), None];
    setup.step = Step::Auto(0.3);
    setup.guards.overlap = 0.6;
    let at = |k: usize| Vec3::new(0.005 + 0.01 * (k % 30) as f64, 0.005 + 0.01 * (k / 30) as f64, 0.0);
    let mut floor = plane(Vec3::z());
    floor.shape = WallShape::Spheres((0..900).map(|k| (at(k), 0.008)).collect());
    floor.motion.amplitude = Vec3::new(0.0, 0.0, 0.002);
    floor.motion.frequency = 25.0;
    setup.walls = vec![floor];
    let place = |k: u32| {
        Vec3::new(
            0.03 + 0.06 * (k % 5) as f64,
            0.03 + 0.06 * (k / 5 % 5) as f64,
            0.05 + 0.06 * (k / 25) as f64,
        )
    };
    let thrown = |k: u32| Vec3::new(0.1 * (k % 7) as f64 - 0.3, 0.05 * (k % 5) as f64 - 0.1, -0.5);
    setup.clumps.shapes = vec![boomerang(), die(0.006), dumbbell()];
    for k in 0..count {
        if k % 4 == 3 {
            let mut p = grain(10 * k, place(k));
            p.velocity = thrown(k);
            setup.particles.push(p);
        } else {
            let orientation = Rotation3::from_euler_angles(k as f64, 0.3 * k as f64, 0.0).into();
            let spin = Vec3::new(5.0, -3.0, 2.0) * (k % 3) as f64;
            let scale = 0.8 + 0.005 * (k % 80) as f64;
            let one = body(10 * k, place(k));
            setup.clumps.placed.push(Body {
                shape: k % 4,
                scale,
                orientation,
                spin,
                velocity: thrown(k),
                ..one
            });
        }
    }
    setup
}

/// Every bit of every particle and body.
fn bits(sim: &mut Simulation) -> Vec<u64> {
    let turn =
        |b: &ClumpState| b.orientation.coords.iter().chain(&b.angular_momentum).copied().collect::<Vec<_>>();
    let turns = bodies(sim).iter().flat_map(turn).map(f64::to_bits).collect();
    [particle_bits(sim), turns].concat()
}

/// Kinetic + potential + elastic + dissipated − work of walls stays the same.
#[test]
fn energy_budget_closes() {
    for law in LAWS {
        let closing = |safety: f64| {
            let mut setup = trough(law, 75);
            setup.ledger = true;
            setup.gravity.x = 0.0;
            // Wall spheres end at the edge of the box: what goes through a periodic face jumps between them.
            setup.walls[0].shape = plane(Vec3::z()).shape;
            setup.step = Step::Auto(safety);
            let mut sim = simulation(setup);
            run_until(&mut sim, 0.2);
            let e = energy(&mut sim);
            let exchanged = e.normal + e.sliding + e.rolling + e.walls.abs();
            assert!(e.normal > 0.0 && e.sliding > 0.0 && e.rolling > 0.0 && e.walls != 0.0, "{e:?}");
            e.integration.abs() / exchanged
        };
        let (coarse, fine) = (closing(0.4), closing(0.1));
        println!("{law:?}: {coarse:e} at safety 0.4, {fine:e} at 0.1");
        assert!(fine < 5e-3, "{law:?}: {fine:e} of the exchanged energy is missing");
    }
}

#[test]
fn same_bits_for_widths_threads_order_and_resume() {
    let look = |sim: &mut Simulation| {
        particles(sim);
    };
    let setup = || trough(Law::Hertz, 75);
    let run = Run { setup: &setup, parts: [&steps(400), &steps(500)], look: &look, bits: &bits };
    let mut shuffled = setup();
    shuffled.particles.reverse();
    shuffled.clumps.placed.rotate_left(17);
    assert!(run.end(simulation(shuffled)) == run.check(), "another order");
}

/// Just below the critical step a packing of clumps neither heats nor explodes; above, the step is refused, and the clump named.
#[test]
fn stable_just_below_the_critical_step() {
    for law in LAWS {
        let mut setup = trough(law, 125);
        setup.walls = vec![plane(Vec3::z())];
        setup.gravity.x = 0.0;
        let critical = dem::critical_step(&setup).expect("laws for all pairs");
        let cause = critical.cause.to_string();
        assert!(cause.contains("clump '"), "{cause}");
        setup.step = Step::Fixed(1.05 * critical.dt);
        assert!(Simulation::new(setup.clone()).is_err());
        setup.step = Step::Fixed(0.95 * critical.dt);
        let mut sim = simulation(setup);
        run_until(&mut sim, 0.8);
        let first = energy(&mut sim);
        run_until(&mut sim, 1.2);
        let later = energy(&mut sim);
        println!("{law:?}: {:e} J, then {:e} J", first.translation, later.translation);
        assert!(later.translation < 0.1 * first.translation, "{law:?} trembles: {first:?} {later:?}");
        // A single foot may spin on: nothing resists twisting.
        assert!(later.rotation <= first.rotation * (1.0 + 1e-9), "{law:?} heats: {first:?} {later:?}");
    }
}

/// Rolling resistance of constant size brings a rod of many spheres to rest: all its contacts together never turn its rolling round.
#[test]
fn constant_rolling_ends_on_a_rod() {
    let mut setup = with_friction(empty(HOOKE, 0.5), 0.5);
    setup.gravity.z = -9.81;
    setup.ledger = true;
    setup.step = Step::Auto(0.5);
    setup.contacts.iter_mut().for_each(|c| {
        rolling(c, 0.2, "constant");
    });
    setup.walls = vec![plane(Vec3::z())];
    let spheres: Vec<(Vec3, f64)> =
        (0..16).map(|k| (Vec3::new(0.012 * f64::from(k), 0.0, 0.0), 0.01)).collect();
    let rolling = Vec3::new(0.0, -0.03, 0.0);
    let rod =
        Body { velocity: rolling, spin: Vec3::new(3.0, 0.0, 0.0), ..body(1, Vec3::new(0.0, 0.0, 0.00999)) };
    setup.clumps = Clumps { shapes: vec![clump(&spheres)], placed: vec![rod], entries: vec![] };
    let mut sim = simulation(setup);
    run_until(&mut sim, 1.0);
    let before = energy(&mut sim);
    run_until(&mut sim, 1.2);
    let after = energy(&mut sim);
    let taken = after.rolling - before.rolling;
    println!("{taken:e} J in 0.2 s, {:e} J in motion", after.rotation + after.translation);
    assert!(taken < 1e-12 && after.rotation < 1e-15, "it goes on: {before:?} {after:?}");
}

/// What cannot be a body, or does not fit the scene, is refused by name.
#[test]
fn wrong_clumps_are_refused() {
    let sound = || {
        let mut setup = alone(cube(), Vec3::zeros(), 1e-5);
        setup.walls = vec![plane(Vec3::z())];
        setup.clumps.placed[0].position.z = 0.1;
        setup
    };
    assert!(Simulation::new(sound()).is_ok());
    let refused = |change: &dyn Fn(&mut Setup), part: &str| {
        let mut setup = sound();
        change(&mut setup);
        let message = Simulation::new(setup).err().map(|e| explain_setup_error(&e)).unwrap_or_default();
        assert!(message.contains(part), "wanted '{part}' in '{message}'");
    };
    refused(&|s| s.clumps.placed[0].scale = 0.0, "scale");
    refused(&|s| s.clumps.placed[0].spin.x = f64::NAN, "spin");
    refused(&|s| s.clumps.placed[0].shape = 3, "shape");
    refused(&|s| s.clumps.placed[0].position.z = 0.005, "behind wall");
    refused(&|s| s.clumps.placed[0].position.x = 1e13, "shift the scene to the origin");
    refused(&|s| s.particles = vec![grain(12, Vec3::new(0.0, 0.0, 0.5))], "id 12 is used twice");
    refused(&|s| s.clumps.shapes[0].volume = 0.0, "volume");
    refused(&|s| s.clumps.shapes[0].spheres.clear(), "spheres");
    refused(&|s| s.periodic[0] = Some((0.0, 0.05)), "period of");
    let plane = geom::Plane { point: Vec3::new(0.0, 0.0, -1.0), normal: -Vec3::z() };
    let lowest = Zone { test: ZoneTest::Lowest, ..Zone::new(plane, 0.2) };
    refused(&|s| s.outlets = vec![lowest], "only centres are tested");
}

/// Without clumps there is nothing of them: not a byte in the checkpoint beyond four empty lists.
#[test]
fn no_clumps_no_bytes() {
    let mut setup = alone(cube(), Vec3::zeros(), 1e-5);
    assert!(simulation(setup.clone()).bytes_of_clumps() > 0);
    setup.clumps = Clumps::default();
    setup.particles = vec![grain(1, Vec3::zeros())];
    assert_eq!(simulation(setup).bytes_of_clumps(), 0);
}
