//! A grain of a zone acts on free grains and on nothing else: not on walls, not on other grains of the zone.

use super::*;
use dem::Energy;
use grainpipe_tests::setups::plane;

/// A grain slides along a floor at 1 m/s through a storage plane, and would fall through the floor in the zone behind it.
fn slide() -> Setup {
    let mut setup = with_friction(empty(HOOKE, 0.5), 0.5);
    setup.step = Step::Fixed(1e-5);
    setup.gravity = Vec3::new(0.0, 0.0, -9.81);
    setup.ledger = true;
    setup.walls = vec![plane(Vec3::z())];
    setup.outlets = vec![Zone { motion: ZoneMotion::Ballistic, ..zone(0.05, 0.03) }];
    setup.particles = vec![grain(0, Vec3::new(0.0, 0.0, 0.01))];
    setup.particles[0].velocity.x = 1.0;
    setup
}

/// Largest force of the grain on the floor [N] after `from` [s], the ledger at the end.
fn pushed(setup: Setup, from: f64, until: f64) -> (f64, u32, Energy) {
    let mut sim = Simulation::new(setup).expect("sound");
    let (mut most, mut contacts) = (0.0f64, 0);
    while sim.time() < until {
        sim.step().expect("no guard checks grains of a zone");
        if sim.time() > from {
            let floor = sim.wall_forces().expect("loads are kept")[0];
            (most, contacts) = (most.max(floor.force.norm()), contacts.max(floor.contacts));
        }
    }
    (most, contacts, sim.energy().expect("ready"))
}

#[test]
fn no_travelling_particle_pushes_a_wall_or_counts_in_the_ledger() {
    let passes = 0.062;
    let whole = Setup { outlets: vec![], ..slide() };
    let (_, _, whole) = pushed(whole, passes, 0.08);
    let (force, contacts, cut) = pushed(slide(), passes, 0.08);
    assert_eq!((force, contacts), (0.0, 0), "it travels over the floor, and through it");
    for (what, cut, whole) in [
        ("sliding", cut.sliding, whole.sliding),
        ("normal", cut.normal, whole.normal),
        ("elastic", cut.elastic, 0.0),
    ] {
        assert!(cut >= 0.0 && cut <= whole + 1e-12, "{what}: {cut} J, undivided {whole} J");
    }
    let start = dem::mass(0.01, 2500.0) * (0.5 + 9.81 * 0.01);
    let taken = start - cut.sliding - cut.normal;
    assert!((cut.left - taken).abs() < 0.02 * start, "it takes along what it had: {} of {taken} J", cut.left);
    // On its way it presses the spring of the floor by its radius; the finite step makes a share of that.
    let pressed = 0.5 * 1e4 * 0.01 * 0.01;
    assert!(cut.integration.abs() < 1e-3 * pressed, "{} J", cut.integration);
    assert!((cut.balance() - start).abs() < 1e-9, "{} J", cut.balance());
}

/// The same on the way in: a path that leads back below the floor.
#[test]
fn no_particle_on_its_way_in_pushes_a_wall() {
    let mut setup = slide();
    (setup.outlets, setup.particles) = (vec![], vec![]);
    setup.inlets = vec![Zone { motion: ZoneMotion::Ballistic, ..zone(0.05, 0.03) }];
    (setup.smallest_entry, setup.largest_entry, setup.entry_materials) = (0.01, 0.01, vec![0]);
    let mut sim = Simulation::new(setup).expect("sound");
    let back = 0.03;
    let mut start = grain(0, Vec3::new(0.05 - back, 0.0, 0.01 - 0.5 * 9.81 * back * back));
    start.velocity = Vec3::new(1.0, 0.0, 9.81 * back);
    sim.enter(Entry { time: 1e-5, inlet: 0, particle: start, clump: None, turn: None, cluster: 0 })
        .expect("announced");
    while sim.time() < 0.02 {
        sim.step().expect("no guard checks grains of a zone");
        let floor = sim.wall_forces().expect("loads are kept")[0];
        assert_eq!((floor.force, floor.contacts), (Vec3::zeros(), 0), "at {} s", sim.time());
    }
    let e = sim.energy().expect("ready");
    assert_eq!((e.sliding, e.normal, e.elastic.abs() < 1e-15), (0.0, 0.0, true), "{e:?}");
}

/// A lid that follows a force is held by a grain at rest; another one passes below the floor of its zone, and does not move it.
#[test]
fn a_servo_does_not_feel_who_travels() {
    let mut setup = slide();
    setup.walls[0].servo = Some(Servo::force(Vec3::z(), 0.15, 0.05));
    setup.particles.push(grain(1, Vec3::new(-0.1, 0.05, 0.01)));
    let mut sim = Simulation::new(setup).expect("sound");
    let mut travels = false;
    while sim.time() < 0.075 {
        sim.step().expect("within the guards");
        travels |= !sim.take_crossings().is_empty();
        // Both grains push it until one of them travels; an overlap of its radius would be 100 N.
        let floor = sim.wall_forces().expect("loads are kept")[0];
        assert!(floor.contacts <= if travels { 1 } else { 2 }, "{} s: {floor:?}", sim.time());
        assert!(!travels || floor.force.norm() < 0.5, "{} s: {floor:?}", sim.time());
    }
    let floor = sim.wall_forces().expect("loads are kept")[0];
    let rest = particles(&mut sim).iter().find(|p| p.id == 1).map(|p| p.position.z);
    assert!(travels && (floor.force.z / -0.15 - 1.0).abs() < 1e-2, "{floor:?}");
    assert!(rest.is_some_and(|z| (z - 0.01 - floor.shift.z).abs() < 1e-4), "{rest:?}");
}

/// A grain comes in half sunk into a wall of each kind, slides along it and becomes free there: on its way the ledger has nothing of it, and when it
/// is free what the wall's spring holds has come in with it.
#[test]
fn what_comes_in_through_a_wall_is_booked_when_it_acts() {
    let s = 0.5;
    let corners = [[-s, -s, 0.0], [s, -s, 0.0], [s, s, 0.0], [-s, s, 0.0]].map(Vec3::from).to_vec();
    let mesh = geom::mesh::TriMesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).expect("sound");
    let spheres = (0..60).map(|k| (Vec3::new(0.004 * f64::from(k) - 0.1, 0.0, -0.5), 0.5)).collect();
    for shape in [plane(Vec3::z()).shape, WallShape::Mesh(mesh), WallShape::Spheres(spheres)] {
        let mut setup = slide();
        setup.walls[0].shape = shape;
        (setup.outlets, setup.particles, setup.gravity) = (vec![], vec![], Vec3::zeros());
        setup.guards.overlap = 0.9;
        setup.inlets = vec![zone(0.05, 0.03)];
        (setup.smallest_entry, setup.largest_entry, setup.entry_materials) = (0.01, 0.01, vec![0]);
        let wall = format!("{:?}", std::mem::discriminant(&setup.walls[0].shape));
        let flat = !matches!(setup.walls[0].shape, WallShape::Spheres(_));
        setup.step = Step::Fixed(if flat { 1e-5 } else { 2.5e-6 });
        let mut sim = Simulation::new(setup).expect("sound");
        let depth = 0.004;
        let start = Particle { velocity: Vec3::x(), ..grain(0, Vec3::new(0.02, 0.0, 0.01 - depth)) };
        sim.enter(Entry { time: 1e-5, inlet: 0, particle: start, clump: None, turn: None, cluster: 0 })
            .expect("announced");
        while sim.time() < 0.029 {
            sim.step().expect("no guard checks grains of a zone");
            let e = sim.energy().expect("ready");
            let all = [e.elastic, e.entered, e.left, e.normal, e.sliding, e.integration, e.balance()];
            assert!(all.iter().all(|x| x.abs() < 1e-15), "wall {wall}, {} s: {e:?}", sim.time());
        }
        let mut first = None;
        while sim.time() < 0.033 {
            sim.step().expect("within the guards");
            let e = sim.energy().expect("ready");
            first = first.or((e.entered > 0.0).then_some(e.elastic));
        }
        let (e, held) = (sim.energy().expect("ready"), first.expect("it came in"));
        let moves = 0.5 * dem::mass(0.01, 2500.0);
        assert!((e.entered / (moves + held) - 1.0).abs() < 2e-3, "wall {wall}: {} J came in", e.entered);
        // Its tangential spring holds μ F_n, with k_t/k_n = 2(1 − ν)/(2 − ν). Of this wall of spheres a dozen are pressed at once.
        let one = 0.5 * 1e4 * depth * depth * (1.0 + 0.25 * 1.75 / 1.5);
        let least = if flat { 0.95 } else { 1.0 };
        assert!(held > least * one && (held < 1.05 * one || !flat), "wall {wall}: it held {held} J");
        assert!(
            e.integration.abs() < 1e-3 * held,
            "wall {wall}: the step made {} J of {held} J",
            e.integration
        );
        assert!(e.balance().abs() < 1e-12, "wall {wall}: {} J", e.balance());
    }
}
