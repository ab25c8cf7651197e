//! What particles do to walls, added up over every step: momentum, work, impacts, and that none depends on when it is asked for.

use dem::setup::*;
use dem::{Simulation, WallInterval, WallSum};
use geom::mesh::cuboid;
use geom::{Vec3, mesh::TriMesh};
use grainpipe_tests::setups::{HOOKE, LAWS, empty, grain, lattice, particles, plane, with_friction};

fn steps(sim: &mut Simulation, count: u64) {
    (0..count).for_each(|_| sim.step().expect("within the guards"));
}

fn taken(sim: &mut Simulation) -> WallInterval {
    sim.take_wall_sums().expect("asked for")
}

/// One ball bounces obliquely on a plate: what it gives to the plate is what it loses, less its weight, in every interval.
#[test]
fn an_impulse_is_the_change_of_momentum_less_the_weight() {
    for law in LAWS {
        let mut setup = with_friction(empty(law, 0.6), 0.4);
        setup.gravity = Vec3::new(0.0, 0.0, -9.81);
        setup.wall_sums = WallDetail::Whole;
        setup.walls = vec![plane(Vec3::z())];
        let start = grain(0, Vec3::new(0.0, 0.0, 0.0105));
        setup.particles = vec![Particle { velocity: Vec3::new(1.0, 0.3, -0.5), ..start }];
        let mut sim = Simulation::new(setup).expect("sound");
        let mass = dem::mass(0.01, 2500.0);
        let momentum = |sim: &mut Simulation| particles(sim)[0].velocity * mass;
        assert_eq!(taken(&mut sim).length, 0.0);
        let (mut before, mut impacts, mut touched) = (momentum(&mut sim), 0, 0);
        for count in [7, 1, 60, 333, 2, 9000, 11_111, 1, 30_000] {
            steps(&mut sim, count);
            let (sums, now) = (taken(&mut sim), momentum(&mut sim));
            let weight = Vec3::new(0.0, 0.0, -9.81) * mass * sums.length;
            let wall = sums.walls[0];
            let error = (wall.impulse + (now - before) - weight).norm();
            let scale = wall.impulse.norm().max(before.norm());
            assert!(error < 1e-12 * scale, "{law:?}, {count} steps: {error:e} N·s of {scale:e}");
            assert!(wall.largest * sums.length >= wall.impulse.norm());
            touched += u32::from(wall.impulse != Vec3::zeros());
            impacts += wall.impacts;
            before = now;
        }
        assert!(impacts >= 2 && touched >= 2, "{law:?}: {impacts} impacts, {touched} intervals with contact");
    }
}

/// The first impact brings ½ m v² along the normal and along the surface, with every law, sampled or averaged, at any step and restitution.
#[test]
fn an_impact_brings_the_energy_of_its_approach() {
    let samplings = [Sampling::Sampled, Sampling::Averaged];
    let cases = LAWS.iter().flat_map(|&law| samplings.map(|contacts| (law, contacts)));
    for ((law, contacts), (restitution, share)) in
        cases.flat_map(|case| [(0.5, 0.1), (0.0, 0.5), (1.0, 0.3)].map(|e| (case, e)))
    {
        let mut setup = with_friction(empty(law, restitution), 0.4);
        (setup.sampling, setup.step) = (contacts, Step::Auto(share));
        setup.wall_sums = WallDetail::Parts;
        let tile = cuboid(Vec3::new(-1.0, -1.0, -0.1), Vec3::new(1.0, 1.0, 0.0));
        setup.walls = vec![Wall::new("tile", 1, WallShape::Mesh(tile))];
        let start = grain(0, Vec3::new(-0.0002, 0.0001, 0.0101));
        setup.particles = vec![Particle { velocity: Vec3::new(0.3, 0.0, -0.4), ..start }];
        let mut sim = Simulation::new(setup).expect("sound");
        let mut all = WallSum::default();
        let (mut normal, mut impacts) = (0.0, 0);
        while all.impacts == 0 {
            steps(&mut sim, 1);
            let sums = taken(&mut sim);
            all = sums.walls[0];
            normal += sums.parts[0].iter().map(|p| p.normal).sum::<f64>() - all.normal;
            impacts += sums.parts[0].iter().map(|part| u64::from(part.impacts)).sum::<u64>();
        }
        let mass = dem::mass(0.01, 2500.0);
        assert_eq!((all.impacts, impacts), (1, 1));
        for (energy, speed) in all.impact_energy.into_iter().zip([0.4, 0.3]) {
            let expected = 0.5 * mass * speed * speed;
            let error = energy / expected - 1.0;
            assert!(error.abs() < 1e-9, "{law:?}, {contacts:?}, e {restitution}, {share}: {error:e}");
        }
        assert!(normal.abs() <= 1e-12 * all.normal);
    }
}

/// A drum of triangles and a paddle of spheres turn in a heap that sleeps nowhere; a floor shakes, a lid follows a force.
fn mill() -> Setup {
    let mut setup = with_friction(empty(HOOKE, 0.5), 0.5);
    setup.gravity = Vec3::new(20.0, 4.0, -30.0);
    (setup.ledger, setup.record_sliding, setup.wall_sums) = (true, true, WallDetail::Parts);
    setup.step = Step::Auto(0.2);
    setup.guards.overlap = 0.5;
    // Lists are rebuilt often, so that contacts end and are dropped between two records.
    setup.skin = Some(1e-4);
    let TriMesh { vertices, mut faces } = cuboid(Vec3::repeat(-0.1), Vec3::repeat(0.1));
    faces.iter_mut().for_each(|f| f.swap(0, 1));
    let turned = |rate: f64| Motion { turn: Vec3::new(0.0, rate, 0.0), ..Motion::still() };
    let drum =
        Wall { motion: turned(8.0), ..Wall::new("drum", 1, WallShape::Mesh(TriMesh { vertices, faces })) };
    let spheres = (0..24).map(|k| (Vec3::new(0.004 * f64::from(k) - 0.048, 0.0, -0.05), 0.005)).collect();
    let paddle = Wall { motion: turned(-20.0), ..Wall::new("paddle", 1, WallShape::Spheres(spheres)) };
    let mut floor = Wall { ..plane(Vec3::z()) };
    if let WallShape::Plane(plane) = &mut floor.shape {
        plane.point.z = -0.09;
    }
    floor.motion = Motion { amplitude: Vec3::new(0.003, 0.0, 0.001), frequency: 40.0, ..Motion::still() };
    setup.walls = vec![drum, paddle, floor];
    setup.particles = lattice([5, 4, 4], Vec3::new(0.0, 0.0, 0.03));
    let noise = |k: u32, axis: u32| f64::from((k * 7919 + axis * 104_729) % 1009) / 504.5 - 1.0;
    for p in &mut setup.particles {
        p.velocity = Vec3::new(noise(p.id, 1), noise(p.id, 2), noise(p.id, 3)) * 0.5;
    }
    setup
}

/// Sums of some walls in two intervals that follow each other.
fn joined(all: Vec<WallInterval>) -> Vec<WallSum> {
    let add = |mut a: Vec<WallSum>, b: WallInterval| {
        for (a, b) in a.iter_mut().zip(&b.walls) {
            a.impulse += b.impulse;
            a.moment += b.moment;
            a.work += b.work;
            a.normal += b.normal;
            a.largest = a.largest.max(b.largest);
            a.sliding += b.sliding;
            a.impacts += b.impacts;
        }
        a
    };
    all.into_iter().fold(vec![WallSum::default(); 3], add)
}

/// However seldom records are made, contacts and walls have all that the ledger says sliding dissipated, and walls the same impulse, torque and power.
#[test]
fn nothing_depends_on_how_often_it_is_asked_for() {
    let last = 4200;
    let mut found: Vec<Vec<WallSum>> = Vec::new();
    for every in [20, 140, 420, 4200] {
        let mut sim = Simulation::new(mill()).expect("sound");
        let (mut of_contacts, mut of_walls, mut all) = (0.0, [0.0; 3], Vec::new());
        while sim.steps() < last {
            steps(&mut sim, every);
            for contact in sim.record_contacts().expect("kept") {
                of_contacts += contact.work;
                if contact.wall {
                    of_walls[contact.j as usize] += contact.work;
                }
            }
            let sums = taken(&mut sim);
            for (whole, parts) in sums.walls.iter().zip(&sums.parts).take(2) {
                let part: f64 = parts.iter().map(|part| part.sliding).sum();
                assert!((part - whole.sliding).abs() <= 1e-12 * whole.sliding, "{part} {}", whole.sliding);
                assert!(parts.is_sorted_by_key(|part| part.part));
            }
            all.push(sums);
        }
        let (ledger, sums) = (sim.energy().expect("sound"), joined(all));
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * a.abs().max(b.abs());
        assert!(near(of_contacts, ledger.sliding), "every {every}: {of_contacts} J of {} J", ledger.sliding);
        for (wall, contacts) in sums.iter().zip(of_walls) {
            assert!(
                near(wall.sliding, contacts) && contacts > 0.0,
                "every {every}: {} {contacts}",
                wall.sliding
            );
        }
        // The drives bring what the ledger says that walls did; the last step counts half.
        let work: f64 = -sums.iter().map(|wall| wall.work).sum::<f64>();
        assert!((work / ledger.walls - 1.0).abs() < 1e-3, "every {every}: {work} J, {} J", ledger.walls);
        assert!(sim.rebuilds() > 50 && sums.iter().all(|wall| wall.impacts > 0), "{} lists", sim.rebuilds());
        found.push(sums);
    }
    for other in &found[1..] {
        for (a, b) in found[0].iter().zip(other) {
            let scale = a.normal;
            assert!((a.impulse - b.impulse).norm() <= 1e-12 * scale, "{a:?} {b:?}");
            assert!((a.moment - b.moment).norm() <= 1e-12 * scale, "{a:?} {b:?}");
            assert!((a.work - b.work).abs() <= 1e-12 * scale && (a.normal - b.normal).abs() <= 1e-12 * scale);
            assert_eq!((a.largest, a.impacts), (b.largest, b.impacts));
        }
    }
}

/// About the axis of a drum that turns, power is torque times rate.
#[test]
fn the_power_of_a_drum_is_its_torque_times_its_rate() {
    let mut sim = Simulation::new(mill()).expect("sound");
    steps(&mut sim, 4000);
    let sums = taken(&mut sim);
    for (wall, rate) in sums.walls.iter().zip([8.0, -20.0]) {
        let expected = wall.moment.y * rate;
        assert!((wall.work - expected).abs() < 1e-9 * wall.work.abs(), "{} J, {expected} J", wall.work);
    }
}

/// A run that is resumed within an interval ends it with the same sums.
#[test]
fn a_checkpoint_keeps_the_sums_of_an_unfinished_interval() {
    let mut whole = Simulation::new(mill()).expect("sound");
    steps(&mut whole, 700);
    taken(&mut whole);
    steps(&mut whole, 333);
    let mut resumed = Simulation::resume(mill(), whole.checkpoint().to_static()).expect("its own");
    [&mut whole, &mut resumed].into_iter().for_each(|sim| steps(sim, 400));
    assert_eq!(taken(&mut whole), taken(&mut resumed));
    let records = [&mut whole, &mut resumed].map(|sim| sim.record_contacts().expect("kept"));
    assert_eq!(records[0], records[1]);
}
