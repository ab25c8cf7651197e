//! Sizes, masses and stiffnesses far apart.

use crate::variants::{Variant, run, simulation, variants};
use dem::setup::*;
use dem::{critical_step, mass};
use geom::{Vec3, mesh::TriMesh};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{Law, contact, grain, particles, plane, run_until};

const MOMENTUM: Case =
    case("Rest and extremes", "size ratio 1:100, mass ratio 1:10⁶: momentum is conserved in an impact");
const IMPACT: Case =
    case("Rest and extremes", "size ratio 1:100, mass ratio 1:10⁶: the small grain rebounds with e");
const PRESSED: Case = case(
    "Rest and extremes",
    "a grain 100 times larger and 10⁶ times heavier rests on a bed: the floor carries the whole weight",
);
const BORNE: Case = case(
    "Rest and extremes",
    "a grain 100 times larger and 10⁶ times heavier rests on a bed: its speed after 6 ms, over that of free fall",
);
const SMALLEST: Case = case("Time step", "size ratio 1:100: the step follows the smallest pair");
const STIFF: Case =
    case("Rest and extremes", "stiffness ratio 10⁶ in one scene: each pair rebounds with its e");

fn stiffened(setup: Setup, factor: f64) -> Setup {
    let mut setup = setup;
    setup.materials.iter_mut().for_each(|m| m.young *= factor);
    for c in &mut setup.contacts {
        c.set("stiffness", c.number("stiffness").map(|k| k * factor));
    }
    setup
}

#[test]
fn a_large_grain_and_a_small_one_meet() {
    for variant in variants() {
        let mut setup = stiffened(variant.smooth(0.5), 100.0);
        setup.step = Step::Auto(0.004);
        let at = |id, x: f64, radius, v| Particle {
            radius,
            velocity: Vec3::new(v, 0.0, 0.0),
            ..grain(id, Vec3::new(x, 0.0, 0.0))
        };
        setup.particles = vec![at(1, 0.0, 0.1, 0.0), at(2, 0.1011, 0.001, -1.0)];
        let (large, small) = (mass(0.1, 2500.0), mass(0.001, 2500.0));
        assert!((large / small / 1e6 - 1.0).abs() < 1e-12);
        let mut sim = simulation(setup);
        run_until(&mut sim, 2e-3);
        let all = particles(&mut sim);
        let (v1, v2) = (all[0].velocity.x, all[1].velocity.x);
        let lost = (large * v1 + small * v2 + small) / small;
        MOMENTUM.within(&variant.name(), lost, "of what the small grain brought", 1e-12);
        if !variant.adheres() {
            IMPACT.equals(&variant.name(), v2 - v1, "m/s", 0.5, 1e-3);
        }
    }
}

/// 49 grains of 1 mm on a floor, fenced in, and one of 100 mm put on them.
fn bed(variant: &Variant) -> Setup {
    let mut setup = stiffened(variant.rough(0.2, 0.5), 100.0);
    setup.gravity.z = -9.81;
    setup.step = Step::Auto(0.8);
    let small = |k: u32| {
        let at = |n: u32| 0.002 * (f64::from(n) - 3.0);
        Particle { radius: 0.001, ..grain(k, Vec3::new(at(k % 7), at(k / 7), 0.001)) }
    };
    setup.particles = (0..49).map(small).collect();
    setup.particles.push(Particle { radius: 0.1, ..grain(100, Vec3::new(0.0, 0.0, 0.102)) });
    setup.walls = vec![plane(Vec3::z())];
    // Low panes, which the large grain does not reach.
    setup.walls.extend([Vec3::x(), -Vec3::x(), Vec3::y(), -Vec3::y()].map(|n| {
        let (across, up) = (n.cross(&Vec3::z()) * 0.02, Vec3::z() * 0.0015);
        let base = -n * 0.007;
        let vertices = vec![base - across, base + across, base + across + up, base - across + up];
        let shape = WallShape::Mesh(TriMesh { vertices, faces: vec![[0, 1, 2], [0, 2, 3]] });
        Wall { shape, ..plane(n) }
    }));
    setup
}

/// It swings for seconds on so many springs that are made for small grains, so the force is a mean over its swings, by the impulse:
/// what the weight and the floor have given is what has become of the momentum.
#[test]
fn a_large_grain_presses_on_a_bed_of_small_ones() {
    for variant in variants() {
        let setup = bed(&variant);
        let limit = critical_step(&setup).expect("contacts");
        let alone = Setup { particles: setup.particles[..49].to_vec(), ..setup.clone() };
        let small = critical_step(&alone).expect("contacts").dt;
        SMALLEST.refused(&variant.name(), &limit.cause.to_string(), &["radius 1.0000e-3 m"]);
        SMALLEST.equals(
            &format!("{}: over that of small grains alone", variant.name()),
            limit.dt,
            "s",
            small,
            0.3,
        );
        let weight: f64 = setup.particles.iter().map(|p| mass(p.radius, 2500.0) * 9.81).sum();
        let mut sim = simulation(setup);
        let (mut sum, mut count) = (0.0, 0);
        while sim.time() < 0.006 {
            run(&mut sim, 8);
            sum -= sim.wall_forces().expect("fine")[0].force.z;
            count += 1;
        }
        let all = particles(&mut sim);
        // It has not fallen freely for 6 ms: what is missing to −g t, and more, it has from the bed.
        let fallen = -all[49].velocity.z / (9.81 * sim.time());
        BORNE.within(&variant.name(), fallen, "of g t", 0.8);
        let gained: f64 = all.iter().map(|p| mass(p.radius, 2500.0) * p.velocity.z).sum();
        let floor = sum / f64::from(count) - gained / sim.time();
        PRESSED.equals(&variant.name(), floor, "N", weight, 1e-3);
        let low = all.iter().map(|p| p.position.z - p.radius).fold(f64::INFINITY, f64::min);
        assert!(
            low > -2.5e-4 && all.len() == 50 && all[49].position.z > 0.1015,
            "{}: {low} m",
            variant.name()
        );
    }
}

/// Two pairs that collide at the same time, one a million times stiffer.
#[test]
fn soft_and_stiff_in_one_scene() {
    for variant in variants().iter().filter(|v| !v.adheres()) {
        let mut setup = variant.smooth(0.5);
        setup.materials[0].young = 1e6;
        setup.materials[1].young = 1e12;
        let law = |k: f64| match variant.normal.law {
            Law::Hooke { tangential_ratio, .. } => Law::Hooke { stiffness: k, tangential_ratio },
            other => other,
        };
        setup.contacts = vec![
            contact((0, 0), law(1e3), 0.5),
            contact((1, 1), law(1e9), 0.5),
            contact((0, 1), law(1e3), 0.5),
        ];
        let at = |id: u32, material, x: f64, v: f64| Particle {
            material,
            velocity: Vec3::new(v, 0.0, 0.0),
            ..grain(id, Vec3::new(x, 0.1 * f64::from(material), 0.0))
        };
        setup.particles =
            vec![at(1, 0, 0.0, 0.1), at(2, 0, 0.0201, -0.1), at(3, 1, 0.0, 0.1), at(4, 1, 0.0201, -0.1)];
        setup.step = Step::Auto(0.2);
        let mut sim = simulation(setup);
        run_until(&mut sim, 0.02);
        let all = particles(&mut sim);
        for (pair, a) in [("soft", 0), ("stiff", 2)] {
            let rebound = all[a + 1].velocity.x - all[a].velocity.x;
            STIFF.equals(&format!("{}, the {pair} pair", variant.name()), rebound, "m/s", 0.1, 1e-3);
        }
    }
}
