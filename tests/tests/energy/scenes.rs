//! Small scenes, one for each way in which energy is exchanged.

use dem::Setup;
use dem::setup::*;
use geom::mesh::TriMesh;
use geom::{Plane, Vec3};
use grainpipe_tests::normals::{NORMALS, Normal};
use grainpipe_tests::setups::{bond, clump, dumbbell, grain, lattice, plane, with_friction};

/// A scene and its name.
pub struct Scene {
    /// Name.
    pub name: String,
    /// What is simulated.
    pub setup: Setup,
    /// Particles that come in at a calculation plane.
    pub entries: Vec<Entry>,
    /// How long [s].
    pub until: f64,
}

/// Grains above the floor, none touching another.
fn cloud(count: u32, lift: f64) -> Vec<Particle> {
    let offset = |k: u32| 0.001 * f64::from((k * 7919) % 13);
    let place = |k: u32| {
        Vec3::new(
            0.034 * f64::from(k % 4) + offset(k),
            0.034 * f64::from(k / 4 % 3) + offset(k + 5),
            lift + 0.034 * f64::from(k / 12),
        )
    };
    (0..count).map(|k| Particle { spin: Vec3::new(3.0, -2.0, 5.0), ..grain(k, place(k)) }).collect()
}

/// Grains of one normal law fall on a floor, rub, roll and twist.
pub fn poured(normal: &Normal) -> Setup {
    let mut setup = with_friction(normal.setup(0.5), 0.3);
    setup.contacts.iter_mut().for_each(|c| {
        c.set("rolling_resistance", 0.05);
        c.set("twisting_resistance", 0.05);
    });
    setup.gravity.z = -9.81;
    setup.ledger = true;
    setup.step = Step::Auto(0.5);
    setup.walls = vec![plane(Vec3::z())];
    setup.particles = cloud(24, 0.03);
    setup
}

fn shaking(mut setup: Setup) -> Setup {
    setup.walls[0].motion.amplitude = Vec3::new(0.001, 0.0, 0.002);
    setup.walls[0].motion.frequency = 20.0;
    setup
}

/// Wall spheres, side by side in a floor.
fn pebbles() -> WallShape {
    let place = |k: i32| Vec3::new(0.02 * f64::from(k % 12) - 0.05, 0.02 * f64::from(k / 12) - 0.05, -0.012);
    WallShape::Spheres((0..144).map(|k| (place(k), 0.012)).collect())
}

fn scene(name: &str, setup: Setup) -> Scene {
    Scene { name: name.to_owned(), setup, entries: vec![], until: 0.2 }
}

/// Every scene at dt = auto, of the safety that is the default.
pub fn all() -> Vec<Scene> {
    let hertz = || poured(&NORMALS[1]);
    let mut scenes: Vec<Scene> = NORMALS.iter().flat_map(on_floors).collect();
    scenes.extend(periodic(hertz()));
    scenes.push(scene("hertz, pushed by a plane", pushed(hertz())));
    scenes.push(scene("hertz, constant rolling couple", constant_rolling(hertz())));
    scenes.extend(NORMALS.iter().map(weakening));
    scenes.extend(NORMALS[..2].iter().flat_map(mixed_precision));
    scenes.extend(NORMALS.iter().flat_map(bonds));
    scenes.extend(NORMALS[..2].iter().flat_map(kinds_of_bonds));
    scenes.push(scene("hertz, bonds across a periodic face", across_a_face(hertz())));
    scenes.push(scene("hertz, no friction", Setup { contacts: NORMALS[1].setup(0.5).contacts, ..hertz() }));
    scenes.extend(crate::strained::all());
    scenes.extend(asleep(hertz()));
    scenes.push(scene("hertz, sinking in a fluid", in_fluid(hertz())));
    scenes.push(scene("hertz, pressed by a servo", pressed(hertz())));
    scenes.push(scene("hertz on a shaking mesh", shaking(on(WallShape::Mesh(waves()), hertz()))));
    scenes.extend(clumps("dumbbells", &dumbbell()));
    scenes.extend(clumps("boomerangs", &boomerang()));
    scenes.extend([passing(), arriving(), leaving()]);
    scenes
}

/// On a floor of this shape.
fn on(floor: WallShape, mut setup: Setup) -> Setup {
    setup.walls[0].shape = floor;
    setup
}

fn on_floors(normal: &Normal) -> [Scene; 3] {
    let (name, setup) = (normal.name, poured(normal));
    [
        scene(&format!("{name} on a still floor"), setup.clone()),
        scene(&format!("{name} on a shaking floor"), shaking(setup.clone())),
        scene(&format!("{name} on a shaking wall of spheres"), shaking(on(pebbles(), setup))),
    ]
}

fn periodic(mut setup: Setup) -> [Scene; 2] {
    setup.periodic = [Some((-0.01, 0.14)), Some((-0.01, 0.11)), None];
    setup.particles.iter_mut().for_each(|p| p.velocity = Vec3::new(0.8, -0.6, 0.0));
    let level = scene("hertz, periodic", setup.clone());
    setup.gravity.x = 4.0;
    [level, scene("hertz, periodic, down a slope", setup)]
}

/// A plane comes from the side.
fn pushed(mut setup: Setup) -> Setup {
    let beside = Plane { point: Vec3::new(-0.02, 0.0, 0.0), normal: Vec3::x() };
    setup.walls.push(Wall { shape: WallShape::Plane(beside), ..plane(Vec3::x()) });
    setup.walls[1].motion.velocity = Vec3::new(0.2, 0.0, 0.0);
    setup
}

fn constant_rolling(mut setup: Setup) -> Setup {
    setup.contacts.iter_mut().for_each(|c| c.choose("rolling_model", "constant"));
    setup
}

fn weakening(normal: &Normal) -> Scene {
    let mut setup = poured(normal);
    setup.contacts.iter_mut().for_each(|c| grainpipe_tests::setups::weaken(c, [0.3, 0.1, 0.1]));
    scene(&format!("{}, friction that weakens", normal.name), setup)
}

fn mixed_precision(normal: &Normal) -> [Scene; 2] {
    let name = normal.name;
    let mut setup = shaking(poured(normal));
    setup.precision = Precision::Mixed;
    setup.contacts.iter_mut().for_each(|c| c.remove("twisting_resistance"));
    let plane = scene(&format!("{name} on a shaking floor, mixed precision"), setup.clone());
    setup.periodic = [Some((-0.01, 0.14)), Some((-0.01, 0.11)), None];
    let spheres = format!("{name} on a shaking wall of spheres, periodic, mixed precision");
    [plane, scene(&spheres, on(pebbles(), setup))]
}

/// Bonds of the other kinds, weak enough to break: cement with friction and a Weibull spread, glue that takes the place of contacts, and beams that do.
fn kinds_of_bonds(normal: &Normal) -> [Scene; 3] {
    let strength = BondStrength::of(2e3, 2e3);
    let spread = Spread::Weibull { modulus: 4.0, reference_radius: None };
    let cement = BondKind::Parallel { springs: BondSprings::Given([5e8, 2e8]), moments: 0.5 };
    let parallel = Bond {
        strength: BondStrength { friction: 0.5, spread, ..strength },
        ..Bond::new((0, 0), 2e-3, cement)
    };
    let glue = BondKind::Contact(BondSprings::Modulus { modulus: 2e6, ratio: 2.5 });
    let contact = Bond { strength, ..Bond::new((0, 0), 2e-3, glue) };
    let beam = Bond { strength, replaces_contact: true, ..bond((0, 0)) };
    [("parallel", parallel), ("contact", contact), ("beam instead of contact", beam)].map(|(kind, law)| {
        let mut setup = bonded(poured(normal), 0.0, f64::INFINITY);
        setup.bonds = vec![Bond { damping: 0.2, ..law }];
        // In contact from the start on.
        let centre = Vec3::new(0.0, 0.0, 0.045);
        setup.particles.iter_mut().for_each(|p| p.position = centre + (p.position - centre) * 0.95);
        scene(&format!("{}, {kind} bonds", normal.name), setup)
    })
}

fn bonds(normal: &Normal) -> [Scene; 2] {
    let name = normal.name;
    [
        scene(&format!("{name}, bonded grains"), bonded(poured(normal), 0.5, f64::INFINITY)),
        scene(&format!("{name}, bonds that break"), bonded(poured(normal), 0.2, 2e3)),
    ]
}

fn across_a_face(setup: Setup) -> Setup {
    let mut setup = bonded(setup, 0.0, 5e3);
    setup.periodic = [Some((-0.05, 0.05)), Some((-0.05, 0.05)), None];
    setup.particles.iter_mut().for_each(|p| p.velocity = Vec3::new(2.0, -1.0, 0.0));
    setup
}

fn asleep(mut setup: Setup) -> [Scene; 2] {
    setup.sleep = Some(Sleep { speed: 0.02, time: 0.01, wake: 0.3 });
    let resting = Setup { particles: cloud(12, 0.011), ..setup.clone() };
    setup.sleep = Some(Sleep { speed: 0.05, time: 0.005, wake: 0.3 });
    [scene("hertz, sleep", resting), scene("hertz, sleep and waking", setup)]
}

fn clumps(name: &str, shape: &ClumpShape) -> [Scene; 2] {
    let level = tumbling(poured(&NORMALS[1]), shape.clone());
    let mut slope = level.clone();
    slope.periodic = [Some((-0.02, 0.14)), Some((-0.02, 0.11)), None];
    slope.gravity.x = 4.0;
    let sloping = scene(&format!("hertz, {name}, periodic, down a slope"), slope);
    [sloping, scene(&format!("hertz, {name}"), level)]
}

/// A bonded block that turns and falls on an edge, with bonds of this damping and strength [Pa].
fn bonded(mut setup: Setup, damping: f64, strength: f64) -> Setup {
    let strong = Bond { strength: BondStrength::of(strength, strength), ..bond((0, 0)) };
    setup.bonds = vec![Bond { damping, ..strong }];
    setup.particles = lattice([2, 2, 3], Vec3::new(0.0, 0.0, 0.045));
    let turn = nalgebra::UnitQuaternion::from_euler_angles(0.4, 0.5, 0.1);
    let centre = Vec3::new(0.0, 0.0, 0.045);
    for p in &mut setup.particles {
        p.position = centre + turn * (p.position - centre);
        p.spin = Vec3::new(0.0, 3.0, 1.0);
        p.velocity = p.spin.cross(&(p.position - centre)) - Vec3::z() * 0.2;
    }
    setup
}

fn in_fluid(mut setup: Setup) -> Setup {
    let (law, velocity) = (DragLaw::SchillerNaumann, Vec3::new(0.3, 0.0, 0.1));
    setup.drag = Some(Drag { law, viscosity: 1e-3, density: 1000.0, velocity, buoyancy: true });
    setup
}

/// A lid that follows a force comes down on the grains.
fn pressed(mut setup: Setup) -> Setup {
    let lid = Plane { point: Vec3::new(0.0, 0.0, 0.075), normal: -Vec3::z() };
    setup.walls.push(Wall { shape: WallShape::Plane(lid), ..plane(-Vec3::z()) });
    setup.walls[1].servo = Some(Servo::force(-Vec3::z(), 5.0, 0.4));
    setup
}

/// A floor of triangles in waves.
fn waves() -> TriMesh {
    let n = 20u32;
    let at = |i: u32, j: u32| {
        let (x, y) = (0.01 * f64::from(i) - 0.05, 0.01 * f64::from(j) - 0.05);
        Vec3::new(x, y, 0.004 * (80.0 * x).sin() * (70.0 * y).cos())
    };
    let vertices = (0..=n).flat_map(|j| (0..=n).map(move |i| at(i, j))).collect();
    let corner = |i: u32, j: u32| j * (n + 1) + i;
    let square = |i, j| {
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let faces = (0..n).flat_map(|j| (0..n).flat_map(move |i| square(i, j))).collect();
    TriMesh::new(vertices, faces).expect("sound")
}

/// Three spheres, no two moments of inertia alike.
pub fn boomerang() -> ClumpShape {
    let at = |x: f64, y: f64, r: f64| (Vec3::new(x, y, 0.0), r);
    clump(&[at(0.0, 0.0, 0.01), at(0.012, 0.0, 0.009), at(0.0, 0.01, 0.007)])
}

/// A clump instead of each grain.
pub fn tumbling(mut setup: Setup, shape: ClumpShape) -> Setup {
    let orientation = nalgebra::UnitQuaternion::from_euler_angles(0.3, -0.8, 0.5);
    let body = |(k, p): (u32, &Particle)| Body {
        id: 10 * k,
        shape: 0,
        scale: 0.8,
        position: p.position,
        orientation,
        velocity: p.velocity,
        spin: p.spin,
    };
    let bodies = (0..).zip(&setup.particles).map(body).collect();
    setup.clumps = Clumps { shapes: vec![shape], placed: bodies, entries: vec![] };
    setup.particles.clear();
    setup
}

/// Grains come in through a calculation plane, slide over the floor among others, and leave through a storage plane.
fn passing() -> Scene {
    let mut setup = poured(&NORMALS[1]);
    let zone =
        |x: f64, length: f64| Zone::new(Plane { point: Vec3::new(x, 0.0, 0.0), normal: Vec3::x() }, length);
    (setup.inlets, setup.outlets) = (vec![zone(0.05, 0.05)], vec![zone(0.2, 0.03)]);
    (setup.smallest_entry, setup.largest_entry, setup.entry_materials) = (0.01, 0.01, vec![0]);
    setup.particles =
        vec![grain(1000, Vec3::new(0.12, 0.001, 0.0101)), grain(1001, Vec3::new(0.13, -0.001, 0.0303))];
    let entry = |k: u32| {
        let position = Vec3::new(0.0, 0.002 * f64::from(k % 3), 0.012 + 0.021 * f64::from(k % 2));
        let velocity = Vec3::new(0.6 + 0.1 * f64::from(k % 2), 0.0, 0.0);
        let particle = Particle { velocity, spin: Vec3::new(0.0, 5.0, 0.0), ..grain(k, position) };
        Entry { time: 0.045 * f64::from(k / 2), inlet: 0, particle, clump: None, turn: None, cluster: 0 }
    };
    Scene {
        name: "hertz, through two planes".to_owned(),
        setup,
        entries: (0..40).map(entry).collect(),
        until: 0.7,
    }
}

/// Clumps come in through a calculation plane and slide over the floor among grains.
fn arriving() -> Scene {
    let Scene { mut setup, entries, .. } = passing();
    setup.outlets.clear();
    setup.clumps = Clumps {
        shapes: vec![boomerang()],
        placed: vec![],
        entries: vec![ClumpScales { shape: 0, least: 0.5, most: 1.0 }],
    };
    let orientation = nalgebra::UnitQuaternion::from_euler_angles(0.3, -0.8, 0.5);
    let clump = |k: u32| EntryClump { shape: 0, scale: 0.5 + 0.1 * f64::from(k % 4), orientation };
    let entry = |(k, e): (u32, Entry)| {
        let position = e.particle.position + Vec3::new(0.0, 0.0, 0.01 + 0.02 * f64::from(k % 2));
        let particle = Particle { id: 10 * k, spin: Vec3::zeros(), position, ..e.particle };
        Entry { particle, clump: Some(clump(k)), ..e }
    };
    let entries = (0..).zip(entries).take(20).map(entry).collect();
    Scene { name: "hertz, clumps through a plane".to_owned(), setup, entries, until: 0.6 }
}

/// The same, rotating on their way in, and out again through a storage plane.
fn leaving() -> Scene {
    let Scene { mut setup, mut entries, .. } = arriving();
    setup.outlets = passing().setup.outlets;
    setup.outlets.iter_mut().for_each(|o| o.length = 0.05);
    entries.iter_mut().for_each(|e| e.particle.spin = Vec3::new(4.0, 9.0, -6.0));
    Scene { name: "hertz, clumps through two planes".to_owned(), setup, entries, until: 0.7 }
}
