//! All spheres of a wall that a grain touches at once act as one contact: dense walls behave as the plane.

use crate::of_walls;
use crate::sphere_walls::plates::{still, touch};
use dem::setup::*;
use dem::simd::Width;
use dem::{Setup, Simulation, mass};
use geom::Vec3;
use grainpipe_tests::findings::Case;
use grainpipe_tests::setups::{
    Law, clump, empty, grain, particles, plane, rolling, run_until, with_friction,
};

const NORMAL: Case =
    of_walls("a grain rebounds from a wall of spheres of any spacing with the restitution asked for");
const OBLIQUE: Case = of_walls("oblique impacts with friction and rolling on dense walls against the plane");
const KEPT: Case =
    of_walls("elastic grains keep their energy on dense and rough walls, in corners and slots");
const YIELDS: Case =
    of_walls("walton_braun: a grain that passes over a dense wall gains no energy, nor does its impact");
const REST: Case = of_walls("a grain comes to rest in a valley of wall spheres");
const CORNER: Case = of_walls("a corner inside one wall of spheres bears a grain as two planes do");
const CLUMP: Case =
    of_walls("clumps rebound from a plane with the restitution asked for, however many spheres touch");
const SPRING: Case = of_walls("a grain and a wall on a spring part with the restitution asked for");

const R: f64 = 0.005;
const SPEED: f64 = 0.5;

/// Hooke as stiff as a modulus [Pa], or Hertz.
fn laws(young: f64) -> [Law; 2] {
    [Law::Hooke { stiffness: young * R, tangential_ratio: None }, Law::Hertz]
}

fn soft(law: Law, e: f64, young: f64) -> Setup {
    let mut setup = empty(law, e);
    setup.materials.iter_mut().for_each(|m| m.young = young);
    setup.step = Step::Auto(0.2);
    setup.guards.overlap = 0.6;
    setup
}

/// Spheres on a square lattice in the plane z = 0 turned about x, their tops in it: spacing P, roughness ζ.
fn lattice(p: f64, roughness: f64, half: f64) -> Vec<(Vec3, f64)> {
    let radius = (0.25 * p * p + roughness * roughness) / (2.0 * roughness);
    let n = (half / p).ceil() as i32;
    let at = |k: i32| p * (f64::from(k) + 0.5);
    let all = (-n..n).flat_map(|i| (-n..n).map(move |j| (i, j)));
    all.map(|(i, j)| (Vec3::new(at(i), at(j), -radius), radius)).collect()
}

fn ball(position: Vec3, velocity: Vec3) -> Particle {
    Particle { radius: R, velocity, ..grain(0, position) }
}

/// Impact on a wall of spheres above a place, at an angle to its normal.
fn impact(mut setup: Setup, spheres: &[(Vec3, f64)], (x, y): (f64, f64), tilt: f64) -> Particle {
    let (z, _) = touch(spheres, R, x, y).expect("on the wall");
    setup.walls = vec![still(spheres)];
    let velocity = Vec3::new(tilt.sin(), 0.0, -tilt.cos()) * SPEED;
    setup.particles = vec![ball(Vec3::new(x, y, z + 1e-6), velocity)];
    after(setup)
}

/// The grain once it has left.
fn after(setup: Setup) -> Particle {
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, 1e-4);
    loop {
        run_until_next(&mut sim, 200);
        let p = particles(&mut sim)[0];
        if p.velocity.z > 0.0 && p.position.z > 2.0 * R {
            return p;
        }
    }
}

fn run_until_next(sim: &mut Simulation, steps: usize) {
    (0..steps).for_each(|_| sim.step().expect("within the guards"));
}

#[test]
fn restitution_is_that_asked_for_at_every_spacing() {
    for young in [1e6, 1e8] {
        for (law, e) in laws(young).into_iter().flat_map(|law| [0.3, 0.5, 0.9].map(|e| (law, e))) {
            let mut worst = 0.0f64;
            for share in [1.0, 0.5, 0.25, 0.1, 0.05] {
                let p = share * 2.0 * R;
                let spheres = lattice(p, 0.002 * p, (3.0 * p).max(0.6 * R));
                for place in [(0.1, 0.2), (0.5, 0.45), (0.02, 0.27)] {
                    let out = impact(soft(law, e, young), &spheres, (place.0 * p, place.1 * p), 0.0);
                    worst = worst.max((out.velocity.norm() / SPEED - e).abs());
                }
            }
            NORMAL.within(&format!("{law:?}, e = {e}, {young:e} Pa, P = d … d/20"), worst, "–", 0.01);
        }
    }
}

#[test]
fn oblique_impacts_as_on_the_plane() {
    for (law, model) in laws(1e7).into_iter().flat_map(|law| [None, Some("spring")].map(|m| (law, m))) {
        let setup = || {
            let mut setup = with_friction(soft(law, 0.5, 1e7), 0.3);
            if let Some(model) = model {
                setup.contacts.iter_mut().for_each(|c| rolling(c, 0.1, model));
            }
            setup
        };
        let p = 0.1 * 2.0 * R;
        let spheres = lattice(p, 0.002 * p, 2.0 * R);
        let (mut normal, mut tangential) = (0.0f64, 0.0f64);
        for tilt in [0.0, 15.0, 30.0, 45.0, 60.0f64].map(f64::to_radians) {
            let out = impact(setup(), &spheres, (0.03 * R, 0.02 * R), tilt).velocity / SPEED;
            let mut flat = setup();
            flat.walls = vec![plane(Vec3::z())];
            let velocity = Vec3::new(tilt.sin(), 0.0, -tilt.cos()) * SPEED;
            flat.particles = vec![ball(Vec3::z() * (R + 1e-6), velocity)];
            let wanted = after(flat).velocity / SPEED;
            normal = normal.max((out.z - wanted.z).abs());
            tangential = tangential.max((out.x - wanted.x).abs());
        }
        let told = format!("{law:?}, μ = 0.3, rolling {}, 0° to 60°", model.unwrap_or("none"));
        OBLIQUE.within(&format!("{told}: normal"), normal, "of the speed", 0.01);
        OBLIQUE.within(&format!("{told}: tangential"), tangential, "of the speed", 0.03);
    }
}

/// What a spring that yields remembers belongs to each sphere: a patch of them would be fed by each that comes and goes.
#[test]
fn a_law_that_yields_makes_no_energy() {
    for (e, radius) in [(0.3, 2.0 * R), (0.5, R), (0.8, 2.0 * R)] {
        let law = Law::Hooke { stiffness: 1e4, tangential_ratio: None };
        let mut setup = with_friction(empty(law, e), 0.5);
        let yields = |c: &ContactLaw| {
            let mut new = ContactLaw::new(c.between, "walton_braun").with("stiffness", 1e4);
            for key in ["restitution", "sliding_friction"] {
                new.set(key, c.number(key));
            }
            new
        };
        setup.contacts = setup.contacts.iter().map(yields).collect();
        setup.walls = vec![still(&lattice(0.2 * R, 2e-4 * R, 12.0 * R))];
        setup.step = Step::Auto(0.3);
        setup.gravity = Vec3::new(0.0, 0.0, -9.81);
        setup.ledger = true;
        let velocity = Vec3::new(0.3, 0.0, -0.05);
        setup.particles =
            vec![Particle { radius, ..ball(Vec3::new(-8.0 * R, 0.0, radius + 1e-5), velocity) }];
        let mut sim = Simulation::new(setup).expect("sound");
        run_until(&mut sim, 0.2);
        let kinetic = 0.5 * mass(radius, 2500.0) * velocity.norm_squared();
        let made = sim.energy().expect("within the guards").integration.abs() / kinetic;
        YIELDS.within(&format!("e = {e}, r = {radius} m"), made, "of the energy", 1e-3);
    }
}

/// Two half walls that meet in the line y = z = 0, each turned by an angle: above 0 they rise from it.
fn valley(p: f64, roughness: f64, angle: f64) -> Vec<(Vec3, f64)> {
    let turned = |side: f64| {
        move |&(c, r): &(Vec3, f64)| {
            let (out, up) = (c.y, c.z);
            let (cos, sin) = (angle.cos(), angle.sin());
            (Vec3::new(c.x, side * (out * cos - up * sin), out * sin + up * cos), r)
        }
    };
    let half: Vec<(Vec3, f64)> = lattice(p, roughness, 5.0 * R).into_iter().filter(|s| s.0.y > 0.0).collect();
    half.iter().map(turned(1.0)).chain(half.iter().map(turned(-1.0))).collect()
}

#[test]
fn elastic_grains_keep_their_energy() {
    for (law, young) in laws(1e6).into_iter().map(|law| (law, 1e6)) {
        for (angle, told) in
            [(0.0, "flat"), (10.0, "valley of 160°"), (45.0, "corner of 90°"), (80.0, "slot of 20°")]
        {
            let mut worst = 0.0f64;
            for (share, rough) in [(0.5, 0.1), (0.25, 0.05), (1.0, 0.3)] {
                let p = share * 2.0 * R;
                let mut setup = soft(law, 1.0, young);
                setup.step = Step::Auto(0.05);
                setup.ledger = true;
                setup.walls = vec![still(&valley(p, rough * p, f64::to_radians(angle)))];
                setup.particles =
                    vec![ball(Vec3::new(0.3 * p, 0.4 * R, 9.0 * R), Vec3::new(0.05, -0.1, -0.3))];
                setup.gravity = -Vec3::z() * 9.81;
                let mut sim = Simulation::new(setup).expect("sound");
                let energy = |sim: &mut Simulation| {
                    let e = sim.energy().expect("sound");
                    e.translation + e.rotation + e.potential + e.elastic
                };
                let start = energy(&mut sim);
                let scale = 0.5 * mass(R, 2500.0) * 0.4;
                while sim.time() < 0.15 {
                    run_until_next(&mut sim, 50);
                    worst = worst.max((energy(&mut sim) - start).abs() / scale);
                }
            }
            KEPT.within(&format!("{law:?}, {told}"), worst, "of the kinetic energy", 0.01);
        }
    }
}

#[test]
fn grains_rest_in_valleys() {
    for law in laws(1e7) {
        let p = 0.6 * R;
        let mut setup = soft(law, 0.5, 1e7);
        setup.gravity = -Vec3::z() * 9.81;
        setup.walls = vec![still(&lattice(p, 0.2 * p, 3.0 * R))];
        setup.particles = vec![ball(Vec3::new(0.1 * p, 0.05 * p, 1.1 * R), Vec3::new(0.02, 0.006, 0.0))];
        let mut sim = Simulation::new(setup).expect("sound");
        run_until(&mut sim, 2.0);
        let speed = particles(&mut sim)[0].velocity.norm();
        REST.within(&format!("{law:?}, no friction, after 2 s"), speed, "m/s", 1e-7);
    }
}

/// A grain pressed by its weight into a corner of 90° rests as deep as between two planes.
#[test]
fn corners_inside_one_wall_are_two_contacts() {
    for law in laws(1e6) {
        let rest = |walls: Vec<Wall>| {
            let mut setup = soft(law, 0.3, 1e6);
            setup.gravity = -Vec3::z() * 200.0;
            setup.walls = walls;
            setup.particles = vec![ball(Vec3::new(0.1 * R, 0.0, 2f64.sqrt() * R), Vec3::zeros())];
            let mut sim = Simulation::new(setup).expect("sound");
            run_until(&mut sim, 0.5);
            2f64.sqrt() * R - particles(&mut sim)[0].position.z
        };
        let sides = [1.0, -1.0].map(|side| plane(Vec3::new(0.0, side, 1.0)));
        let (flat, p) = (rest(sides.to_vec()), R);
        let sunk = rest(vec![still(&valley(p, 0.0005 * p, f64::to_radians(45.0)))]);
        CORNER.within(&format!("{law:?}: depth over that between planes"), sunk / flat - 1.0, "–", 0.35);
    }
}

/// So stiff that a clump hardly turns while it touches [Pa].
const YOUNG: f64 = 1e9;

/// Speed at which a clump leaves a plane, along the normal where it touched, over that of its approach.
fn clump_rebound(law: Law, e: f64, spheres: &[(Vec3, f64)], turn: Vec3) -> f64 {
    let mut setup = soft(law, e, YOUNG);
    setup.walls = vec![plane(Vec3::z())];
    let shape = clump(spheres);
    let orientation = nalgebra::UnitQuaternion::from_scaled_axis(turn);
    let lowest = |(c, r): (Vec3, f64)| c.z - r;
    let low = shape.spheres_at(Vec3::zeros(), &orientation, 1.0).map(lowest).fold(0.0, f64::min);
    let touching = shape
        .spheres_at(Vec3::zeros(), &orientation, 1.0)
        .find(|s| lowest(*s) < low + 1e-9)
        .map_or_else(Vec3::zeros, |(c, r)| c - Vec3::z() * r);
    setup.clumps.shapes.push(shape);
    let (velocity, position) = (-Vec3::z() * SPEED, Vec3::z() * (1e-6 - low));
    setup.clumps.placed.push(Body {
        id: 0,
        shape: 0,
        scale: 1.0,
        position,
        orientation,
        velocity,
        spin: Vec3::zeros(),
    });
    let mut sim = Simulation::new(setup).expect("sound");
    let mut touched = false;
    loop {
        sim.step().expect("within the guards");
        let force = sim.wall_forces().expect("sound")[0].force.norm();
        touched |= force > 0.0;
        if touched && force == 0.0 {
            let body = sim.clumps().expect("sound")[0];
            return (body.velocity + body.spin.cross(&touching)).z / SPEED;
        }
    }
}

#[test]
fn clumps_rebound_with_the_restitution_asked_for() {
    let plate = |n: i32| -> Vec<(Vec3, f64)> {
        let at = |k: i32| 2.0 * R * f64::from(k);
        (0..n * n).map(|k| (Vec3::new(at(k % n), at(k / n), 0.0), 1.2 * R)).collect()
    };
    let rod: Vec<(Vec3, f64)> = (0..3).map(|k| (Vec3::x() * R * f64::from(k), R)).collect();
    for (law, e) in laws(YOUNG).into_iter().flat_map(|law| [0.3, 0.6, 0.9].map(|e| (law, e))) {
        for n in 1..=3 {
            let off = clump_rebound(law, e, &plate(n), Vec3::zeros()) - e;
            CLUMP.within(&format!("{law:?}, e = {e}: plate of {} spheres, flat", n * n), off, "–", 0.005);
        }
        let off = clump_rebound(law, e, &rod, Vec3::y() * 0.5) - e;
        CLUMP.within(&format!("{law:?}, e = {e}: rod of 3 spheres on one end"), off, "–", 0.005);
    }
}

#[test]
fn walls_on_springs_part_with_the_restitution_asked_for() {
    let m = mass(R, 2500.0);
    for (law, e) in laws(1e7).into_iter().flat_map(|law| [0.3, 0.7].map(|e| (law, e))) {
        for share in [0.3, 1.0, 5.0] {
            let p = 0.5 * R;
            for wall in [plane(Vec3::z()), still(&lattice(p, 0.002 * p, 2.0 * R))] {
                let mut setup = soft(law, e, 1e7);
                let plate = share * m;
                let mount = Mount {
                    direction: Vec3::z(),
                    stiffness: 1e-3,
                    damping: 0.0,
                    mass: plate,
                    speed_limit: 2.0,
                };
                setup.walls = vec![Wall { mount: Some(mount), ..wall }];
                setup.particles = vec![ball(Vec3::z() * (R + 1e-5), -Vec3::z() * SPEED)];
                let mut sim = Simulation::new(setup).expect("sound");
                run_until(&mut sim, 0.01);
                let wanted = -(m - e * plate) / (m + plate);
                let off = particles(&mut sim)[0].velocity.z / SPEED - wanted;
                SPRING.within(&format!("{law:?}, e = {e}, M/m = {share}"), off, "of the speed", 0.01);
            }
        }
    }
}

/// Patches are the same for every width of lanes.
#[test]
fn every_width_has_the_same_patches() {
    let run = |width| {
        let mut setup = with_friction(soft(Law::Hertz, 0.5, 1e6), 0.3);
        setup.walls = vec![still(&valley(0.5 * R, 0.05 * R, 0.4))];
        setup.gravity = -Vec3::z() * 9.81;
        let at = |k: u32| Vec3::new(0.0, 0.3 * R, 1.5 * R) * f64::from(k + 1);
        setup.particles = (0..3).map(|k| Particle { id: k, ..ball(at(k), Vec3::x() * 0.1) }).collect();
        let mut sim = Simulation::with_width(setup, width).expect("sound");
        run_until(&mut sim, 0.05);
        particles(&mut sim)
    };
    let scalar = run(Width::Scalar);
    for width in Width::available() {
        assert_eq!(run(width), scalar, "{width:?}");
    }
}
