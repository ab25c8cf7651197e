//! Few contacts: the bound is for twelve, and two times below the limit of one.

use crate::trial::{ALL, Trial};
use dem::setup::*;
use dem::{Setup, mass};
use geom::{Plane, Vec3};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{HOOKE, Law, contact, empty, grain, with_friction};
use std::f64::consts::{PI, SQRT_2};

const LINE: Case = case(
    "Time step",
    "grain between two planes, linear law: true limit is 2/ω (√(1 + 2γ²) − √2 γ), ω² = 2k/m",
);
const FEWER: Case =
    case("Time step", "few contacts: true limit over the bound (which is for twelve contacts) is above 1");

const R: f64 = 0.01;

/// The closed form that the bound is made of.
#[test]
fn two_contacts_in_closed_form() {
    for e in [1.0f64, 0.5, 0.1] {
        let ln = e.ln();
        let gamma = -2.0 * ln / (PI * PI + ln * ln).sqrt();
        let (bound, share) =
            Trial { name: "grain between two planes", setup: between_walls(HOOKE, e), ways: ALL }.limit();
        let omega = (2.0 * 1e4 / mass(R, 2500.0)).sqrt();
        let expected = 2.0 / omega * ((1.0 + 2.0 * gamma * gamma).sqrt() - SQRT_2 * gamma);
        LINE.equals(&format!("e = {e}"), share * bound, "s", expected, 0.01);
    }
}

/// A grain between two planes that are nearer than its diameter.
fn between_walls(law: Law, e: f64) -> Setup {
    let mut setup = empty(law, e);
    let half = 0.99 * R;
    let wall = |z: f64, normal: Vec3| {
        Wall::new("plane", 1, WallShape::Plane(Plane { point: Vec3::new(0.0, 0.0, z), normal }))
    };
    setup.guards.overlap = 0.0101;
    setup.walls = vec![wall(-half, Vec3::z()), wall(half, -Vec3::z())];
    setup.particles = vec![grain(0, Vec3::zeros())];
    setup
}

fn note(trial: &Trial) {
    let share = trial.safe();
    FEWER.within(&format!("{} ({share:.2})", trial.name), (1.0 - share).max(0.0), "–", 0.005);
}

#[test]
fn between_two_planes() {
    for (name, law, e, friction) in [
        ("grain between two planes, hooke, e = 1", HOOKE, 1.0, false),
        ("grain between two planes, hooke, e = 0.1", HOOKE, 0.1, false),
        ("grain between two planes, hertz, e = 1", Law::Hertz, 1.0, false),
        ("grain between two planes, friction, e = 1", HOOKE, 1.0, true),
        ("grain between two planes, friction, e = 0.1", HOOKE, 0.1, true),
    ] {
        let setup = between_walls(law, e);
        note(&Trial { name, setup: if friction { with_friction(setup, 1.0) } else { setup }, ways: ALL });
    }
    for (name, law, e) in [
        ("grain between two planes, hooke, e = 1, mixed precision", HOOKE, 1.0),
        ("grain between two planes, hertz, e = 0.1, mixed precision", Law::Hertz, 0.1),
    ] {
        let setup = Setup { precision: Precision::Mixed, ..with_friction(between_walls(law, e), 1.0) };
        // What single precision rounds off stirs them more than the trial does: where it turns unstable is asked alone.
        let (_, share) = Trial { name, setup, ways: ALL }.limit();
        FEWER.within(&format!("{name} ({share:.2})"), (1.0 - share).max(0.0), "–", 0.005);
    }
}

/// Grains of one tenth between large ones, on a line that they fill. It moves along itself only: under pressure it would buckle.
#[test]
fn sizes_of_one_to_ten() {
    for (name, e) in
        [("row of sizes 1 : 10, hooke, e = 1", 1.0), ("row of sizes 1 : 10, hooke, e = 0.5", 0.5)]
    {
        let mut setup = empty(HOOKE, e);
        let radii = [10.0, 1.0, 1.0, 10.0, 1.0, 1.0, 10.0, 1.0, 1.0].map(|share| share * R);
        let overlap = 0.01 * R;
        let mut x = 0.0;
        for (id, k) in (0u32..).zip(0..radii.len()) {
            setup.particles.push(Particle { radius: radii[k], ..grain(id, Vec3::new(x, 0.0, 0.0)) });
            x += radii[k] + radii[(k + 1) % radii.len()] - overlap;
        }
        setup.periodic = [Some((-R, x - R)), None, None];
        note(&Trial { name, setup, ways: Vec3::x() });
    }
}

/// A light bead among 200 small heavy balls, each held by a wall sphere behind it: far more than twelve contacts.
#[test]
fn a_light_bead_in_a_shell_of_heavy_balls() {
    for (name, e) in [("bead in a shell of balls, hooke, e = 1", 1.0), ("the same, e = 0.5", 0.5)] {
        let mut setup = empty(HOOKE, e);
        setup.materials[0].density = 7800.0;
        setup.materials.push(Material {
            name: "bead".to_owned(),
            density: 20.0,
            ..setup.materials[0].clone()
        });
        setup.contacts.push(contact((0, 2), HOOKE, e));
        setup.contacts.push(contact((1, 2), HOOKE, e));
        setup.contacts.push(contact((2, 2), HOOKE, e));
        // So little pressed that nothing buckles within the trial.
        let (ball, count) = (0.12 * R, 200u32);
        let pressed = 1e-8 * ball;
        setup.particles = vec![Particle { material: 2, ..grain(0, Vec3::zeros()) }];
        let mut held = Vec::new();
        for k in 0..count {
            // Fibonacci's lattice on the sphere.
            let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(count);
            let (sin, cos) = (f64::from(k) * PI * (3.0 - 5f64.sqrt())).sin_cos();
            let out = Vec3::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z);
            setup.particles.push(Particle { radius: ball, ..grain(k + 1, out * (R + ball - pressed)) });
            held.push((out * (R + 3.0 * ball - 2.0 * pressed), ball));
        }
        let shape = WallShape::Spheres(held);
        setup.walls = vec![Wall::new("shell", 1, shape)];
        note(&Trial { name, setup, ways: ALL });
    }
}

/// A grain wedged between two beds of wall spheres, in a hollow of three on each side.
#[test]
fn between_walls_of_spheres() {
    for (name, e, friction, rolling) in [
        ("grain in hollows of wall spheres, hooke, e = 1", 1.0, false, None),
        ("grain in hollows of wall spheres, friction, e = 0.3", 0.3, true, None),
        ("grain in hollows of wall spheres, rolling resistance 0.5, e = 0.3", 0.3, true, Some(0.5)),
    ] {
        let mut setup = if friction { with_friction(empty(HOOKE, e), 1.0) } else { empty(HOOKE, e) };
        setup.contacts.iter_mut().for_each(|c| c.set("rolling_resistance", rolling));
        let (side, reach) = (R, 0.99 * 2.0 * R);
        let height = (reach * reach - side * side / 3.0).sqrt();
        let mut spheres = Vec::new();
        for z in [-height, height] {
            for k in 0..3 {
                let angle =
                    2.0 * std::f64::consts::FRAC_PI_3 * f64::from(k) + if z > 0.0 { 0.5 } else { 0.0 };
                let out = side / 3f64.sqrt();
                spheres.push((Vec3::new(out * angle.cos(), out * angle.sin(), z), R));
            }
        }
        let (name_of, shape) = ("beds".to_owned(), WallShape::Spheres(spheres));
        setup.walls = vec![Wall::new(name_of, 1, shape)];
        setup.particles = vec![grain(0, Vec3::zeros())];
        note(&Trial { name, setup, ways: ALL });
    }
}

/// Twelve wall spheres around a grain: the most that can touch it where they do not lie within each other.
#[test]
fn cage_of_wall_spheres() {
    for (name, e, rolling, wall) in [
        ("cage of twelve wall spheres, e = 1", 1.0, None, 1.0),
        ("cage of twelve wall spheres, 4 times as stiff, e = 0.3", 0.3, None, 4.0),
        ("cage of twelve wall spheres, 4 times as stiff, rolling 0.5, e = 0.3", 0.3, Some(0.5), 4.0),
        ("cage of twelve wall spheres, 4 times as stiff, rolling 1, e = 1", 1.0, Some(1.0), 4.0),
    ] {
        let mut setup = with_friction(empty(HOOKE, e), 1.0);
        setup.contacts[1].set("stiffness", wall * 1e4);
        setup.contacts.iter_mut().for_each(|c| c.set("rolling_resistance", rolling));
        let d = 0.995 * 2.0 * R / 2f64.sqrt();
        let mut spheres = Vec::new();
        for (a, b) in [(d, d), (d, -d), (-d, d), (-d, -d)] {
            let ways = [Vec3::new(a, b, 0.0), Vec3::new(a, 0.0, b), Vec3::new(0.0, a, b)];
            spheres.extend(ways.map(|place| (place, R)));
        }
        let (name_of, shape) = ("cage".to_owned(), WallShape::Spheres(spheres));
        setup.walls = vec![Wall::new(name_of, 1, shape)];
        setup.particles = vec![grain(0, Vec3::zeros())];
        note(&Trial { name, setup, ways: ALL });
    }
}
