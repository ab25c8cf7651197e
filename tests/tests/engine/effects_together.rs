//! All compositions of effects: the energy ledger closes, every width of lanes gives the same bits, an absent effect takes no bytes.

use dem::setup::*;
use dem::simd::Width;
use dem::{Setup, Simulation};
use geom::Vec3;
use grainpipe_tests::normals::{NORMALS, Normal};
use grainpipe_tests::setups::{Law, contact, grain, particles, plane, rolling, run_until, weaken};

/// What rubs: a name, the change it makes, and the bytes of memory that it takes.
type Rubbing = (&'static str, fn(&mut ContactLaw), &'static [usize]);

const RUBBING: [Rubbing; 8] = [
    ("nothing", |_| (), &[]),
    ("sliding", |c| c.set("sliding_friction", 0.3), &[24]),
    ("weakening", weakening, &[24]),
    ("rolling", |c| rub(c, &["rolling_resistance"]), &[24, 24]),
    ("constant rolling", constant, &[24, 24]),
    ("twisting", |c| rub(c, &["twisting_resistance"]), &[24, 8]),
    ("rolling and twisting", |c| rub(c, &["rolling_resistance", "twisting_resistance"]), &[24, 24, 8]),
    (
        "weakening, constant rolling and twisting",
        |c| {
            constant(c);
            weakening(c);
            c.set("twisting_resistance", 0.05);
        },
        &[24, 24, 8],
    ),
];

/// Sliding friction, and resistances to turning.
fn rub(c: &mut ContactLaw, resistances: &[&'static str]) {
    c.set("sliding_friction", 0.3);
    resistances.iter().for_each(|key| c.set(key, 0.05));
}

fn weakening(c: &mut ContactLaw) {
    weaken(c, [0.5, 0.2, 0.1]);
}

fn constant(c: &mut ContactLaw) {
    rub(c, &[]);
    rolling(c, 0.05, "constant");
}

/// Grains dropped onto a shaking floor, their sizes unequal.
fn drop(normal: Normal, rubbing: &Rubbing, count: u32) -> Setup {
    let mut setup = normal.setup(0.5);
    setup.contacts.iter_mut().for_each(rubbing.1);
    setup.gravity.z = -9.81;
    setup.ledger = true;
    setup.walls = vec![plane(Vec3::z())];
    setup.walls[0].motion.amplitude = Vec3::new(0.001, 0.0, 0.002);
    setup.walls[0].motion.frequency = 20.0;
    let offset = |k: u32| 0.001 * ((k * 7919) % 13) as f64;
    setup.particles = (0..count)
        .map(|k| {
            let place = Vec3::new(
                0.034 * (k % 3) as f64 + offset(k),
                0.034 * (k / 3 % 2) as f64 + offset(k + 5),
                0.013 + 0.024 * (k / 6) as f64,
            );
            Particle {
                radius: [0.01, 0.008, 0.009][k as usize % 3],
                spin: Vec3::new(0.0, 5.0, 30.0),
                ..grain(k, place)
            }
        })
        .collect();
    setup
}

/// Kinetic + potential + elastic + dissipated − work of walls stays the same, with every composition there is.
#[test]
fn energy_budget_closes() {
    for normal in NORMALS {
        for rubbing in &RUBBING {
            let mut setup = drop(normal, rubbing, 18);
            setup.step = Step::Auto(0.1);
            let mut sim = Simulation::new(setup).expect("sound");
            run_until(&mut sim, 0.15);
            let e = sim.energy().expect("sound");
            let exchanged = e.normal + e.sliding + e.rolling + e.twisting + e.walls.abs();
            let case = format!("{} with {}", normal.name, rubbing.0);
            assert!(e.normal > 0.0, "{case}: {e:?}");
            assert_eq!(e.sliding > 0.0, rubbing.0 != "nothing", "{case}: {e:?}");
            assert_eq!(e.rolling > 0.0, rubbing.2.len() > 1 && rubbing.0 != "twisting", "{case}: {e:?}");
            assert_eq!(e.twisting > 0.0, rubbing.2.last() == Some(&8), "{case}: {e:?}");
            let missing = e.integration.abs() / exchanged;
            println!("{case}: {missing:e}");
            assert!(missing < 5e-3, "{case}: {missing:e} of the exchanged energy is missing");
        }
    }
}

/// Every bit of every particle, with every composition there is.
#[test]
fn every_width_of_lanes() {
    for normal in NORMALS {
        for rubbing in &RUBBING {
            for ledger in [false, true] {
                let bits = |width| {
                    let mut setup = drop(normal, rubbing, 18);
                    setup.ledger = ledger;
                    setup.step = Step::Auto(0.4);
                    let mut sim = Simulation::with_width(setup, width).expect("sound");
                    run_until(&mut sim, 0.04);
                    let of =
                        |p: &Particle| [p.position, p.velocity, p.spin].map(|v| [v.x, v.y, v.z]).concat();
                    particles(&mut sim).iter().flat_map(of).map(f64::to_bits).collect::<Vec<_>>()
                };
                let scalar = bits(Width::Scalar);
                for width in Width::available() {
                    assert!(bits(width) == scalar, "{} with {}: {width:?}", normal.name, rubbing.0);
                }
            }
        }
    }
}

/// Friction that is 0 at rest and far above its speed is 0 at every speed, whatever this is.
#[test]
fn friction_that_is_nothing_at_every_speed_is_left_out() {
    let mut law = contact((0, 0), Law::Hertz, 0.5);
    weaken(&mut law, [0.0, 0.0, 1.0]);
    let (less, dropped) = dem::effects::needed(&law);
    assert_eq!(less, contact((0, 0), Law::Hertz, 0.5));
    let wanted = "sliding_friction.static = 0, sliding_friction.dynamic = 0, sliding_friction.speed = 1 m/s";
    assert_eq!(dropped.iter().map(|d| d.numbers.as_str()).collect::<Vec<_>>(), [wanted]);
    weaken(&mut law, [0.0, 0.2, 1.0]);
    assert_eq!(dem::effects::needed(&law), (law, vec![]));
}

/// Memory is what the effects of a scene ask for, and nothing else: JKR remembers that it was made, sliding and rolling their
/// springs, twisting its angle.
#[test]
fn absent_effects_take_no_bytes() {
    for normal in NORMALS {
        for rubbing in &RUBBING {
            let sim = Simulation::new(drop(normal, rubbing, 6)).expect("sound");
            let bytes: Vec<usize> = sim
                .explain()
                .iter()
                .filter(|e| e.between.1 == "grain")
                .map(|e| e.bytes_per_contact)
                .collect();
            let own: &[usize] = match (normal.law, normal.cohesion) {
                (Law::Jkr { .. }, _) => &[8],
                (_, Some(_)) => &[0, 0],
                _ => &[0],
            };
            assert_eq!(bytes, [own, rubbing.2].concat(), "{} with {}", normal.name, rubbing.0);
            assert_eq!(sim.rotates(), rubbing.0 != "nothing");
        }
    }
}

/// Where rolling and twisting are resisted, a pile comes to rest and stays: no effect makes energy.
#[test]
fn piles_come_to_rest() {
    for normal in NORMALS {
        for rubbing in RUBBING.iter().filter(|r| r.2.len() == 3) {
            let mut setup = drop(normal, rubbing, 12);
            setup.walls[0].motion = Motion::still();
            setup.step = Step::Auto(0.95);
            setup.contacts.iter_mut().for_each(|c| c.set("restitution", 0.2));
            let mut sim = Simulation::new(setup).expect("sound");
            let mut kinetic = |time: f64| {
                run_until(&mut sim, time);
                let e = sim.energy().expect("sound");
                e.translation + e.rotation
            };
            let (early, late) = (kinetic(0.05), kinetic(2.5));
            assert!(late < 1e-5 * early, "{} with {}: {early:e} J, then {late:e} J", normal.name, rubbing.0);
        }
    }
}
