//! Rigid clumps: spheres that move as one body.

mod beds;

use dem::setup::*;
use dem::{ClumpState, Energy, Setup, Simulation};
use geom::{Moments, Vec3};
use grainpipe_tests::setups::{
    HOOKE, LAWS, Law, clump, dumbbell, empty, grain, particles, plane, rolling, run_until, with_friction,
};
use nalgebra::{Rotation3, Unit, UnitQuaternion};
use scene::advice::explain_setup_error;

const DENSITY: f64 = 2500.0;

fn simulation(setup: Setup) -> Simulation {
    Simulation::new(setup).expect("the setup is sound")
}

fn bodies(sim: &mut Simulation) -> Vec<ClumpState> {
    sim.clumps().expect("no guard trips in a test of a law")
}

fn energy(sim: &mut Simulation) -> Energy {
    sim.energy().expect("no guard trips in a test of a law")
}

/// Three spheres, no two moments of inertia alike.
fn boomerang() -> ClumpShape {
    let at = |x: f64, y: f64, r: f64| (Vec3::new(x, y, 0.0), r);
    clump(&[at(0.0, 0.0, 0.01), at(0.02, 0.0, 0.009), at(0.0, 0.013, 0.007)])
}

/// A cube of 20 mm with a sphere of 3 mm at every corner.
fn cube() -> ClumpShape {
    die(0.003)
}

/// The same with spheres of another radius [m].
fn die(radius: f64) -> ClumpShape {
    let side = Vec3::repeat(0.01);
    let mesh = geom::mesh::cuboid(-side, side);
    let spheres: Vec<(Vec3, f64)> = mesh.vertices.iter().map(|v| (*v, radius)).collect();
    ClumpShape::new("cube", 0, &spheres, &Moments::of_mesh(&mesh).expect("closed"))
}

fn body(id: u32, position: Vec3) -> Body {
    let zero = Vec3::zeros();
    let orientation = UnitQuaternion::identity();
    Body { id, shape: 0, scale: 1.0, position, orientation, velocity: zero, spin: zero }
}

/// One body without anything that acts on it.
fn alone(shape: ClumpShape, spin: Vec3, dt: f64) -> Setup {
    let mut setup = empty(Law::Hooke { stiffness: 1e-3, tangential_ratio: None }, 0.5);
    setup.step = Step::Fixed(dt);
    setup.guards.motion = 1.0;
    let turn = Rotation3::from_euler_angles(0.3, -0.8, 0.5).into();
    let one = Body { orientation: turn, spin, velocity: Vec3::new(0.3, 0.1, -0.2), ..body(7, Vec3::x()) };
    setup.clumps = Clumps { shapes: vec![shape], placed: vec![one], entries: vec![] };
    setup
}

fn about(axis: Vec3, angle: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&Unit::new_normalize(axis), angle)
}

/// Euler: a free symmetric top turns about its axis of symmetry e at (1/I₃ − 1/I₁) L·e while e goes round L at |L|/I₁. Exactly, for
/// any step.
#[test]
fn free_symmetric_top() {
    let mut sim = simulation(alone(dumbbell(), Vec3::new(30.0, 50.0, -20.0), 1e-3));
    let start = bodies(&mut sim)[0];
    let (volume, r, x) = (4.0 / 3.0 * std::f64::consts::PI * 1e-6, 0.01f64, 0.006f64);
    let axial = 2.0 * 0.4 * volume * r * r * DENSITY;
    let across = axial + 2.0 * volume * x * x * DENSITY;
    let axis = start.orientation * Vec3::x();
    let l = axis * (axial * start.spin.dot(&axis)) + (start.spin - axis * start.spin.dot(&axis)) * across;
    assert!((l - start.angular_momentum).norm() < 1e-14 * l.norm(), "L = R I Rᵀ ω");
    for _ in 0..5000 {
        sim.step().expect("free");
    }
    let (t, end) = (sim.time(), bodies(&mut sim)[0]);
    let own = about(Vec3::x(), (1.0 / axial - 1.0 / across) * l.dot(&axis) * t);
    let expected = about(l, l.norm() / across * t) * start.orientation * own;
    let wrong = (end.orientation.inverse() * expected).angle();
    println!("{wrong:e} rad after {} turns", l.norm() / across * t / std::f64::consts::TAU);
    assert!(wrong < 1e-9, "{wrong:e} rad");
    assert!((end.angular_momentum - l).norm() < 1e-13 * l.norm());
    assert!((end.position - (Vec3::x() + start.velocity * t)).norm() < 1e-12);
    // Members are where the body puts them.
    for (k, p) in particles(&mut sim).iter().enumerate() {
        let out = end.orientation * Vec3::new([-0.006, 0.006][k], 0.0, 0.0);
        assert!((p.position - end.position - out).norm() < 1e-13, "member {k}");
        assert!((p.velocity - end.velocity - end.spin.cross(&out)).norm() < 1e-13, "member {k}");
    }
}

/// A free body with three different moments: L to the last bit, energy bounded and of second order, orientation of second order.
#[test]
fn free_asymmetric_body_is_of_second_order() {
    let spin = Vec3::new(20.0, -35.0, 40.0);
    let after = |dt: f64| {
        let mut sim = simulation(alone(boomerang(), spin, dt));
        let start = (bodies(&mut sim)[0], energy(&mut sim));
        let mut worst = 0.0f64;
        while sim.time() < 0.5 {
            sim.step().expect("free");
            worst = worst.max((energy(&mut sim).rotation / start.1.rotation - 1.0).abs());
        }
        let end = bodies(&mut sim)[0];
        assert!((end.angular_momentum - start.0.angular_momentum).norm() == 0.0, "L is kept to the bit");
        (end.orientation, worst)
    };
    let fine = after(1.0 / 65536.0).0;
    let errors: Vec<(f64, f64)> = [512.0, 1024.0, 2048.0]
        .iter()
        .map(|n| {
            let (turn, energy) = after(1.0 / n);
            ((turn.inverse() * fine).angle(), energy)
        })
        .collect();
    println!("{errors:?}");
    for pair in errors.windows(2) {
        let (turn, energy) = (pair[0].0 / pair[1].0, pair[0].1 / pair[1].1);
        assert!((3.7..4.3).contains(&turn) && (3.7..4.3).contains(&energy), "orders: {turn} {energy}");
    }
    assert!(errors[2].1 < 1e-3, "{errors:?}");
}

/// Dzhanibekov: a spin about the axis of the intermediate moment turns over again and again, one about either other axis does not.
#[test]
fn intermediate_axis_turns_over() {
    let shape = boomerang();
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| shape.inertia[a].total_cmp(&shape.inertia[b]));
    for (rank, &axis) in order.iter().enumerate() {
        let mut own = Vec3::repeat(1e-3);
        own[axis] = 60.0;
        let own = shape.frame * own;
        let setup = alone(shape.clone(), Vec3::zeros(), 1e-4);
        let spin = setup.clumps.placed[0].orientation * own;
        let mut sim = simulation(alone(shape.clone(), spin, 1e-4));
        let mut lowest = f64::INFINITY;
        while sim.time() < 2.0 {
            sim.step().expect("free");
            let b = bodies(&mut sim)[0];
            let along = (shape.frame.inverse() * (b.orientation.inverse() * b.spin))[axis];
            lowest = lowest.min(along / 60.0);
        }
        assert_eq!(lowest < -0.9, rank == 1, "axis of moment number {rank}: {lowest}");
    }
}

/// A clump of one sphere moves as the sphere does: dropped with spin on a floor with friction, and onto another sphere.
#[test]
fn clump_of_one_sphere_is_a_sphere() {
    for law in LAWS {
        let path = |as_clump: bool| {
            let mut setup = with_friction(empty(law, 0.6), 0.4);
            setup.contacts.iter_mut().for_each(|c| c.set("rolling_resistance", 0.1));
            setup.gravity.z = -9.81;
            setup.walls = vec![plane(Vec3::z())];
            let other = grain(5, Vec3::new(0.013, 0.002, 0.0098));
            let mut ball = grain(1, Vec3::new(0.0, 0.0, 0.03));
            (ball.velocity, ball.spin) = (Vec3::new(0.4, 0.0, -0.5), Vec3::new(20.0, 10.0, 30.0));
            setup.particles = vec![other];
            if as_clump {
                let one = Body { velocity: ball.velocity, spin: ball.spin, ..body(1, ball.position) };
                let sphere = clump(&[(Vec3::new(3.0, 1.0, 2.0), 0.01)]);
                setup.clumps = Clumps { shapes: vec![sphere], placed: vec![one], entries: vec![] };
            } else {
                setup.particles.push(ball);
            }
            let mut sim = simulation(setup);
            run_until(&mut sim, 0.3);
            assert!(energy(&mut sim).rotation > 0.0);
            (particles(&mut sim), sim.dt())
        };
        let ((free, dt), (clumped, same_dt)) = (path(false), path(true));
        assert!((dt - same_dt).abs() < 1e-12 * dt, "{law:?}: {dt} {same_dt}");
        for (a, b) in free.iter().zip(&clumped) {
            let off = [a.position - b.position, a.velocity - b.velocity, (a.spin - b.spin) * 0.01];
            assert!(off.iter().all(|d| d.norm() < 1e-9), "{law:?} particle {}: {off:?}", a.id);
        }
    }
}

/// A dumbbell dropped aslant onto a floor, against the plane motion of a rod integrated by itself: x, z, θ with a spring and a
/// dashpot at each end.
#[test]
fn dropped_dumbbell() {
    let mut setup = empty(HOOKE, 0.7);
    setup.gravity.z = -9.81;
    setup.walls = vec![plane(Vec3::z())];
    setup.step = Step::Auto(0.01);
    let tilt = 0.5;
    let start = Body { orientation: about(Vec3::y(), tilt), ..body(1, Vec3::new(0.0, 0.0, 0.03)) };
    setup.clumps = Clumps { shapes: vec![dumbbell()], placed: vec![start], entries: vec![] };
    let mut sim = simulation(setup);
    run_until(&mut sim, 0.12);

    let (r, x) = (0.01f64, 0.006f64);
    let m = 2.0 * dem::mass(r, DENSITY);
    let inertia = 0.4 * m * r * r + m * x * x;
    let ln = 0.7f64.ln();
    let gamma = -2.0 * ln / (std::f64::consts::PI.powi(2) + ln * ln).sqrt();
    // (z, θ, ż, θ̇); θ about y turns +x downwards. Each dashpot is made for the mass that its sphere moves.
    let slope = |s: [f64; 4]| {
        let [z, th, v, w] = s;
        let mut rate = [v, w, -9.81, 0.0];
        let ends = [-1.0, 1.0].map(|side| {
            let arm = side * x * th.cos();
            (arm, v - arm * w, 1e4 * (r - z + side * x * th.sin()))
        });
        let pressed = || ends.iter().filter(|end| end.2 > 0.0);
        let (push, moment) = pressed().fold((0.0, 0.0), |(p, q), (arm, _, f)| (p + f, q + arm * f));
        for (arm, speed, spring) in pressed() {
            let own = 1.0 / m + arm * arm / inertia;
            let moves = 1.0 / own.max((push / m + arm * moment / inertia) / spring);
            let force = spring - gamma * (1e4 * moves).sqrt() * speed;
            rate[2] += force / m;
            rate[3] -= arm * force / inertia;
        }
        rate
    };
    let (mut s, dt) = ([0.03, tilt, 0.0, 0.0], 2e-8);
    let steps = (sim.time() / dt).round() as u64;
    for _ in 0..steps {
        let add = |a: [f64; 4], b: [f64; 4], h: f64| [0, 1, 2, 3].map(|k| a[k] + h * b[k]);
        let middle = slope(add(s, slope(s), 0.5 * dt));
        s = add(s, middle, dt);
    }
    let b = bodies(&mut sim)[0];
    let along = b.orientation * Vec3::x();
    let angle = f64::atan2(-along.z, along.x);
    println!("z {} θ {angle} v {} ω {}; wanted {s:?}", b.position.z, b.velocity.z, b.spin.y);
    assert!((b.position.z - s[0]).abs() < 2e-5 && (angle - s[1]).abs() < 2e-3, "{b:?} {s:?}");
    assert!((b.velocity.z - s[2]).abs() < 2e-3 * s[2].abs().max(0.1));
    assert!((b.spin.y - s[3]).abs() < 2e-3 * s[3].abs().max(1.0), "{} {}", b.spin.y, s[3]);
    assert!(b.position.xy().norm() < 1e-12, "nothing pushes it aside");
}

/// A cube with a sphere at each corner rests on its face: no creep; on a slope it stays below arctan μ and slides above with
/// g (sin θ − μ cos θ).
#[test]
fn cube_rests_on_its_face_and_slides_above_the_angle_of_friction() {
    for law in LAWS {
        let mu = 0.4;
        let on_slope = |tangent: f64, time: f64| {
            let theta = f64::atan(tangent);
            let mut setup = with_friction(empty(law, 0.3), mu);
            setup.gravity = Vec3::new(9.81 * theta.sin(), 0.0, -9.81 * theta.cos());
            setup.walls = vec![plane(Vec3::z())];
            setup.step = Step::Auto(0.3);
            let one = body(0, Vec3::new(0.0, 0.0, 0.013));
            setup.clumps = Clumps { shapes: vec![cube()], placed: vec![one], entries: vec![] };
            let mut sim = simulation(setup);
            run_until(&mut sim, time);
            sim
        };
        let mut sim = on_slope(0.0, 1.0);
        let rested = bodies(&mut sim)[0];
        run_until(&mut sim, 2.0);
        let b = bodies(&mut sim)[0];
        assert!(
            (b.position - rested.position).norm() < 1e-13,
            "{law:?} creeps: {:?}",
            b.position - rested.position
        );
        assert!(b.velocity.norm() < 1e-12 && b.spin.norm() < 1e-10, "{law:?}: {b:?}");
        // Four corners carry the weight.
        let at = 0.013 - b.position.z;
        assert!(at > 0.0 && b.orientation.angle() < 1e-6, "{law:?}: {at} {}", b.orientation.angle());

        let mut sim = on_slope(0.9 * mu, 1.0);
        let rested = bodies(&mut sim)[0];
        run_until(&mut sim, 2.0);
        let b = bodies(&mut sim)[0];
        assert!(
            (b.position - rested.position).norm() < 1e-9,
            "{law:?} stays: {:?}",
            b.position - rested.position
        );
        // Until it slides it has to press its corners in, and to stretch their springs.
        let mut sim = on_slope(1.1 * mu, 0.1);
        let (from, before) = (sim.time(), bodies(&mut sim)[0].velocity.x);
        run_until(&mut sim, 0.5);
        let theta = f64::atan(1.1 * mu);
        let expected = 9.81 * (theta.sin() - mu * theta.cos());
        let found = (bodies(&mut sim)[0].velocity.x - before) / (sim.time() - from);
        assert!((found / expected - 1.0).abs() < 1e-5, "{law:?} slides: {found} instead of {expected}");
    }
}

/// Two clumps that meet aslant with friction, all different: momentum to rounding, angular momentum to the step's error.
#[test]
fn collision_conserves_momentum_and_angular_momentum() {
    for law in LAWS {
        let mut setup = with_friction(empty(law, 0.6), 0.4);
        setup.contacts[0].set("rolling_resistance", 0.1);
        let mut first = body(0, Vec3::new(-0.05, 0.002, 0.001));
        (first.velocity, first.spin) = (Vec3::new(0.6, 0.0, 0.05), Vec3::new(10.0, -4.0, 15.0));
        let mut second = body(10, Vec3::new(0.02, -0.003, 0.0));
        (second.shape, second.scale, second.spin) = (1, 1.3, Vec3::new(-9.0, 3.0, 5.0));
        setup.clumps =
            Clumps { shapes: vec![boomerang(), cube()], placed: vec![first, second], entries: vec![] };
        let totals = |list: &[ClumpState]| {
            let p: Vec3 = list.iter().map(|b| b.velocity * b.mass).sum();
            let l: Vec3 =
                list.iter().map(|b| b.position.cross(&b.velocity) * b.mass + b.angular_momentum).sum();
            (p, l)
        };
        let mut sim = simulation(setup);
        let start = bodies(&mut sim);
        let before = totals(&start);
        run_until(&mut sim, 0.25);
        let end = bodies(&mut sim);
        let after = totals(&end);
        assert!((end[1].velocity - start[1].velocity).norm() > 0.05, "{law:?}: they have met: {end:?}");
        assert!((after.0 - before.0).norm() < 1e-14 * before.0.norm(), "{:e}", (after.0 - before.0).norm());
        println!("{law:?}: {:e} of L", (after.1 - before.1).norm() / before.1.norm());
        assert!((after.1 - before.1).norm() < 1e-5 * before.1.norm(), "{:e}", (after.1 - before.1).norm());
    }
}
