//! Belts: walls at rest whose surface moves on them.

use dem::setup::*;
use dem::{Setup, Simulation};
use geom::Vec3;
use geom::mesh::TriMesh;
use grainpipe_tests::setups::{HOOKE, empty, grain, particles, plane, run_until, with_friction};

/// A grain of radius 10 mm on a wall in the plane z = 0, as deep as its weight presses it.
fn on(mut wall: Wall, speed: f64, friction: f64) -> Setup {
    let mut setup = with_friction(empty(HOOKE, 0.3), friction);
    (setup.gravity.z, setup.step, setup.ledger) = (-9.81, Step::Auto(0.2), true);
    wall.surface.velocity = Vec3::new(speed, 0.0, 0.0);
    setup.walls = vec![wall];
    let sag = 9.81 * dem::mass(0.01, 2500.0) / 1e4;
    setup.particles = vec![grain(0, Vec3::new(0.0, 0.0, 0.01 - sag))];
    setup
}

/// Two triangles in z = 0.
fn sheet() -> Wall {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 0.0));
    let mesh = TriMesh::new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).expect("sound");
    Wall::new("sheet", 1, WallShape::Mesh(mesh))
}

fn simulation(setup: Setup) -> Simulation {
    Simulation::new(setup).expect("a setup that runs")
}

/// A ball put on a belt slides until it rolls, with 2/7 of the belt's speed, whatever μ is. The belt's work is friction and motion.
#[test]
fn a_ball_put_on_a_belt_rolls_off_at_two_sevenths_of_its_speed() {
    for wall in [plane(Vec3::z()), sheet()] {
        for friction in [0.2, 0.5] {
            let name = format!("{} μ = {friction}", wall.name);
            let mut sim = simulation(on(wall.clone(), 0.7, friction));
            run_until(&mut sim, 0.02);
            let early = particles(&mut sim)[0].velocity.x;
            assert!((early / (friction * 9.81 * sim.time()) - 1.0).abs() < 0.02, "{name}: {early} m/s");
            run_until(&mut sim, 0.4);
            let ball = particles(&mut sim)[0];
            assert!((ball.velocity.x - 0.2).abs() < 1e-3, "{name}: {} m/s", ball.velocity.x);
            assert!((ball.spin.y + 0.5 / 0.01).abs() < 0.2, "{name}: {} rad/s", ball.spin.y);
            let energy = sim.energy().expect("no guard trips");
            // m v²/7 is what moves in the end, and as much again and more was rubbed off.
            let slid = energy.sliding;
            assert!(energy.walls > slid && slid > 0.0, "{name}: {energy:?}");
            let missing = (energy.walls - slid - energy.translation - energy.rotation) / energy.walls;
            assert!(missing.abs() < 0.02, "{name}: {missing} of the work of the belt is missing: {energy:?}");
        }
    }
}

/// A belt acts as a plane that travels in itself, and stays where it is.
#[test]
fn a_belt_acts_as_a_plane_that_travels_in_itself() {
    let mut travelling = on(plane(Vec3::z()), 0.0, 0.3);
    travelling.walls[0].motion.velocity.x = 0.5;
    let end = |setup: Setup| {
        let mut sim = simulation(setup);
        run_until(&mut sim, 0.3);
        particles(&mut sim)[0]
    };
    let (belt, plane) = (end(on(plane(Vec3::z()), 0.5, 0.3)), end(travelling));
    assert!((belt.position - plane.position).norm() < 1e-9, "{belt:?} {plane:?}");
    assert!((belt.velocity - plane.velocity).norm() < 1e-9, "{belt:?} {plane:?}");
}

/// What of a surface's velocity is across the wall pushes nothing: a belt round a box stands before a grain as a wall at rest.
#[test]
fn a_surface_never_pushes() {
    let mut setup = on(sheet(), 0.0, 0.3);
    setup.walls[0].surface.velocity = Vec3::new(0.0, 0.0, 3.0);
    let mut sim = simulation(setup);
    run_until(&mut sim, 0.1);
    let ball = particles(&mut sim)[0];
    assert!(ball.velocity.norm() < 1e-9 && ball.position.x.abs() < 1e-9, "{ball:?}");
}

/// On a turntable without friction beyond need, a grain that sits still in the middle is turned, and one at the edge is carried round.
#[test]
fn a_turntable_carries_round_what_lies_on_it() {
    for wall in [plane(Vec3::z()), sheet()] {
        let mut setup = on(wall, 0.0, 0.5);
        setup.walls[0].surface = SurfaceMotion { turn: Vec3::z() * 2.0, ..SurfaceMotion::still() };
        setup.particles[0].position.x = 0.1;
        let mut sim = simulation(setup);
        run_until(&mut sim, 0.02);
        let ball = particles(&mut sim)[0];
        let wanted = 0.5 * 9.81 * sim.time();
        assert!(
            ball.velocity.y > 0.0 && (ball.velocity.y / wanted.min(0.2 * 2.0 / 7.0) - 1.0).abs() < 0.05,
            "{ball:?}"
        );
    }
}

/// Grains do not fall asleep on a belt, and wake on it.
#[test]
fn nothing_sleeps_on_a_belt() {
    let rule = Sleep { speed: 1e-3, time: 0.01, wake: 0.1 };
    let sleepers = |speed: f64| {
        let mut sim =
            simulation(Setup { sleep: Some(rule), ledger: false, ..on(plane(Vec3::z()), speed, 0.02) });
        run_until(&mut sim, 0.1);
        (sim.asleep(), particles(&mut sim)[0].velocity.x)
    };
    assert_eq!(sleepers(0.0).0, 1, "a wall at rest");
    let (asleep, speed) = sleepers(0.7);
    assert!(asleep == 0 && speed > 0.01, "{asleep} asleep, {speed} m/s");
    let slow = Setup { sleep: Some(rule), ledger: false, ..on(plane(Vec3::z()), 1.9e-3, 0.02) };
    let refused = Simulation::new(slow).err().expect("slower than sleep").to_string();
    assert!(refused.contains("plane"), "{refused}");
}

/// The surface of an unbounded plane stays in it.
#[test]
fn a_surface_that_would_leave_its_plane_is_refused() {
    let refused = |surface: SurfaceMotion| {
        let mut setup = on(plane(Vec3::z()), 0.0, 0.3);
        setup.walls[0].surface = surface;
        Simulation::new(setup).err().expect("refused").to_string()
    };
    let lifted = SurfaceMotion { velocity: Vec3::new(1.0, 0.0, 0.1), ..SurfaceMotion::still() };
    let tilted = SurfaceMotion { turn: Vec3::x(), ..SurfaceMotion::still() };
    for text in [refused(lifted), refused(tilted)] {
        assert!(text.contains("along the plane"), "{text}");
    }
}
