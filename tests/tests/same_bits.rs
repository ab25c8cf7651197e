//! The same bits for every width of lanes, any number of threads, any order of the particles, and across a checkpoint.

use dem::setup::*;
use dem::simd::Width;
use dem::{Setup, Simulation};
use geom::Vec3;
use grainpipe_tests::setups::{HOOKE, LAWS, Law, bond, empty, lattice, particles, plane, with_friction};

/// Grains of three sizes that fall into a periodic, shaken trough of wall spheres.
fn shaken_trough(law: Law) -> Setup {
    filled_trough(law, 600)
}

/// The same with so many grains.
fn filled_trough(law: Law, grains: u32) -> Setup {
    let mut setup = with_friction(empty(law, 0.4), 0.4);
    setup.contacts[0].set("rolling_resistance", 0.1);
    setup.gravity = Vec3::new(0.5, 0.0, -9.81);
    setup.periodic = [Some((0.0, 0.2)), Some((0.0, 0.2)), None];
    setup.step = Step::Auto(0.2);
    setup.guards.overlap = 0.5;
    let at = |k: usize| Vec3::new(0.005 + 0.01 * (k % 20) as f64, 0.005 + 0.01 * (k / 20) as f64, 0.0);
    let mut floor = plane(Vec3::z());
    floor.shape = WallShape::Spheres((0..400).map(|k| (at(k), 0.008)).collect());
    floor.motion.amplitude = Vec3::new(0.0, 0.0, 0.002);
    floor.motion.frequency = 25.0;
    setup.walls = vec![floor];
    setup.particles = (0..grains)
        .map(|k| Particle {
            id: k,
            material: 0,
            radius: [0.006, 0.008, 0.0095][k as usize % 3],
            position: Vec3::new(
                0.01 + 0.02 * (k % 10) as f64,
                0.01 + 0.02 * (k / 10 % 10) as f64,
                0.03 + 0.021 * (k / 100) as f64,
            ),
            velocity: Vec3::new(0.1 * (k % 7) as f64 - 0.3, 0.05 * (k % 5) as f64 - 0.1, -0.5),
            spin: Vec3::zeros(),
        })
        .collect();
    setup
}

/// Every bit of every particle.
fn bits(mut sim: Simulation, steps: u64) -> Vec<u64> {
    for _ in 0..steps {
        sim.step().expect("within the guards");
    }
    let of = |p: &Particle| [p.position, p.velocity, p.spin].map(|v| [v.x, v.y, v.z]).concat();
    particles(&mut sim).iter().flat_map(of).map(f64::to_bits).collect()
}

fn simulation(setup: Setup) -> Simulation {
    Simulation::new(setup).expect("sound")
}

#[test]
fn every_width_of_lanes() {
    for law in LAWS {
        let all: Vec<_> = Width::available()
            .into_iter()
            .map(|width| {
                (width, bits(Simulation::with_width(shaken_trough(law), width).expect("sound"), 1500))
            })
            .collect();
        for (width, got) in &all {
            assert!(*got == all[0].1, "{law:?}: {width:?} differs from {:?}", all[0].0);
        }
    }
}

/// Mixed and single precision have the same bits for every width as well, and other ones than double precision.
#[test]
fn every_width_of_lanes_in_every_precision() {
    for law in LAWS {
        let double = bits(simulation(shaken_trough(law)), 1500);
        for precision in [Precision::Mixed, Precision::Single] {
            let narrow = || Setup { precision, ..shaken_trough(law) };
            let of = |width| bits(Simulation::with_width(narrow(), width).expect("sound"), 1500);
            let all: Vec<_> = Width::available().into_iter().map(|width| (width, of(width))).collect();
            for (width, got) in &all {
                assert!(*got == all[0].1, "{law:?}, {precision:?}: {width:?} differs from {:?}", all[0].0);
            }
            assert!(all[0].1 != double, "{law:?}: {precision:?} is as exact as double");
        }
    }
}

#[test]
fn every_number_of_threads() {
    // More than the eight tiles of 256 below which one thread does it all.
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| bits(simulation(filled_trough(Law::Hertz, 2600)), 700))
    };
    let one = with(1);
    for threads in [2, 3, 7] {
        assert!(with(threads) == one, "{threads} threads");
    }
}

#[test]
fn any_order_of_the_particles() {
    let mut shuffled = shaken_trough(HOOKE);
    shuffled.particles.reverse();
    shuffled.particles.rotate_left(217);
    assert!(bits(simulation(shuffled), 1500) == bits(simulation(shaken_trough(HOOKE)), 1500));
}

#[test]
fn looking_changes_nothing() {
    let mut watched = simulation(shaken_trough(HOOKE));
    for step in 0..1500 {
        if step % 7 == 0 {
            particles(&mut watched);
        }
        watched.step().expect("within the guards");
    }
    assert!(bits(watched, 0) == bits(simulation(shaken_trough(HOOKE)), 1500));
}

#[test]
fn resumed_run_equals_the_uninterrupted_one() {
    for looked in [false, true] {
        let mut first = simulation(shaken_trough(Law::Hertz));
        for _ in 0..700 {
            first.step().expect("within the guards");
        }
        if looked {
            particles(&mut first);
        }
        let resumed = Simulation::resume(shaken_trough(Law::Hertz), first.checkpoint().to_static())
            .expect("the same setup");
        assert!(bits(resumed, 800) == bits(first, 800), "looked at: {looked}");
    }
}

/// A bonded block that falls on wall spheres and breaks.
fn block(edge: u32) -> Setup {
    let mut setup = shaken_trough(Law::Hertz);
    setup.periodic = [Some((0.0, 0.3)), Some((0.0, 0.3)), None];
    setup.bonds = vec![Bond { strength: BondStrength::of(2e3, 2e3), damping: 0.2, ..bond((0, 0)) }];
    let centre = Vec3::new(0.15, 0.15, 0.008 + 0.0105 * f64::from(edge));
    setup.particles = lattice([edge; 3], centre);
    setup.particles.iter_mut().for_each(|p| p.velocity = Vec3::new(0.3, 0.1, -1.0));
    setup
}

/// The same with glue that takes the place of contacts, of strengths that are drawn; half of it is made while it flies.
fn glued(edge: u32) -> Setup {
    let mut setup = block(edge);
    let glue = BondKind::Contact(BondSprings::Given([2e4, 1e4]));
    let spread = Spread::Weibull { modulus: 3.0, reference_radius: None };
    let strength = BondStrength { spread, ..BondStrength::of(2e3, 2e3) };
    let law = Bond { strength, damping: 0.2, ..Bond::new((0, 0), 0.002, glue) };
    setup.bonds = vec![Bond { clusters: Clusters::Different, ..law.clone() }, Bond { at: 1e-4, ..law }];
    setup.clusters = setup.particles.iter().map(|p| (p.id, p.id % 2)).collect();
    setup
}

#[test]
fn glue_for_any_number_of_threads_order_and_after_a_checkpoint() {
    let with = |threads, setup: Setup| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| bits(simulation(setup), 400))
    };
    let one = with(1, glued(14));
    for threads in [2, 3] {
        assert!(with(threads, glued(14)) == one, "{threads} threads");
    }
    let mut shuffled = glued(14);
    shuffled.particles.reverse();
    assert!(with(2, shuffled) == one, "another order");
    let mut first = simulation(glued(6));
    let (made, mut steps) = (first.bond_count()[0], 0);
    while first.bond_count()[1] < 10 {
        first.step().expect("within the guards");
        steps += 1;
        assert!(steps < 20_000, "it does not break");
    }
    assert!(first.bond_count()[0] > made, "more was made on the way");
    let resumed = Simulation::resume(glued(6), first.checkpoint().to_static()).expect("the same setup");
    assert!(bits(resumed, 300) == bits(first, 300));
}

#[test]
fn bonds_for_any_number_of_threads_order_and_after_a_checkpoint() {
    let with = |threads, setup: Setup| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| bits(simulation(setup), 400))
    };
    let one = with(1, block(14));
    for threads in [2, 3, 7] {
        assert!(with(threads, block(14)) == one, "{threads} threads");
    }
    let mut shuffled = block(14);
    shuffled.particles.reverse();
    shuffled.particles.rotate_left(217);
    assert!(with(2, shuffled) == one, "another order");
    for looked in [false, true] {
        let mut first = simulation(block(5));
        let mut steps = 0;
        while first.bond_count()[1] < 10 {
            first.step().expect("within the guards");
            steps += 1;
            assert!(steps < 20_000, "it does not break");
        }
        if looked {
            particles(&mut first);
        }
        let broken = first.bond_count()[1];
        let resumed = Simulation::resume(block(5), first.checkpoint().to_static()).expect("the same setup");
        assert_eq!(resumed.bond_count()[1], broken);
        assert!(bits(resumed, 300) == bits(first, 300), "looked at: {looked}");
    }
}

/// Without friction no particle turns and nothing is remembered; with it, three numbers a contact.
#[test]
fn absent_effects_cost_nothing() {
    let sizes =
        |setup: Setup| simulation(setup).explain().iter().map(|e| e.bytes_per_contact).collect::<Vec<_>>();
    let mut smooth = empty(HOOKE, 0.5);
    smooth.particles = shaken_trough(HOOKE).particles;
    assert_eq!(sizes(smooth.clone()), [0], "Hooke alone");
    assert_eq!(sizes(with_friction(smooth.clone(), 0.5)), [0, 24], "with friction");
    assert_eq!(
        simulation(smooth.clone()).bytes_per_particle() + 96,
        simulation(with_friction(smooth, 0.5)).bytes_per_particle()
    );
}

/// Only widths that the machine has are computed with; others would be instructions that it does not know.
#[test]
fn a_width_that_the_machine_lacks_is_refused() {
    for width in [Width::Scalar, Width::Avx2, Width::Avx512] {
        let setup = Setup { step: Step::Fixed(1e-5), ..empty(HOOKE, 0.5) };
        let made = Simulation::with_width(setup, width);
        assert_eq!(made.is_ok(), Width::available().contains(&width), "{width:?}");
    }
}

/// Contacts that count the part of a step in which they act: every width in every precision, any number of threads, across a checkpoint.
#[test]
fn averaged_contacts() {
    for law in [HOOKE, Law::Hertz, Law::Jkr { work_of_adhesion: 0.05 }] {
        let averaged = || Setup { sampling: Sampling::Averaged, ..shaken_trough(law) };
        let one = bits(simulation(averaged()), 3000);
        let sampled = Setup { sampling: Sampling::Sampled, ..averaged() };
        assert!(one != bits(simulation(sampled), 3000), "{law:?}: it changes nothing");
        let narrow = [Precision::Mixed, Precision::Single].into_iter().filter(|_| LAWS.contains(&law));
        for precision in narrow.chain([Precision::Double]) {
            let of = |width| {
                let setup = Setup { precision, ..averaged() };
                bits(Simulation::with_width(setup, width).expect("sound"), 2000)
            };
            let all: Vec<_> = Width::available().into_iter().map(of).collect();
            assert!(all.iter().all(|bits| *bits == all[0]), "{law:?}, {precision:?}");
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("a pool");
        assert!(pool.install(|| bits(simulation(averaged()), 3000)) == one, "{law:?}: three threads");
        let mut first = simulation(averaged());
        (0..1437).for_each(|_| first.step().expect("within the guards"));
        let resumed = Simulation::resume(averaged(), first.checkpoint().to_static()).expect("the same setup");
        assert!(bits(resumed, 1563) == one, "{law:?}: resumed");
    }
}
