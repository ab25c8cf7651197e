//! The same bits: for every law, effect and precision, for everything that a scene can ask for, for every width of lanes and any
//! number of threads.

use crate::variants::{Variant, variants};
use dem::setup::*;
use dem::simd::Width;
use dem::{Setup, Simulation};
use geom::{Moments, Plane, Vec3, mesh::TriMesh};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{grain, plane, weaken};
use nalgebra::UnitQuaternion;

const WIDTHS: Case = case(
    "Same bits",
    "scalar, AVX2 and AVX-512 lanes: every normal law with every effect, in every precision",
);
const THREADS: Case = case("Same bits", "1, 2, 3 and 7 threads: every normal law, in every precision");
const SCENES: Case = case(
    "Same bits",
    "1, 2, 3 and 7 threads and every width: clumps, zones, sleep, a fluid, a servo, meshes, periodic faces, the ledger",
);

/// What rubs: sliding, then with rolling, twisting, weakening.
fn effects(variant: &Variant) -> Vec<(&'static str, Setup)> {
    let with = |change: fn(&mut ContactLaw)| {
        let mut setup = variant.smooth(0.4);
        setup.contacts.iter_mut().for_each(change);
        setup
    };
    let mut all = vec![
        ("smooth", with(|_| ())),
        ("sliding", with(|c| c.set("sliding_friction", 0.4))),
        (
            "rolling",
            with(|c| {
                c.set("sliding_friction", 0.4);
                c.set("rolling_resistance", 0.1);
            }),
        ),
    ];
    if !variant.mixed() {
        all.push((
            "twisting",
            with(|c| {
                c.set("sliding_friction", 0.4);
                c.set("rolling_resistance", 0.1);
                c.set("twisting_resistance", 0.1);
            }),
        ));
        all.push((
            "weakening, constant rolling",
            with(|c| {
                c.set("sliding_friction", 0.4);
                c.set("rolling_resistance", 0.1);
                c.choose("rolling_model", "constant");
                weaken(c, [0.4, 0.2, 0.1]);
            }),
        ));
    }
    all
}

/// Grains of three sizes, `side` along each edge, that are thrown about over a shaken floor of wall spheres and beside a mesh.
fn crowd(mut setup: Setup, side: u32) -> Setup {
    let pitch = 0.0202;
    let wide = pitch * f64::from(side);
    setup.gravity = Vec3::new(0.5, 0.0, -9.81);
    setup.step = Step::Auto(0.2);
    setup.guards.overlap = 0.5;
    setup.periodic = [Some((0.0, wide)), None, None];
    let mut floor = plane(Vec3::z());
    let at = |k: u32| {
        Vec3::new(0.5 * pitch * f64::from(k % (2 * side)), 0.5 * pitch * f64::from(k / (2 * side)), -0.009)
    };
    floor.shape = WallShape::Spheres((0..4 * side * side).map(|k| (at(k), 0.0085)).collect());
    floor.motion.amplitude = Vec3::new(0.0, 0.0, 0.001);
    floor.motion.frequency = 50.0;
    let corner = |x: f64, z: f64| Vec3::new(x, 0.0, z);
    let vertices = vec![corner(-1.0, -1.0), corner(2.0, -1.0), corner(2.0, 2.0), corner(-1.0, 2.0)];
    let mesh = WallShape::Mesh(TriMesh { vertices, faces: vec![[0, 1, 2], [0, 2, 3]] });
    let far = WallShape::Plane(Plane { point: Vec3::new(0.0, wide, 0.0), normal: -Vec3::y() });
    setup.walls =
        vec![floor, Wall { shape: mesh, ..plane(Vec3::y()) }, Wall { shape: far, ..plane(Vec3::y()) }];
    let noise = |k: u32, axis: u32| f64::from((k * 7919 + axis * 104_729) % 1009) / 504.5 - 1.0;
    setup.particles = (0..side * side * side)
        .map(|k| {
            let place = Vec3::new(
                f64::from(k % side) + 0.5,
                f64::from(k / side % side) + 0.5,
                f64::from(k / side / side) + 0.5,
            );
            Particle {
                radius: [0.01, 0.0095, 0.009][k as usize % 3],
                velocity: Vec3::new(noise(k, 1), noise(k, 2), noise(k, 3)) * 0.5,
                spin: Vec3::new(noise(k, 4), noise(k, 5), noise(k, 6)) * 10.0,
                ..grain(k, place * pitch)
            }
        })
        .collect();
    setup
}

/// Every bit of every particle, of the energy, and of what has crossed.
fn bits(setup: Setup, width: Width, threads: usize, steps: u64) -> Vec<u64> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    pool.install(|| {
        let setup = Setup { wall_sums: WallDetail::Parts, ..setup };
        let mut sim = Simulation::with_width(setup, width).expect("sound");
        let mut crossings = Vec::new();
        for _ in 0..steps {
            sim.step().expect("within the guards");
            crossings.extend(sim.take_crossings());
        }
        let of = |p: &Particle| [p.position, p.velocity, p.spin].map(|v| [v.x, v.y, v.z]).concat();
        let mut all: Vec<f64> = sim.particles().expect("fine").iter().flat_map(of).collect();
        all.extend(crossings.iter().flat_map(|c| [vec![c.time], of(&c.particle)].concat()));
        all.extend(sim.wall_forces().expect("fine").iter().flat_map(|f| [f.force.x, f.force.y, f.force.z]));
        let sums = sim.take_wall_sums().expect("fine");
        let of_wall = |w: &dem::WallSum| {
            let own = [w.work, w.normal, w.largest, w.sliding, w.impacts as f64];
            [&own[..], w.impulse.as_slice(), w.moment.as_slice(), &w.impact_energy].concat()
        };
        all.extend(sums.walls.iter().flat_map(of_wall));
        let of_part = |p: &dem::PartSum| [p.normal, p.largest, p.sliding, p.impact_energy[0]];
        all.extend(sums.parts.iter().flatten().flat_map(of_part));
        let e = sim.energy().expect("fine");
        all.extend([
            e.translation,
            e.rotation,
            e.elastic,
            e.normal,
            e.sliding,
            e.rolling,
            e.twisting,
            e.walls,
            e.left,
        ]);
        all.extend([crossings.len() as f64, sim.asleep() as f64]);
        assert!(all.iter().all(|x| x.is_finite()));
        all.into_iter().map(f64::to_bits).collect()
    })
}

/// Numbers that differ from those of the first.
fn differing(all: &[Vec<u64>]) -> f64 {
    let other = |b: &Vec<u64>| {
        if b.len() == all[0].len() {
            b.iter().zip(&all[0]).filter(|(a, b)| a != b).count()
        } else {
            usize::MAX
        }
    };
    all.iter().map(other).max().unwrap_or(0) as f64
}

#[test]
fn every_effect_has_the_same_bits_for_every_width() {
    for variant in variants() {
        for (name, setup) in effects(&variant) {
            let setup = crowd(Setup { ledger: true, ..setup }, 6);
            let all: Vec<_> =
                Width::available().into_iter().map(|w| bits(setup.clone(), w, 1, 200)).collect();
            WIDTHS.within(&format!("{}, {name}", variant.name()), differing(&all), "numbers differ", 0.0);
        }
    }
}

/// Threads share out tiles of 256 particles, and only where there are eight or more of them.
#[test]
fn every_law_has_the_same_bits_for_any_number_of_threads() {
    for variant in variants() {
        let setup = crowd(variant.rough(0.4, 0.4), 13);
        let all = [1, 2, 3, 7].map(|threads| bits(setup.clone(), Width::best(), threads, 100));
        THREADS.within(&variant.name(), differing(&all), "numbers differ", 0.0);
    }
}

/// What a scene can ask for besides.
fn scenes() -> Vec<(&'static str, Setup)> {
    let [hertz, .., mixed] = &variants()[1..] else { return Vec::new() };
    let base = |v: &Variant| Setup { ledger: true, ..crowd(v.rough(0.4, 0.4), 13) };
    let mut sleepy = base(hertz);
    // Beside walls that move faster than half of this speed nothing may sleep.
    sleepy.walls.iter_mut().for_each(|wall| wall.motion = Motion::still());
    sleepy.sleep = Some(Sleep { speed: 1.0, time: 5e-5, wake: 5.0 });
    let mut wet = base(hertz);
    let velocity = Vec3::new(0.3, 0.0, 0.0);
    wet.drag = Some(Drag {
        law: DragLaw::SchillerNaumann,
        viscosity: 1e-3,
        density: 1000.0,
        velocity,
        buoyancy: true,
    });
    let mut pressed = base(hertz);
    let lid = Plane { point: Vec3::new(0.0, 0.0, 0.264), normal: -Vec3::z() };
    let servo = Servo::force(-Vec3::z(), 50.0, 0.2);

    pressed.walls.push(Wall { shape: WallShape::Plane(lid), servo: Some(servo), ..plane(Vec3::z()) });
    let mut cut = base(hertz);
    // Just behind a layer of grains.
    let away = Plane { point: Vec3::new(0.0, 0.091, 0.0), normal: Vec3::y() };
    cut.outlets = vec![Zone::new(away, 0.03)];
    let mut all = vec![("sleep", sleepy), ("fluid", wet), ("servo", pressed), ("zone", cut)];
    all.push(("ledger in mixed precision", base(mixed)));
    all.push(("clumps", clumps(hertz)));
    all
}

/// 1300 dumbbells in place of the grains.
fn clumps(variant: &Variant) -> Setup {
    let mut setup = crowd(variant.rough(0.4, 0.4), 13);
    let spheres = [-0.003, 0.003].map(|x| (Vec3::new(x, 0.0, 0.0), 0.006));
    let shape = ClumpShape::new("dumbbell", 0, &spheres, &Moments::of_sum(&spheres));
    let bodies = setup.particles.drain(..).take(1300).map(|p| Body {
        id: 2 * p.id,
        shape: 0,
        scale: 1.0,
        position: p.position,
        orientation: UnitQuaternion::from_euler_angles(p.velocity.x, p.velocity.y, p.velocity.z),
        velocity: p.velocity,
        spin: p.spin,
    });
    let bodies = bodies.collect();
    setup.clumps = Clumps { shapes: vec![shape], placed: bodies, entries: vec![] };
    setup
}

#[test]
fn every_scene_has_the_same_bits() {
    for (name, setup) in scenes() {
        let mut all: Vec<_> =
            [1, 2, 3, 7].map(|threads| bits(setup.clone(), Width::best(), threads, 100)).to_vec();
        all.extend(Width::available().into_iter().map(|w| bits(setup.clone(), w, 1, 100)));
        let [.., crossed, asleep] = all[0][..] else { return };
        assert!(name != "sleep" || f64::from_bits(asleep) > 0.0, "no particle sleeps");
        assert!(name != "zone" || f64::from_bits(crossed) > 0.0, "no particle crosses");
        SCENES.within(name, differing(&all), "numbers differ", 0.0);
    }
}
