//! Walls on springs: against closed forms, and against the two coupled equations solved finely.

use dem::setup::*;
use dem::{Halt, Setup, Simulation};
use geom::Vec3;
use grainpipe_tests::same_bits::{Run, steps, wall_bits};
use grainpipe_tests::setups::{
    HOOKE, Law, empty, grain, lattice, particles, plane, run_until, with_friction,
};
use std::f64::consts::PI;

const K: f64 = 1e4;
const G: f64 = 9.81;

fn mass() -> f64 {
    dem::mass(0.01, 2500.0)
}

fn mounted(stiffness: f64, damping: f64, mass: f64) -> Wall {
    let mount = Mount { direction: Vec3::z(), stiffness, damping, mass, speed_limit: 2.0 };
    Wall { name: "plate".to_owned(), mount: Some(mount), ..plane(Vec3::z()) }
}

fn shift(sim: &mut Simulation) -> f64 {
    sim.wall_forces().expect("sound")[0].shift.z
}

/// A grain with e = 1 strikes a plate on a soft spring and leaves: v' = (m − M)/(m + M) v. The plate then oscillates freely:
/// s = −A e^(−ζ ω t) sin ω' t.
#[test]
fn struck_plate_oscillates_freely() {
    let (m, plate, stiffness, zeta): (f64, f64, f64, f64) = (mass(), 0.05, 200.0, 0.05);
    let omega = (stiffness / plate).sqrt();
    let mut setup = empty(HOOKE, 1.0);
    setup.step = Step::Auto(0.02);
    setup.walls = vec![mounted(stiffness, 2.0 * zeta * omega * plate, plate)];
    setup.particles = vec![grain(1, Vec3::z() * 0.0101)];
    setup.particles[0].velocity.z = -0.5;
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, 0.02);
    let bounced = particles(&mut sim)[0].velocity.z / -0.5;
    let wanted = (m - plate) / (m + plate);
    assert!((bounced / wanted - 1.0).abs() < 0.02, "{bounced} instead of {wanted}");
    // Turning points of the plate.
    let (mut turns, mut two) = (Vec::new(), [shift(&mut sim); 2]);
    while turns.len() < 6 {
        sim.step().expect("within the guards");
        let s = shift(&mut sim);
        if (two[1] - two[0]) * (s - two[1]) < 0.0 {
            turns.push((sim.time(), two[1].abs()));
        }
        two = [two[1], s];
    }
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    let period = (turns[5].0 - turns[1].0) / 2.0;
    assert!((period / (2.0 * PI / damped) - 1.0).abs() < 1e-4, "{period}: {turns:?}");
    let (found, wanted) = (turns[5].1 / turns[1].1, (-zeta * omega * 2.0 * period).exp());
    assert!((found / wanted - 1.0).abs() < 1e-3, "{found} instead of {wanted}");
}

/// z'' and s'' of a grain on a plate, k (r − z + s) while they touch.
fn rates([z, v, s, u]: [f64; 4], (plate, stiffness, damping): (f64, f64, f64)) -> [f64; 4] {
    let push = K * (0.01 - z + s).max(0.0);
    [v, push / mass() - G, u, (-push - stiffness * s - damping * u) / plate]
}

/// The same by Runge and Kutta's fourth order.
fn reference(mut at: [f64; 4], of: (f64, f64, f64), time: f64) -> [f64; 4] {
    let steps = 200_000;
    let h = time / f64::from(steps);
    let add = |a: [f64; 4], b: [f64; 4], f: f64| std::array::from_fn(|k| a[k] + f * b[k]);
    for _ in 0..steps {
        let a = rates(at, of);
        let b = rates(add(at, a, 0.5 * h), of);
        let c = rates(add(at, b, 0.5 * h), of);
        let d = rates(add(at, c, h), of);
        at = std::array::from_fn(|k| at[k] + h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]));
    }
    at
}

fn on_plate(height: f64, share: f64, of: (f64, f64, f64)) -> Setup {
    let (plate, stiffness, damping) = of;
    let mut setup = empty(HOOKE, 1.0);
    setup.gravity = Vec3::z() * -G;
    setup.step = Step::Auto(share);
    setup.walls = vec![mounted(stiffness, damping, plate)];
    setup.particles = vec![grain(1, Vec3::z() * height)];
    setup
}

/// A grain dropped on a plate: z and s after the first and the second impact, compared with the coupled equations.
#[test]
fn dropped_grain_and_plate_follow_the_coupled_equations() {
    let of = (0.03, 2000.0, 1.0);
    let mut sim = Simulation::new(on_plate(0.013, 0.02, of)).expect("sound");
    for time in [0.024, 0.03, 0.05, 0.08] {
        run_until(&mut sim, time);
        let wanted = reference([0.013, 0.0, 0.0, 0.0], of, sim.time());
        let (z, s) = (particles(&mut sim)[0].position.z, shift(&mut sim));
        println!("{time}: z {z:e} {:e}, s {s:e} {:e}", z - wanted[0], s - wanted[2]);
        assert!((z - wanted[0]).abs() < 3e-6 && (s - wanted[2]).abs() < 3e-6, "{time}: {z}, {s}: {wanted:?}");
    }
}

/// In contact the error falls with the square of the step.
#[test]
fn order_of_the_step_is_two() {
    let of = (0.03, 2000.0, 1.0);
    let start = 0.01 - 0.8 * mass() * G / K;
    let error = |share: f64| {
        let mut sim = Simulation::new(on_plate(start, share, of)).expect("sound");
        run_until(&mut sim, 0.02);
        let wanted = reference([start, 0.0, 0.0, 0.0], of, sim.time());
        (particles(&mut sim)[0].position.z - wanted[0]).hypot(shift(&mut sim) - wanted[2])
    };
    let [coarse, fine] = [0.08, 0.02].map(error);
    let order = (coarse / fine).log(4.0);
    println!("{coarse:e} {fine:e}: order {order}");
    assert!((order - 2.0).abs() < 0.2, "order {order}: {coarse:e}, {fine:e}");
}

/// Grains of three layers fall on a plate on a spring.
fn shaken(law: Law) -> Setup {
    let mut setup = with_friction(empty(law, 0.5), 0.4);
    (setup.gravity, setup.ledger) = (Vec3::z() * -G, true);
    setup.step = Step::Auto(0.3);
    setup.walls = vec![mounted(5000.0, 3.0, 0.3)];
    setup.particles = lattice([4, 4, 3], Vec3::new(0.0, 0.0, 0.05));
    setup.particles.iter_mut().for_each(|p| p.position.x += 1e-4 * f64::from(p.id % 7));
    setup
}

#[test]
fn energy_of_the_wall_is_in_the_ledger() {
    for law in [HOOKE, Law::Hertz] {
        let mut sim = Simulation::new(shaken(law)).expect("sound");
        let start = sim.energy().expect("sound").balance();
        for time in [0.08, 0.12, 0.4] {
            run_until(&mut sim, time);
            let e = sim.energy().expect("sound");
            let of = e.exchanged() + e.translation;
            println!(
                "{law:?} {time}: {:e}, made {:e}, {e:?}",
                (e.balance() - start) / of,
                e.integration / of
            );
            assert!(((e.balance() - start) / of).abs() < 1e-10, "{law:?}: {e:?}");
            assert!(e.integration.abs() / of < 1e-3 && e.walls.abs() < 1e-12 * of, "{law:?}: {e:?}");
            assert!(e.mount_damping > 0.0 && e.mount_elastic > 0.0, "{law:?}: {e:?}");
        }
    }
}

#[test]
fn same_bits_for_widths_threads_and_resumed_runs() {
    let look = |sim: &mut Simulation| {
        sim.energy().expect("sound");
    };
    let setup = || shaken(Law::Hertz);
    Run { setup: &setup, parts: [&steps(1700), &steps(1300)], look: &look, bits: &wall_bits }.check();
}

/// A wall that is too light for its contacts, or too fast, stops the run; a spring whose period the step skips is refused.
#[test]
fn unstable_walls_are_noticed() {
    let halt = |wall: Wall| {
        let mut setup = shaken(HOOKE);
        setup.walls = vec![wall];
        let mut sim = Simulation::new(setup).expect("sound");
        (0..100_000).find_map(|_| sim.step().err()).expect("it stops")
    };
    let light = halt(mounted(100.0, 0.0, 1e-4));
    assert!(matches!(&light, Halt::WallTooLight { wall, .. } if wall == "plate"), "{light}");
    let mut slow = mounted(100.0, 0.0, 0.05);
    slow.mount.as_mut().expect("a spring").speed_limit = 0.01;
    let fast = halt(slow);
    assert!(matches!(&fast, Halt::WallTooFast { wall, .. } if wall == "plate"), "{fast}");
    let mut setup = shaken(HOOKE);
    setup.step = Step::Fixed(1e-4);
    setup.walls = vec![mounted(1e7, 0.0, 0.3)];
    let error = Simulation::new(setup.clone()).err().expect("refused").to_string();
    assert!(error.contains("plate"), "{error}");
    setup.walls[0].servo = Some(Servo::force(Vec3::z(), 1.0, 1.0));
    let error = Simulation::new(setup).err().expect("refused").to_string();
    assert!(error.contains("spring"), "{error}");
}
