//! Walls that follow a force, and motions that start and stop.

use dem::setup::*;
use dem::{Halt, Partner, Setup, Simulation};
use geom::{Plane, Vec3, mesh::TriMesh};
use grainpipe_tests::same_bits::{Run, steps, wall_bits};
use grainpipe_tests::setups::{HOOKE, LAWS, Law, empty, grain, particles, plane, run_until, with_friction};

/// Length of the box [m].
pub const SIDE: f64 = 0.1;

fn side(axis: usize, high: bool) -> Wall {
    let normal = Vec3::ith(axis, if high { -1.0 } else { 1.0 });
    let point = if high { Vec3::repeat(SIDE) } else { Vec3::zeros() };
    let name = format!("{}{}", ["x", "y", "z"][axis], if high { '+' } else { '-' });
    Wall { name, shape: WallShape::Plane(Plane { point, normal }), ..plane(normal) }
}

fn servo(direction: Vec3, force: f64) -> Servo {
    Servo::force(direction, force, 0.05)
}

/// 64 grains of three sizes in a box of six walls.
pub fn filled_box(law: Law) -> Setup {
    let mut setup = with_friction(empty(law, 0.3), 0.3);
    setup.step = Step::Auto(0.3);
    setup.walls = (0..3).flat_map(|axis| [side(axis, false), side(axis, true)]).collect();
    setup.particles = (0..64u32)
        .map(|k| {
            let at = |n: u32| 0.0125 + 0.025 * f64::from(n);
            let off = |n: u32| 1e-4 * (f64::from(k * n % 5) - 2.0);
            let mut p = grain(k, Vec3::new(at(k % 4) + off(3), at(k / 4 % 4) + off(7), at(k / 16)));
            p.radius = [0.0122, 0.011, 0.0105][k as usize % 3];
            p
        })
        .collect();
    setup
}

/// 64 grains of three sizes in a box, its lid pressing with `force` [N].
fn press(law: Law, force: f64) -> Setup {
    let mut setup = filled_box(law);
    setup.ledger = true;
    setup.walls[5].servo = Some(servo(-Vec3::z(), force));
    setup
}

/// The lid stops where its grains push back as hard as it does, and stays there.
#[test]
fn pressure_is_held() {
    for law in LAWS {
        let mut sim = Simulation::new(press(law, 20.0)).expect("sound");
        run_until(&mut sim, 2.0);
        let mut worst = 0.0f64;
        for _ in 0..200 {
            let next = sim.time() + 1e-3;
            run_until(&mut sim, next);
            let lid = sim.wall_forces().expect("sound")[5];
            worst = worst.max((lid.force.z / 20.0 - 1.0).abs());
            assert!(lid.contacts > 3 && lid.shift.z < -1e-3, "{lid:?}");
        }
        let walls = sim.wall_forces().expect("sound");
        println!("{law:?}: worst {worst:e}, lid {:?}, floor {:?}", walls[5], walls[4].force);
        assert!(worst < 0.01, "{law:?}: off by {worst}");
        let sum: Vec3 = walls.iter().map(|w| w.force).sum();
        assert!(sum.norm() < 0.2, "{law:?}: floor and sides carry what the lid presses: {sum:?}");
        let e = sim.energy().expect("sound");
        let exchanged = e.walls.abs() + e.normal + e.sliding;
        println!("{law:?}: {:e} of {exchanged:e} made: {e:?}", e.integration);
        assert!(e.integration.abs() < 0.02 * exchanged, "{law:?}: {e:?}");
        assert!(e.translation < 1e-4 * exchanged, "{law:?}: it rests: {e:?}");
    }
}

/// One grain under a lid of mesh, of wall spheres, of a plane: overlap F/k, whatever the shape.
#[test]
fn every_shape_of_wall_follows() {
    let s = 0.1;
    let corner = |x: f64, y: f64| Vec3::new(x, y, 0.03);
    let mesh = TriMesh::new(
        vec![corner(-s, -s), corner(s, -s), corner(s, s), corner(-s, s)],
        vec![[0, 1, 2], [0, 2, 3]],
    );
    let shapes = [
        WallShape::Plane(Plane { point: corner(0.0, 0.0), normal: -Vec3::z() }),
        WallShape::Mesh(mesh.expect("sound")),
        WallShape::Spheres(vec![(Vec3::new(0.0, 0.0, 0.05), 0.02)]),
    ];
    for shape in shapes {
        let mut setup = empty(HOOKE, 0.3);
        let mut lid = Wall { shape: shape.clone(), ..plane(Vec3::z()) };
        lid.servo = Some(servo(-Vec3::z(), 5.0));
        setup.walls = vec![plane(Vec3::z()), lid];
        setup.particles = vec![grain(1, Vec3::new(0.0, 0.0, 0.01))];
        let mut sim = Simulation::new(setup).expect("sound");
        run_until(&mut sim, 1.0);
        let walls = sim.wall_forces().expect("sound");
        let (z, shift) = (particles(&mut sim)[0].position.z, walls[1].shift.z);
        assert!((walls[1].force.z / 5.0 - 1.0).abs() < 1e-6, "{shape:?}: {walls:?}");
        assert!((z - (0.01 - 5.0 / 1e4)).abs() < 1e-8, "{shape:?}: {z}");
        assert!((shift - (-0.01 - 2.0 * 5.0 / 1e4)).abs() < 1e-8, "{shape:?}: {shift}");
    }
}

/// With nothing in its way a servo moves at its speed limit.
#[test]
fn speed_limit_holds() {
    let mut setup = press(HOOKE, 20.0);
    setup.particles.truncate(1);
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, 0.5);
    let lid = sim.wall_forces().expect("sound")[5];
    assert!((lid.shift.z + 0.05 * sim.time()).abs() < 1e-9, "{lid:?}");
}

#[test]
fn same_bits_for_widths_threads_and_resumed_runs() {
    let look = |sim: &mut Simulation| {
        particles(sim);
    };
    let setup = || press(Law::Hertz, 20.0);
    Run { setup: &setup, parts: [&steps(3500), &steps(2500)], look: &look, bits: &wall_bits }.check();
}

/// A grain between two walls that both push too hard stops the run, and the message names a wall.
#[test]
fn wedged_grain_stops_the_run() {
    let mut setup = empty(HOOKE, 0.3);
    setup.walls = vec![side(2, false), side(2, true)];
    setup.walls[0].servo = Some(servo(Vec3::z(), 1e3));
    setup.walls[1].servo = Some(servo(-Vec3::z(), 1e3));
    setup.particles = vec![grain(1, Vec3::new(0.0, 0.0, 0.05))];
    let mut sim = Simulation::new(setup).expect("sound");
    let halt = (0..1_000_000).find_map(|_| sim.step().err()).expect("stops");
    assert!(
        matches!(&halt, Halt::Overlap { partner: Partner::Wall(name), share, .. } if name.starts_with('z') && *share > 0.25),
        "{halt}"
    );
}

/// Moves between `from` and `until`, all parts of a motion at once; a plane may turn about its normal.
#[test]
fn motions_start_and_stop() {
    let mut setup = with_friction(empty(HOOKE, 0.5), 0.5);
    setup.walls = vec![plane(Vec3::z())];
    setup.particles = vec![grain(1, Vec3::new(0.0, 0.0, 0.05))];
    let m = &mut setup.walls[0].motion;
    (m.velocity, m.amplitude, m.frequency) = (Vec3::new(0.0, 0.0, -0.1), Vec3::new(0.001, 0.0, 0.0), 10.0);
    (m.turn, m.through) = (Vec3::z(), Vec3::new(0.3, 0.0, 0.0));
    (m.from, m.until) = (0.1, 0.225);
    let mut sim = Simulation::new(setup.clone()).expect("a plane may turn in itself");
    for (time, z, x) in [(0.05, 0.0, 0.0), (0.2, -0.01, 0.0), (0.5, -0.0125, 0.001)] {
        run_until(&mut sim, time);
        let shift = sim.wall_forces().expect("sound")[0].shift;
        assert!((shift.z - z).abs() < 1e-4 * 0.1 && (shift.x - x).abs() < 1e-4, "{time}: {shift}");
    }
    setup.walls[0].motion.turn = Vec3::x();
    let error = Simulation::new(setup.clone()).err().expect("refused").to_string();
    assert!(error.contains("about its own normal"), "{error}");
    setup.walls[0].motion = Motion { until: -1.0, ..Motion::still() };
    let error = Simulation::new(setup).err().expect("refused").to_string();
    assert!(error.contains("motion.until"), "{error}");
}

/// A grain on a plane that turns about its normal is taken along at ω × r.
#[test]
fn turntable_takes_grains_along() {
    let mut setup = with_friction(empty(HOOKE, 0.5), 0.8);
    setup.contacts.iter_mut().for_each(|c| c.set("rolling_resistance", 0.3));
    setup.gravity.z = -9.81;
    setup.walls = vec![plane(Vec3::z())];
    setup.walls[0].motion.turn = Vec3::new(0.0, 0.0, 1.0);
    setup.particles = vec![grain(1, Vec3::new(0.05, 0.0, 0.01))];
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, 1.0);
    let p = particles(&mut sim)[0];
    assert!((p.velocity.norm() - p.position.xy().norm()).abs() < 2e-3, "{p:?}");
    assert!(p.position.y > 0.03, "{p:?}");
}

/// A lid on a clump whose spheres are far lighter than the whole: dashpots are made for the mass of the whole, and so is the gain. The lid comes to rest
/// at its force.
#[test]
fn pressure_on_a_clump_is_held() {
    for law in LAWS {
        let mut setup = press(law, 2.0);
        setup.particles.clear();
        let half = Vec3::repeat(0.01);
        let mesh = geom::mesh::cuboid(-half, half);
        let spheres: Vec<(Vec3, f64)> = mesh.vertices.iter().map(|v| (*v, 0.001)).collect();
        let moments = geom::Moments::of_mesh(&mesh).expect("closed");
        let position = Vec3::new(0.05, 0.05, 0.011);
        let (orientation, zero) = (Default::default(), Vec3::zeros());
        let body = Body { id: 1, shape: 0, scale: 1.0, position, orientation, velocity: zero, spin: zero };
        let shape = ClumpShape::new("die", 0, &spheres, &moments);
        setup.clumps = Clumps { shapes: vec![shape], placed: vec![body], entries: vec![] };
        let lid = WallShape::Plane(Plane { point: Vec3::new(0.0, 0.0, 0.0221), normal: -Vec3::z() });
        setup.walls[5].shape = lid;
        let mut sim = Simulation::new(setup).expect("sound");
        run_until(&mut sim, 0.2);
        for _ in 0..100 {
            sim.step().expect("within the guards");
            let lid = sim.wall_forces().expect("sound")[5];
            assert!((lid.force.z / 2.0 - 1.0).abs() < 0.01, "{law:?}: {lid:?}");
        }
    }
}

/// A wall that is to press with no force, and touches nothing, stays where it is.
#[test]
fn no_force_no_way() {
    let mut setup = press(HOOKE, 0.0);
    setup.particles.truncate(1);
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, 0.01);
    assert_eq!(sim.wall_forces().expect("sound")[5].shift, Vec3::zeros());
}
