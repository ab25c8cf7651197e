//! A device gives the bits of a processor, and refuses what it does not compute.

use super::*;
use crate::effects::{ContactLaw, Material};
use crate::setup::*;
use crate::{Halt, Setup, Simulation};
use geom::{Plane, Vec3};

/// Which effects grains have.
#[derive(Debug, Clone, Copy)]
struct Effects {
    law: &'static str,
    friction: Option<f64>,
    rolling: Option<f64>,
}

fn law(between: (u16, u16), e: Effects) -> ContactLaw {
    let mut law = ContactLaw::new(between, e.law).with("restitution", 0.4);
    law.set("stiffness", (e.law == "hooke").then_some(2e4));
    law.set("sliding_friction", e.friction);
    law.set("rolling_resistance", e.rolling);
    law
}

fn every_composition() -> Vec<Effects> {
    let resists = [(None, None), (Some(0.4), None), (Some(0.4), Some(0.1))];
    ["hooke", "hertz"]
        .into_iter()
        .flat_map(|law| resists.map(|(friction, rolling)| Effects { law, friction, rolling }))
        .collect()
}

/// Grains of two materials and three sizes that fall on a bumpy floor of wall spheres between two planes; periodic along y.
fn trough(effects: Effects) -> Setup {
    let material =
        |name: &str, density| Material { name: name.to_owned(), density, young: 5e6, poisson: 0.3 };
    let wall = |name: &str, shape| Wall::new(name, 0, shape);
    let plane = |x: f64, normal: f64| {
        WallShape::Plane(Plane::new(Vec3::new(x, 0.0, 0.0), Vec3::new(normal, 0.0, 0.1)).expect("a plane"))
    };
    let bump =
        |k: usize| (Vec3::new(0.005 + 0.01 * (k % 20) as f64, 0.005 + 0.01 * (k / 20) as f64, 0.0), 0.005);
    let grain = |k: u32| Particle {
        id: 1000 - k,
        material: (k % 2) as u16,
        radius: [0.006, 0.008, 0.0095][k as usize % 3],
        position: Vec3::new(
            0.012 + 0.02 * (k % 8) as f64,
            0.01 + 0.02 * (k / 8 % 10) as f64,
            0.016 + 0.021 * (k / 80) as f64,
        ),
        velocity: Vec3::new(0.3 * (k % 8) as f64 - 1.0, 0.05 * (k % 5) as f64 - 0.1, -1.0),
        spin: Vec3::zeros(),
    };
    // The second material has no friction: kinds of contact differ in their compositions.
    let smooth = Effects { friction: None, rolling: None, ..effects };
    Setup {
        materials: vec![material("a", 2500.0), material("b", 1500.0)],
        contacts: vec![law((0, 0), effects), law((0, 1), smooth), law((1, 1), effects)],
        particles: (0..500).map(grain).collect(),
        walls: vec![
            wall("floor", WallShape::Spheres((0..400).map(bump).collect())),
            wall("left", plane(0.0, 1.0)),
            wall("right", plane(0.166, -1.0)),
        ],
        periodic: [None, Some((0.0, 0.2)), None],
        guards: Guards { overlap: 0.5, ..Guards::default() },
        step: Step::Auto(0.5),
        ..Setup::default()
    }
}

/// The same with walls that move: a floor that shakes and turns, a plane that comes nearer, a plane whose surface runs.
fn shaken(effects: Effects) -> Setup {
    let mut setup = trough(effects);
    let [floor, left, right] = &mut setup.walls[..] else { panic!("three walls") };
    (floor.motion.amplitude, floor.motion.frequency) = (Vec3::new(0.0, 0.001, 0.001), 40.0);
    (floor.motion.turn, floor.motion.through) = (Vec3::new(0.0, 0.0, 0.3), Vec3::new(0.1, 0.1, 0.0));
    (left.motion.velocity, left.motion.ramp) = (Vec3::new(0.05, 0.0, 0.0), 0.01);
    (floor.surface.velocity, right.surface.velocity) = (Vec3::new(0.3, 0.0, 0.0), Vec3::new(0.0, 0.5, 0.0));
    setup
}

/// Every bit of every particle.
fn bits(sim: &mut Simulation) -> Vec<u64> {
    let of = |p: &Particle| [p.position, p.velocity, p.spin].map(|v| [v.x, v.y, v.z]).concat();
    let all = sim.particles().expect("within the guards");
    all.iter().flat_map(of).map(f64::to_bits).collect()
}

fn here(setup: Setup, steps: u64) -> Simulation {
    let mut sim = Simulation::new(setup).expect("sound");
    (0..steps).for_each(|_| sim.step().expect("within the guards"));
    sim
}

fn there(setup: Setup, device: impl Device + 'static) -> Simulation {
    let mut sim = Simulation::new(setup).expect("sound");
    sim.use_device(Box::new(device)).expect("nothing that it does not compute");
    sim
}

fn advance(sim: &mut Simulation, last: u64) -> Result<(), Halt> {
    while sim.steps() < last {
        sim.advance(last)?;
    }
    Ok(())
}

#[test]
fn the_same_bits_with_every_composition() {
    for effects in every_composition() {
        for (sampling, make) in [
            (Sampling::Averaged, trough as fn(Effects) -> Setup),
            (Sampling::Sampled, trough),
            (Sampling::Averaged, shaken),
        ] {
            let setup = || Setup { sampling, ..make(effects) };
            let mut device = there(setup(), Local::default());
            advance(&mut device, 1200).expect("within the guards");
            let (mut host, mut met) = (Simulation::new(setup()).expect("sound"), [false; 3]);
            for step in 0..1200 {
                host.step().expect("within the guards");
                if step % 20 == 0 {
                    let forces = host.wall_forces().expect("recorded");
                    forces.iter().zip(&mut met).for_each(|(w, met)| *met |= w.force.norm() > 0.0);
                }
            }
            assert_eq!(met, [true; 3], "{effects:?}: every wall is met");
            assert!(bits(&mut device) == bits(&mut host), "{effects:?}, {sampling:?}");
            assert!(device.rebuilds() == host.rebuilds() && host.rebuilds() > 5, "{}", host.rebuilds());
        }
    }
}

/// Observing makes a step here; a checkpoint goes on here as well as there.
#[test]
fn the_same_bits_where_it_is_watched_and_resumed() {
    let effects = every_composition()[5];
    let mut device = there(trough(effects), Local::default());
    for last in [1, 7, 150, 151, 400] {
        advance(&mut device, last).expect("within the guards");
        bits(&mut device);
    }
    let saved = device.checkpoint().to_static();
    let mut resumed = Simulation::resume(trough(effects), saved).expect("of this setup");
    resumed.use_device(Box::new(Local::default())).expect("as before");
    advance(&mut resumed, 900).expect("within the guards");
    assert!(bits(&mut resumed) == bits(&mut here(trough(effects), 900)));
}

/// Of two grains, of a plane, of a pair across a periodic face, and of wall spheres that move.
#[test]
fn a_guard_stops_it_in_the_same_step_for_the_same_reason() {
    type Drives = (fn(Effects) -> Setup, fn(u32) -> Vec3, &'static str);
    let cases: [Drives; 4] = [
        (trough, |k| Vec3::new(if k % 2 == 0 { 2.0 } else { -2.0 }, 0.0, 0.0), "particle "),
        (shaken, |k| if k % 8 == 7 { Vec3::x() * 3.0 } else { Vec3::zeros() }, "wall 'right'"),
        (trough, |k| Vec3::y() * if k / 8 % 10 < 5 { -2.0 } else { 2.0 }, "particle "),
        (shaken, |_| Vec3::z() * -2.0, "wall 'floor'"),
    ];
    for (make, velocity, partner) in cases {
        let mut setup = make(every_composition()[1]);
        setup.guards.overlap = 0.03;
        (0..).zip(&mut setup.particles).for_each(|(k, p)| p.velocity = velocity(k));
        let mut sim = Simulation::new(setup.clone()).expect("sound");
        let halt = (0..1200).find_map(|_| sim.step().err()).expect("too deep").to_string();
        assert!(halt.contains(&format!("overlaps {partner}")), "{halt}");
        let mut device = there(setup, Local::default());
        assert_eq!(advance(&mut device, 1200).expect_err("too deep").to_string(), halt);
        assert_eq!(device.steps(), sim.steps());
    }
}

#[test]
fn what_it_does_not_compute_is_named() {
    let mut setup = trough(every_composition()[5]);
    setup.ledger = true;
    setup.sleep = None;
    let corners = vec![Vec3::zeros(), Vec3::x(), Vec3::y()];
    let mesh = geom::mesh::TriMesh::new(corners, vec![[0, 1, 2]]).expect("sound");
    setup.walls[0].shape = WallShape::Mesh(mesh);
    setup.contacts[1].set("twisting_resistance", 0.1);
    setup.contacts[1].set("sliding_friction", 0.1);
    let mut sim = Simulation::new(setup).expect("sound");
    let refused = sim.use_device(Box::new(Local::default())).expect_err("it does not compute that");
    let expected = [
        "the energy ledger",
        "the triangles of wall 'floor'",
        "the contact law of a and b (hertz + sliding_friction + twisting_resistance)",
    ];
    assert!(expected.iter().all(|e| refused.iter().any(|r| r == e)), "{refused:?}");
}

/// A device that fails at one of its calls.
struct Failing(Local, usize);

impl Failing {
    fn call(&mut self) -> Result<&mut Local, DeviceError> {
        self.1 = self.1.checked_sub(1).ok_or_else(|| DeviceError::Failed {
            device: "GPU".to_owned(),
            what: "fell off the bus".to_owned(),
        })?;
        Ok(&mut self.0)
    }
}

impl Device for Failing {
    fn name(&self) -> String {
        "GPU".to_owned()
    }
    fn allocate(&mut self, bytes: usize) -> Result<Address, DeviceError> {
        self.call()?.allocate(bytes)
    }
    fn release(&mut self, at: Address) -> Result<(), DeviceError> {
        self.call()?.release(at)
    }
    fn write(&mut self, to: Address, bytes: &[u8]) -> Result<(), DeviceError> {
        self.call()?.write(to, bytes)
    }
    fn read(&mut self, from: Address, bytes: &mut [u8]) -> Result<(), DeviceError> {
        self.call()?.read(from, bytes)
    }
    fn launch(
        &mut self,
        function: usize,
        threads: usize,
        tables: &DeviceTables,
        step: u32,
    ) -> Result<(), DeviceError> {
        self.call()?.launch(function, threads, tables, step)
    }
}

#[test]
fn a_device_that_fails_stops_the_run() {
    for calls in [0, 1, 20, 60, 500, 501, 502, 503, 504, 505, 506, 507] {
        let setup = || trough(every_composition()[2]);
        let mut sim = there(setup(), Failing(Local::default(), calls));
        let halt = advance(&mut sim, 1200).expect_err("it failed");
        assert!(halt.to_string().ends_with("GPU: fell off the bus"), "{halt}");
        // Nothing of the steps that were under way is left.
        let steps = sim.steps();
        assert!(bits(&mut sim) == bits(&mut here(setup(), steps)), "after {calls} calls");
    }
}
