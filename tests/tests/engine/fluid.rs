//! Drag and buoyancy against closed answers, and the ledger of scenes that a fluid, an inlet or an outlet takes part in.

use dem::setup::*;
use dem::{Setup, Simulation, critical_step, mass};
use geom::{Moments, Plane, Vec3};
use grainpipe_tests::setups::{HOOKE, empty, grain, particles, plane, run_until, with_friction};
use nalgebra::UnitQuaternion;
use scene::advice::explain_setup_error;
use std::f64::consts::PI;

const RADIUS: f64 = 0.01;

fn fluid(law: DragLaw, viscosity: f64) -> Drag {
    Drag { law, viscosity, density: 1000.0, velocity: Vec3::zeros(), buoyancy: false }
}

/// One grain of 10 mm and 2500 kg/m³ in a fluid.
fn sinking(drag: Drag) -> Setup {
    let mut setup = empty(HOOKE, 0.5);
    setup.gravity.z = -9.81;
    setup.drag = Some(drag);
    setup.particles = vec![grain(1, Vec3::zeros())];
    setup
}

fn speed(setup: Setup, time: f64) -> (f64, f64) {
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, time);
    (particles(&mut sim)[0].velocity.z, sim.time())
}

/// v(t) = v∞ (1 − e^{−t/τ}), v∞ = g τ (1 − ρ_f/ρ), τ = m / 6πμr, at all times on the way.
#[test]
fn stokes_relaxation_and_terminal_velocity() {
    for buoyancy in [false, true] {
        let drag = Drag { buoyancy, ..fluid(DragLaw::Stokes, 50.0) };
        let tau = mass(RADIUS, 2500.0) / (6.0 * PI * 50.0 * RADIUS);
        let heavy = if buoyancy { 1.0 - 1000.0 / 2500.0 } else { 1.0 };
        for share in [0.3, 1.0, 3.0, 25.0] {
            let mut setup = sinking(drag);
            setup.step = Step::Auto(0.01);
            let (v, t) = speed(setup, share * tau);
            let expected = -9.81 * tau * heavy * -(-t / tau).exp_m1();
            assert!((v / expected - 1.0).abs() < 2e-5, "{share} τ: {v} m/s instead of {expected}");
        }
    }
}

/// A fluid that flows takes a weightless grain along: u (1 − e^{−t/τ}).
#[test]
fn a_flowing_fluid_takes_grains_along() {
    let mut setup = sinking(Drag { velocity: Vec3::new(0.0, 0.0, 0.5), ..fluid(DragLaw::Stokes, 50.0) });
    setup.gravity = Vec3::zeros();
    setup.step = Step::Auto(0.01);
    let tau = mass(RADIUS, 2500.0) / (6.0 * PI * 50.0 * RADIUS);
    let (v, t) = speed(setup, tau);
    assert!((v / (0.5 * -(-t / tau).exp_m1()) - 1.0).abs() < 2e-5, "{v}");
}

/// Terminal velocity after Schiller and Naumann, by bisection of drag = weight, below and above Re = 1000.
#[test]
fn schiller_naumann_terminal_velocity() {
    for viscosity in [1.0, 0.05, 0.001] {
        let drag = Drag { buoyancy: true, ..fluid(DragLaw::SchillerNaumann, viscosity) };
        let weight = (2500.0 - 1000.0) * 4.0 / 3.0 * PI * RADIUS.powi(3) * 9.81;
        let force = |v: f64| {
            let re = 1000.0 * v * 2.0 * RADIUS / viscosity;
            let coefficient = if re < 1000.0 { 24.0 / re * (1.0 + 0.15 * re.powf(0.687)) } else { 0.44 };
            0.5 * coefficient * 1000.0 * PI * RADIUS * RADIUS * v * v
        };
        let (mut low, mut high) = (1e-9, 10.0);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if force(middle) < weight { low = middle } else { high = middle }
        }
        let (v, _) = speed(sinking(drag), 4.0);
        assert!((-v / low - 1.0).abs() < 1e-6, "μ = {viscosity}: {v} m/s instead of {low}");
    }
}

/// A thick fluid sets the step, and the message names it; without one, nothing changes.
#[test]
fn relaxation_time_bounds_the_step() {
    let thin = critical_step(&sinking(fluid(DragLaw::Stokes, 1e-5))).expect("sound");
    let mut dry = sinking(fluid(DragLaw::Stokes, 1e-5));
    dry.drag = None;
    let dry = critical_step(&dry).expect("sound");
    assert!((thin.dt / dry.dt - 1.0).abs() < 1e-5 && thin.cause == dry.cause, "{thin:?} {dry:?}");
    let thick = critical_step(&sinking(fluid(DragLaw::Stokes, 1e5))).expect("sound");
    let tau = mass(RADIUS, 2500.0) / (6.0 * PI * 1e5 * RADIUS);
    assert!(thick.dt < tau && thick.dt > 0.9 * tau && thick.cause.drag.is_some(), "{thick:?}");
    let mut setup = sinking(fluid(DragLaw::Stokes, 1e5));
    setup.step = Step::Fixed(0.5 * dry.dt);
    let error = explain_setup_error(&Simulation::new(setup).err().expect("refused"));
    assert!(error.contains("above the critical step") && error.contains("[drag]"), "{error}");
    // The largest step that is allowed decays.
    let mut setup = sinking(fluid(DragLaw::Stokes, 1e5));
    setup.step = Step::Auto(1.0);
    setup.gravity = Vec3::zeros();
    setup.particles[0].velocity.x = 1e-6;
    let mut sim = Simulation::new(setup).expect("sound");
    (0..2000).for_each(|_| sim.step().expect("stable"));
    assert!(particles(&mut sim)[0].velocity.norm() < 1e-6);
}

/// A clump of so many spheres of 10 mm in a row along x, that do not overlap.
fn row(spheres: u32) -> ClumpShape {
    let at = |k: u32| (Vec3::new(2.0 * RADIUS * f64::from(k), 0.0, 0.0), RADIUS);
    let spheres: Vec<(Vec3, f64)> = (0..spheres).map(at).collect();
    ClumpShape::new("row", 0, &spheres, &Moments::of_sum(&spheres))
}

fn body(id: u32, position: Vec3) -> Body {
    let (velocity, spin) = (Vec3::zeros(), Vec3::zeros());
    Body { id, shape: 0, scale: 1.0, position, orientation: UnitQuaternion::identity(), velocity, spin }
}

/// A clump of one sphere is that sphere, with either law, sinking or rising.
#[test]
fn a_clump_of_one_sphere_sinks_as_the_sphere() {
    for (law, viscosity, density) in [
        (DragLaw::Stokes, 50.0, 1000.0),
        (DragLaw::SchillerNaumann, 0.01, 1000.0),
        (DragLaw::Stokes, 50.0, 4000.0),
    ] {
        let drag =
            Drag { density, buoyancy: true, velocity: Vec3::new(0.2, 0.0, 0.0), ..fluid(law, viscosity) };
        let mut free = sinking(drag);
        free.step = Step::Fixed(1e-4);
        let mut whole = Setup { particles: Vec::new(), ..free.clone() };
        whole.clumps =
            Clumps { shapes: vec![row(1)], placed: vec![body(1, Vec3::zeros())], ..Clumps::default() };
        let [free, whole] = [free, whole].map(|setup| {
            let mut sim = Simulation::new(setup).expect("sound");
            run_until(&mut sim, 0.3);
            particles(&mut sim)[0]
        });
        assert!((free.velocity - whole.velocity).norm() < 1e-12 * free.velocity.norm(), "{free:?} {whole:?}");
        assert!((free.position - whole.position).norm() < 1e-12, "{free:?} {whole:?}");
        assert!(free.velocity.z * (density - 2500.0) > 0.0 && free.velocity.x > 0.0, "{free:?}");
    }
}

/// v∞ = g τ (1 − ρ_f/ρ), τ = m / 6πμR with R of a sphere of its volume, whichever way it lies.
#[test]
fn a_clump_sinks_as_a_sphere_of_its_volume() {
    let drag = Drag { buoyancy: true, ..fluid(DragLaw::Stokes, 50.0) };
    let (volume, density) = (3.0 * mass(RADIUS, 1.0), 2500.0);
    let radius = (0.75 / PI * volume).cbrt();
    let tau = volume * density / (6.0 * PI * 50.0 * radius);
    for turn in [0.0, 0.7] {
        let mut setup = Setup { particles: Vec::new(), ..sinking(drag) };
        let orientation = UnitQuaternion::from_scaled_axis(Vec3::new(0.0, turn, 0.3));
        let bodies = vec![Body { orientation, ..body(1, Vec3::zeros()) }];
        setup.clumps = Clumps { shapes: vec![row(3)], placed: bodies, ..Clumps::default() };
        setup.step = Step::Auto(0.01);
        let mut sim = Simulation::new(setup).expect("sound");
        run_until(&mut sim, 2.0 * tau);
        let (v, t) = (sim.clumps().expect("sound")[0].velocity.z, sim.time());
        let expected = -9.81 * tau * (1.0 - 1000.0 / density) * -(-t / tau).exp_m1();
        assert!((v / expected - 1.0).abs() < 2e-5, "{v} m/s instead of {expected}");
    }
}

fn closing(setup: Setup, time: f64) -> (f64, dem::Energy) {
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, time);
    let e = sim.energy().expect("sound");
    (e.integration, e)
}

/// Grains sink onto a floor in a fluid that flows: what the fluid takes and gives closes the ledger.
#[test]
fn ledger_closes_in_a_fluid() {
    let drag =
        Drag { velocity: Vec3::new(0.3, 0.0, 0.0), buoyancy: true, ..fluid(DragLaw::SchillerNaumann, 0.1) };
    let mut setup = with_friction(sinking(drag), 0.4);
    setup.ledger = true;
    setup.walls = vec![plane(Vec3::z())];
    setup.particles = (0..40)
        .map(|k| {
            grain(
                k,
                Vec3::new(
                    0.021 * (k % 4) as f64,
                    0.021 * (k / 4 % 3) as f64,
                    0.05 + 0.0211 * (k / 12) as f64,
                ),
            )
        })
        .collect();
    let mut clumps = Setup { particles: setup.particles.split_off(20), ..setup.clone() };
    let bodies = (0..8).map(|k| Body {
        spin: Vec3::new(3.0, f64::from(k), 1.0),
        ..body(100 + 3 * k, Vec3::new(0.02, 0.03 * f64::from(k), 0.15))
    });
    clumps.clumps = Clumps { shapes: vec![row(3)], placed: bodies.collect(), ..Clumps::default() };
    for setup in [setup, clumps] {
        let (error, e) = closing(setup, 0.5);
        assert!(e.drag.abs() > 1e-3, "{e:?}");
        assert!(error.abs() < 1e-5 * (e.drag.abs() + e.normal + e.sliding), "{error:e} of {e:?}");
    }
}

/// Grains come through a calculation plane, fall on a shelf, rub each other, and leave through a storage plane.
#[test]
fn ledger_closes_with_inlet_and_outlet() {
    let mut setup = with_friction(empty(HOOKE, 0.6), 0.4);
    setup.ledger = true;
    setup.gravity = Vec3::new(2.0, 0.0, -9.81);
    setup.walls = vec![plane(Vec3::z())];
    let zone =
        |x: f64, length: f64| Zone::new(Plane { point: Vec3::new(x, 0.0, 0.0), normal: Vec3::x() }, length);
    setup.inlets = vec![zone(0.05, 0.05)];
    setup.outlets = vec![zone(0.2, 0.03)];
    (setup.smallest_entry, setup.largest_entry, setup.entry_materials) = (0.01, 0.01, vec![0]);
    setup.particles =
        vec![grain(1000, Vec3::new(0.12, 0.001, 0.0101)), grain(1001, Vec3::new(0.13, -0.001, 0.0303))];
    let run = |mut setup: Setup, step: f64| {
        setup.step = Step::Fixed(step);
        let mut sim = Simulation::new(setup).expect("sound");
        for k in 0..60u32 {
            let mut p = grain(k, Vec3::new(0.0, 0.002 * f64::from(k % 3), 0.012 + 0.021 * f64::from(k % 2)));
            p.velocity = Vec3::new(0.6 + 0.1 * f64::from(k % 2), 0.0, 0.0);
            p.spin.y = 5.0;
            sim.enter(Entry {
                time: 0.045 * f64::from(k / 2),
                inlet: 0,
                particle: p,
                clump: None,
                turn: None,
                cluster: 0,
            })
            .expect("in time");
        }
        run_until(&mut sim, 0.9);
        let e = sim.energy().expect("sound");
        assert!(e.entered > 0.0 && e.left > 0.0 && e.normal > 0.0, "{e:?}");
        e.integration.abs() / (e.entered.abs() + e.left.abs() + e.normal + e.sliding)
    };
    let (coarse, fine) = (run(setup.clone(), 4e-5), run(setup, 1e-5));
    println!("{coarse:e} {fine:e}");
    assert!(coarse < 2e-3 && fine < 5e-4, "{coarse:e}, {fine:e} of what was exchanged");
}

/// No fluid: the code of a scene without one, bit for bit; a fluid that does nothing comes close.
#[test]
fn absent_fluid_changes_nothing() {
    let fall = |drag: Option<Drag>| {
        let mut setup = sinking(fluid(DragLaw::Stokes, 1.0));
        setup.drag = drag;
        setup.step = Step::Fixed(1e-4);
        let sim = Simulation::new(setup).expect("sound");
        (sim.bytes_per_particle(), speed_of(sim))
    };
    let (dry, thin) = (fall(None), fall(Some(fluid(DragLaw::Stokes, 1e-12))));
    assert_eq!(dry.0, thin.0, "drag has no memory");
    assert!((dry.1 - thin.1).abs() < 1e-9);
}

fn speed_of(mut sim: Simulation) -> f64 {
    run_until(&mut sim, 0.1);
    particles(&mut sim)[0].velocity.z
}
