//! A device gives the bits of a processor, and refuses what it does not compute.

mod damaged;
mod entering;
mod every_law;
mod meshes;

use super::*;
use crate::model::With;
use crate::neighbours::rebuild::restore_lists;
use crate::setup::*;
use crate::{Halt, Setup, Simulation};
use geom::{Plane, Vec3};
use laws::effects::{ContactLaw, Material};

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
        sim.advance(last, &mut |_| true)?;
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

/// In a fluid of either law, with local damping, and with both.
#[test]
fn the_same_bits_where_something_slows_them() {
    let fluid =
        |law| Drag { law, viscosity: 0.05, density: 900.0, velocity: Vec3::y() * 0.2, buoyancy: true };
    let cases = [
        (Some(fluid(DragLaw::Stokes)), None),
        (Some(fluid(DragLaw::SchillerNaumann)), Some(0.3)),
        (None, Some(0.7)),
    ];
    for (n, (drag, local_damping)) in cases.into_iter().enumerate() {
        for effects in [every_composition()[0], every_composition()[5]] {
            let setup = || Setup { drag, local_damping, ..shaken(effects) };
            let mut device = there(setup(), Local::default());
            advance(&mut device, 600).expect("within the guards");
            assert!(bits(&mut device) == bits(&mut here(setup(), 600)), "{n} {effects:?}");
            assert!(bits(&mut device) != bits(&mut here(shaken(effects), 600)), "{n}: it does nothing");
        }
    }
}

/// Grains of two sizes, 1 : 6, in a small box that is periodic along all axes: some have two images of one partner. A small floe of wall spheres drifts
/// through it for several periods, over a floor at rest whose spheres reach beyond the box.
fn cube(effects: Effects) -> Setup {
    let mut setup = trough(effects);
    let floe =
        (0..9).map(|k| (Vec3::new(0.012 * (k % 3) as f64, 0.012 * (k / 3) as f64, 0.05), 0.006)).collect();
    let floor =
        (0..49).map(|k| (Vec3::new(0.01 * (k % 7) as f64, 0.01 * (k / 7) as f64, 0.0), 0.007)).collect();
    setup.walls = vec![
        Wall::new("floe", 0, WallShape::Spheres(floe)),
        Wall::new("floor", 0, WallShape::Spheres(floor)),
    ];
    setup.walls[0].motion.velocity = Vec3::new(-6.0, -4.0, 0.5);
    setup.contacts.iter_mut().for_each(|law| law.set("stiffness", 3000.0));
    setup.periodic = [Some((0.0, 0.06)), Some((0.0, 0.06)), Some((-0.01, 0.09))];
    let small = |k: u32| Particle {
        id: k,
        material: (k % 2) as u16,
        radius: 0.002,
        position: Vec3::new(
            0.0021 + 0.0042 * (k % 14) as f64,
            0.0021 + 0.0042 * (k / 14 % 14) as f64,
            0.0095 + 0.0042 * (k / 196) as f64,
        ),
        velocity: Vec3::new(
            0.5 * (k % 7) as f64 - 1.5,
            0.4 * (k % 5) as f64 - 0.8,
            0.3 * (k % 3) as f64 - 0.3,
        ),
        spin: Vec3::zeros(),
    };
    let large = Particle {
        id: 5000,
        material: 0,
        radius: 0.0115,
        position: Vec3::new(0.057, 0.03, 0.07),
        velocity: Vec3::new(0.1, 0.2, -0.3),
        spin: Vec3::zeros(),
    };
    let apart = |p: &Particle| {
        let by = (p.position - large.position).map(|x| x.abs());
        let nearest = Vec3::new(by.x.min(0.06 - by.x), by.y.min(0.06 - by.y), by.z.min(0.1 - by.z));
        let floes = (p.position.z - 0.05).abs() > 0.0085;
        nearest.norm() > 0.014 && floes
    };
    setup.particles = (0..17 * 196).map(small).filter(apart).chain([large]).collect();
    setup
}

/// The cube without the large grain, parted by a plane that a periodic axis crosses: both it and its image are met.
fn parted(effects: Effects) -> Setup {
    let mut setup = cube(effects);
    setup.particles.retain(|p| p.radius < 0.01);
    let plane = Plane::new(Vec3::zeros(), Vec3::x()).expect("a plane");
    setup.walls.push(Wall::new("partition", 0, WallShape::Plane(plane)));
    setup
}

/// The trough, and one grain so high above it that most cells are empty.
fn high(effects: Effects) -> Setup {
    let mut setup = trough(effects);
    let grain = Particle { id: 5000, position: Vec3::new(0.08, 0.1, 60.0), ..setup.particles[0] };
    setup.particles.push(grain);
    setup
}

/// The lists of a device are those of this processor, slot by slot, and so are the histories.
#[test]
fn the_same_lists() {
    for (make, speed) in [
        (trough as fn(Effects) -> Setup, 1.0),
        (shaken, 1.0),
        (high, 1.0),
        (cube, 1.0),
        (parted, 0.4),
        (cube, 0.2),
    ] {
        let slower = |mut setup: Setup| {
            setup.particles.iter_mut().for_each(|p| p.velocity *= speed);
            setup
        };
        let mut sim = there(slower(make(every_composition()[2])), Local::default());
        let (mut compared, mut images, mut walls, mut carried) = (0, 0, 0, 0);
        for last in [30, 90, 91, 200, 377, 600, 1100, 1400] {
            advance(&mut sim, last).expect("within the guards");
            let [starts, entries] = sim.device.as_mut().expect("a device").contacts_of();
            let Simulation { model, state, lists, .. } = &mut sim;
            let (fetched, history) = (std::mem::take(&mut lists.slots), state.contacts.history.to_vec());
            restore_lists(model, state, lists);
            state.contacts.history.copy_from_slice(&history);
            lists.slots.index();
            let slots = &lists.slots;
            assert_eq!((&fetched.i, &fetched.partner), (&slots.i, &slots.partner), "step {last}");
            assert_eq!((&fetched.image, &fetched.arriving), (&slots.image, &slots.arriving), "step {last}");
            assert_eq!((&starts, fetched.tiles), (&slots.starts, slots.tiles.clone()), "step {last}");
            assert_eq!(
                entries,
                slots.entries.iter().map(|end| end.order()).collect::<Vec<_>>(),
                "step {last}"
            );
            compared += slots.len();
            let of = |with: fn(With) -> bool| -> usize {
                slots.segments.iter().filter(|s| with(s.with)).map(|s| s.len).sum()
            };
            images += of(|with| with == With::Images);
            walls += of(With::is_wall);
            carried += sim.state.contacts.history.iter().filter(|x| **x != 0.0).count();
        }
        let periods = |w: &[i32; 3]| w.iter().any(|n| *n != 0);
        assert_eq!(
            sim.lists.wall_periods.iter().any(periods),
            sim.model.setup.periodic.iter().all(Option::is_some)
        );
        let mut host = here(slower(make(every_composition()[2])), 1400);
        assert!(bits(&mut sim) == bits(&mut host));
        assert!(sim.state.contacts.history[..] == host.state.contacts.history[..]);
        assert!(sim.rebuilds() == host.rebuilds() && host.rebuilds() > 6, "{}", host.rebuilds());
        assert!(
            compared > 1000 && images > 50 && walls > 50 && carried > 100,
            "{compared} {images} {walls} {carried}"
        );
    }
}

/// One grain of the trough rolls down its left plane, through the faces of the box.
fn rolling(periodic: bool) -> Setup {
    let mut setup = trough(every_composition()[2]);
    setup.walls.truncate(2);
    setup.walls.remove(0);
    setup.gravity = Vec3::new(-9.81, 2.0, 0.0);
    setup.periodic[1] = setup.periodic[1].filter(|_| periodic);
    setup.particles.truncate(1);
    let normal = Vec3::new(1.0, 0.0, 0.1).normalize();
    setup.particles[0].position = normal * 0.005_995 + Vec3::y() * 0.198;
    setup.particles[0].velocity = Vec3::y();
    setup
}

/// A contact with a plane keeps its springs through a periodic face, along which the plane has no images.
#[test]
fn the_same_springs_through_a_periodic_face() {
    let open = bits(&mut here(rolling(false), 1000));
    let mut sim = there(rolling(true), Local::default());
    advance(&mut sim, 1000).expect("within the guards");
    let across = bits(&mut sim);
    assert!(across == bits(&mut here(rolling(true), 1000)));
    let number = |bits: &[u64], k: usize| f64::from_bits(bits[k]);
    assert!(number(&across, 1) < 0.19 && number(&open, 1) > 0.2, "it went through the face");
    for k in 3..9 {
        let (a, b) = (number(&open, k), number(&across, k));
        assert!((a - b).abs() < 1e-9 * (1.0 + a.abs()), "column {k}: {a} without a face, {b} through it");
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
    setup.sleep = Some(Sleep { speed: 1e-3, time: 0.1, wake: 1.0 });
    let mut sim = Simulation::new(setup).expect("sound");
    let refused = sim.use_device(Box::new(Local::default())).expect_err("it does not compute that");
    assert_eq!(refused, ["sleep", "the energy ledger"]);
    // What is asked of walls has the key that asks for it.
    for (detail, key) in [(WallDetail::Whole, "output.wall_forces"), (WallDetail::Parts, "output.wear")] {
        let setup = Setup { wall_sums: detail, ..trough(every_composition()[5]) };
        let mut sim = Simulation::new(setup).expect("sound");
        let refused = sim.use_device(Box::new(Local::default())).expect_err("it does not compute that");
        assert!(refused.len() == 1 && refused[0].contains(key), "{refused:?}");
    }
}

/// A device that fails at one of its calls.
struct Failing(Local, usize);

impl Failing {
    fn call(&mut self) -> Result<&mut Local, DeviceError> {
        let left = self.1.checked_sub(1);
        // Afterwards it works again.
        self.1 = left.unwrap_or(usize::MAX);
        let failed = || DeviceError::Failed { device: "GPU".to_owned(), what: "fell off the bus".to_owned() };
        left.map(|_| &mut self.0).ok_or_else(failed)
    }
}

impl Device for Failing {
    fn name(&self) -> String {
        "GPU".to_owned()
    }
    fn allocate(&mut self, bytes: usize) -> Result<Address, DeviceError> {
        self.call()?.allocate(bytes)
    }
    fn clear(&mut self, at: Address, bytes: usize) -> Result<(), DeviceError> {
        self.call()?.clear(at, bytes)
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
    for calls in [0, 1, 20, 60, 150, 400, 1000, 2000, 3000, 3100, 3200, 3300, 3400] {
        let setup = || trough(every_composition()[2]);
        let mut sim = there(setup(), Failing(Local::default(), calls));
        let halt = advance(&mut sim, 1200).expect_err("it failed");
        assert!(halt.to_string().ends_with("GPU: fell off the bus"), "{halt}");
        // Nothing of the steps that were under way is left, and where it works again, it goes on from there.
        let steps = sim.steps();
        assert!(steps < 1200);
        if calls % 20 == 0 {
            assert!(bits(&mut sim) == bits(&mut here(setup(), steps)), "after {calls} calls");
        }
        advance(&mut sim, 1200).expect("it works again");
        assert!(bits(&mut sim) == bits(&mut here(setup(), 1200)), "after {calls} calls");
    }
}

/// At any moment of the first lists that it makes itself.
#[test]
fn nothing_of_lists_that_were_not_finished_is_left() {
    let setup = || trough(every_composition()[0]);
    let expected = bits(&mut here(setup(), 300));
    for calls in (40..720).step_by(17) {
        let mut sim = there(setup(), Failing(Local::default(), calls));
        if advance(&mut sim, 300).is_err() {
            advance(&mut sim, 300).expect("it works again");
        }
        assert!(bits(&mut sim) == expected, "after {calls} calls");
    }
}

/// Lists that hold for a few steps only do not keep it from being stopped.
#[test]
fn it_stops_when_it_is_asked() {
    let setup = || Setup { skin: Some(2e-4), ..trough(every_composition()[2]) };
    let mut sim = there(setup(), Local::default());
    advance(&mut sim, 10).expect("within the guards");
    let (before, mut asked) = (sim.rebuilds(), Vec::new());
    let mut goes_on = |step| {
        asked.push(step);
        asked.len() < 20
    };
    sim.advance(100_000, &mut goes_on).expect("within the guards");
    assert_eq!((asked.len(), asked.last()), (20, Some(&sim.steps())));
    assert!(sim.rebuilds() - before > 10 && sim.steps() < 600, "{} {}", sim.rebuilds() - before, sim.steps());
    let steps = sim.steps();
    assert!(bits(&mut sim) == bits(&mut here(setup(), steps)));
}

/// So many grains of one size on a lattice, just so far apart that they are still listed with their neighbours, or not, as numbers are rounded: what lists
/// hold must be rounded in the same way. One of them flies.
fn lattice(effects: Effects) -> Setup {
    let (radius, skin) = (0.0125, 0.0025);
    let mut setup = trough(effects);
    let pitch = 2.0 * radius + skin;
    setup.particles = (0..26 * 26 * 26)
        .map(|k| Particle {
            id: k,
            material: 0,
            radius,
            position: Vec3::from([k % 26, k / 26 % 26, k / 676].map(|n| 0.0125 + pitch * f64::from(n))),
            velocity: if k == 1000 { Vec3::new(0.5, 0.3, 0.2) } else { Vec3::zeros() },
            spin: Vec3::zeros(),
        })
        .collect();
    (setup.walls, setup.periodic, setup.skin) = (Vec::new(), [None; 3], Some(skin));
    setup.gravity = Vec3::zeros();
    setup
}

#[test]
fn the_same_lists_of_a_lattice_and_of_few_grains() {
    let few = |count: usize| {
        let mut setup = trough(every_composition()[2]);
        setup.particles.truncate(count);
        setup.step = Step::Fixed(1e-5);
        setup
    };
    for (setup, last) in [(lattice(every_composition()[2]), 200), (few(1), 200), (few(2), 200), (few(0), 200)]
    {
        let mut sim = there(setup.clone(), Local::default());
        advance(&mut sim, last).expect("within the guards");
        let mut host = here(setup, last);
        assert_eq!(sim.rebuilds(), host.rebuilds());
        assert_eq!(
            (&sim.lists.slots.i, &sim.lists.slots.partner),
            (&host.lists.slots.i, &host.lists.slots.partner)
        );
        assert!(bits(&mut sim) == bits(&mut host));
    }
}
