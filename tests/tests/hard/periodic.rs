//! Contacts across the faces of a periodic box.

use crate::variants::{Variant, run, simulation, variants};
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{grain, particles, plane};
use scene::advice::explain_setup_error;

const ACROSS: Case =
    case("Rest and extremes", "a contact is the same in the middle of a periodic box and across its face");

const ACROSS_SPIN: Case =
    case("Rest and extremes", "spins are the same in the middle of a periodic box and across its face");

const ACROSS_WALL: Case = case(
    "Rest and extremes",
    "a contact with a plane is the same in an open box and across the faces of a periodic one",
);

const SHORT: Case = case(
    "Rest and extremes",
    "a periodic box shorter than a diameter plus the skin, or without an end: refused",
);

/// Steps of a trial: the contact lasts for most of them.
const STEPS: u64 = 400;
/// Way of the pair in a trial [m]: through the face and on.
const WAY: f64 = 0.03;

/// Two rubbing, rolling grains, in the middle of a periodic box or across its face.
fn rubbing(variant: &Variant, x: f64, period: f64, skin: Option<f64>) -> Vec<Particle> {
    let mut setup = variant.rough(0.9, 0.3);
    setup.periodic = [Some((0.0, period)), None, None];
    setup.skin = skin;
    let dt = dem::critical_step(&Setup { particles: vec![grain(0, Vec3::zeros())], ..setup.clone() });
    let dt = 0.05 * dt.expect("contacts").dt;
    setup.step = Step::Fixed(dt);
    let drift = WAY / (STEPS as f64 * dt);
    // Faster than what the spring gives, or as fast.
    let spin = Vec3::new(0.0, 0.0, 2.0 * drift);
    let drift = Vec3::new(drift, 0.2 * drift, 0.0);
    let side = 0.0195;
    setup.particles = vec![
        Particle { spin, velocity: drift, ..grain(0, Vec3::new(x, 0.0, 0.0)) },
        Particle { velocity: drift, ..grain(1, Vec3::new((x + side) % period, 0.0, 0.0)) },
    ];
    let mut sim = simulation(setup);
    run(&mut sim, STEPS);
    particles(&mut sim)
}

/// Spring and couple of a contact go with it through a periodic face, also where both images of a grain are listed with another.
#[test]
fn a_contact_is_the_same_across_a_periodic_face() {
    for variant in variants() {
        let middle = rubbing(&variant, 0.4, 1.0, None);
        let scale = middle[0].velocity.norm();
        for (x, period, skin) in
            [(0.99, 1.0, None), (0.02, 0.05, None), (0.045, 0.05, None), (0.02, 0.05, Some(0.02))]
        {
            let on = format!("{}, from {x} m of {period} m", variant.name());
            // Places have other last digits there; single precision hands them on as its own.
            let limit = if variant.mixed() { 1e-6 } else { 1e-10 };
            for (a, b) in middle.iter().zip(&rubbing(&variant, x, period, skin)) {
                let (v, w) = ((a.velocity - b.velocity).norm(), (a.spin - b.spin).norm() * a.radius);
                ACROSS.within(&on, v / scale, "of the speed", limit);
                ACROSS_SPIN.within(&on, w / scale, "of the speed", limit);
                assert!(a.spin.norm() > 0.01 * scale, "{on}: they rub");
            }
        }
    }
}

/// A grain that rubs and rolls on a plane through the origin with its normal along `n`, drawn to it, and drifts along `way` through `start`; the plane moves
/// along itself at `belt` times that speed. Its velocity and spin over its first speed, at the end.
fn rubbing_on_plane(variant: &Variant, ground: &Ground, start: f64, period: Option<f64>) -> [Vec3; 2] {
    let mut setup = variant.rough(0.3, 0.3);
    setup.guards.overlap = 0.9;
    let (n, along) = (ground.normal.normalize(), ground.way.normalize());
    setup.periodic = ground.periodic.map(|on| period.filter(|_| on).map(|period| (0.0, period)));
    setup.walls = vec![plane(n)];
    let dt = dem::critical_step(&Setup { particles: vec![grain(0, Vec3::zeros())], ..setup.clone() });
    let dt = 0.05 * dt.expect("contacts").dt;
    setup.step = Step::Fixed(dt);
    let speed = WAY / (STEPS as f64 * dt);
    setup.walls[0].motion.velocity = along * (ground.belt * speed);
    setup.gravity = -n * (1e-3 * speed / dt);
    let spin = n.cross(&along) * (40.0 * speed);
    setup.particles =
        vec![Particle { spin, velocity: along * speed, ..grain(0, n * 0.0099 + along * start) }];
    let mut sim = simulation(setup);
    run(&mut sim, STEPS);
    let end = &particles(&mut sim)[0];
    [end.velocity / speed, end.spin * (end.radius / speed)]
}

/// What a grain moves on: the normal of a plane, along which it drifts, how fast the plane moves with it, and which axes are periodic.
struct Ground {
    normal: Vec3,
    way: Vec3,
    belt: f64,
    periodic: [bool; 3],
}

/// Every history of a contact with a plane goes with it through periodic faces: those along which the plane has no images, and those that it crosses.
#[test]
fn a_contact_with_a_plane_is_the_same_across_periodic_faces() {
    let ground = |normal: [f64; 3], way: [f64; 3], belt: f64, periodic: [bool; 3]| Ground {
        normal: normal.into(),
        way: way.into(),
        belt,
        periodic,
    };
    let grounds = [
        ground([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], 0.0, [true, false, false]),
        ground([0.0, 0.0, 1.0], [1.0, 0.8, 0.0], 0.0, [true, true, false]),
        ground([0.0, 0.0, -1.0], [-1.0, 0.8, 0.0], 4.0, [true, true, false]),
        ground([0.0, 1.0, 0.0], [0.3, 0.0, -1.0], 0.0, [false, false, true]),
        ground([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], 0.0, [true, true, false]),
        ground([1.0, 0.0, 1.0], [-1.0, 0.4, 1.0], 0.0, [true, true, false]),
    ];
    for variant in variants() {
        for ground in &grounds {
            let on = format!("{}, normal {:?}, way {:?}", variant.name(), ground.normal, ground.way);
            let open = rubbing_on_plane(&variant, ground, -0.012, None);
            let turned = (open[1] - ground.normal.normalize().cross(&ground.way.normalize()) * 0.4).norm();
            assert!(turned > 0.01, "{on}: it rubs");
            // Positions have other last digits there; single precision hands them on as its own.
            let limit = if variant.mixed() { 1e-5 } else { 1e-9 };
            for period in [0.05, 1.0] {
                let across = rubbing_on_plane(&variant, ground, -0.012, Some(period));
                for (a, b) in open.iter().zip(&across) {
                    ACROSS_WALL.within(&on, (a - b).norm(), "of the speed", limit);
                }
            }
        }
    }
}

/// A skin with which a grain would be listed with its own image is refused, as is a box without an end.
#[test]
fn a_period_below_the_skin_is_refused() {
    let said = |period: f64, skin: Option<f64>| {
        let mut setup = variants()[0].smooth(1.0);
        setup.periodic = [Some((0.0, period)), None, None];
        setup.skin = skin;
        setup.particles = vec![grain(0, Vec3::new(0.01, 0.0, 0.0)), grain(1, Vec3::new(0.04, 0.0, 0.0))];
        dem::Simulation::new(setup).err().map(|e| explain_setup_error(&e))
    };
    for skin in [0.081, 1.0] {
        let said = said(0.1, Some(skin)).expect("refused");
        let skin = format!("{skin:.4e} m");
        SHORT.refused(
            &skin,
            &said,
            &["neighbours.skin", &skin, "1.0000e-1 m along x", "at most 8.0000e-2 m"],
        );
    }
    assert_eq!((said(0.1, Some(0.08)), said(0.1, None)), (None, None));
    for skin in [None, Some(0.01)] {
        let said = said(f64::INFINITY, skin).expect("refused");
        SHORT.refused("a period without an end", &said, &["domain high: x", "inf m"]);
    }
}
