//! Fast grains and thin walls: whatever is thrown at a wall, at whatever speed, step and place, bounces, or is stopped before it
//! is on the other side.
//!
//! What catches it: `guards.motion` m (largest way in a step over the radius) and `guards.overlap` o (largest overlap over the
//! smaller radius). A grain of radius r that has not touched is at least r away from a surface; it enters by at most m r. Where its
//! overlap is then more than o r it is stopped; where it is not, it is (1 − o) r away and goes m r further. So it is seen
//! on this side as long as m < 1 − o, and a stop comes with the next step.

use crate::variants::{Variant, simulation, variants};
use dem::Simulation;
use dem::setup::*;
use geom::{Plane, Vec3, mesh::TriMesh};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{grain, plane};
use scene::advice::explain_halt;

const FAST: Case =
    case("Rest and extremes", "an impact at 100 m/s at half the critical step: rebounds with e");
const STOPPED: Case = case(
    "Rest and extremes",
    "an impact at 100 m/s on too soft a grain is stopped; the message names the grain",
);
const TUNNEL: Case = case(
    "Rest and extremes",
    "grains thrown at up to 100 radii per step at planes, a mesh, and wall spheres down to 1/50 of their size: none passes without a stop",
);

/// What is thrown at: all at or below z = 0.
#[derive(Debug, Clone, Copy)]
enum Target {
    Plane,
    Mesh,
    /// A carpet of wall spheres of this radius over that of the grain, closer than they are wide.
    Spheres(f64),
    /// The mesh comes at the grain with this share of its radius in a step.
    MovingMesh(f64),
}

const TARGETS: [Target; 8] = [
    Target::Plane,
    Target::Mesh,
    Target::Spheres(1.0),
    Target::Spheres(0.1),
    Target::Spheres(0.02),
    Target::Spheres(10.0),
    Target::MovingMesh(0.05),
    Target::MovingMesh(0.24),
];

const RADIUS: f64 = 0.01;
/// Where in a step the grain touches.
const PHASES: u32 = 8;

fn target(target: Target, dt: f64) -> Wall {
    let mut wall = plane(Vec3::z());
    wall.shape = match target {
        Target::Plane => WallShape::Plane(Plane { point: Vec3::zeros(), normal: Vec3::z() }),
        Target::Mesh | Target::MovingMesh(_) => {
            // The seam and a corner of the triangles lie under the grains.
            let vertices = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (0.0, 0.0)];
            let vertices = vertices.map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec();
            WallShape::Mesh(TriMesh { vertices, faces: vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]] })
        }
        Target::Spheres(share) => {
            let (r, side) = (share * RADIUS, 1.2 * share * RADIUS);
            // As far as a grain may go sideways, and it is seen from one sphere to the next.
            let half = ((0.015 / side).ceil() as i32).max(3);
            let at = |i: i32, j: i32| (Vec3::new(side * f64::from(i), side * f64::from(j), -r), r);
            WallShape::Spheres((-half..=half).flat_map(|i| (-half..=half).map(move |j| at(i, j))).collect())
        }
    };
    if let Target::MovingMesh(share) = target {
        wall.motion.velocity.z = share * RADIUS / dt;
    }
    wall
}

/// Velocity after the impact of a grain at 100 m/s on a floor, or why the run was stopped.
fn impact(variant: &Variant, young: f64, share: f64) -> Result<f64, String> {
    let mut setup = stiff(variant, 0.5, young);
    setup.step = Step::Auto(share);
    setup.walls = vec![plane(Vec3::z())];
    let velocity = Vec3::new(0.0, 0.0, -100.0);
    setup.particles = vec![Particle { velocity, ..grain(7, Vec3::new(0.0, 0.0, 0.011)) }];
    let mut sim = simulation(setup);
    for _ in 0..100_000 {
        sim.step().map_err(|halt| explain_halt(&halt))?;
        let p = sim.particles().map_err(|halt| halt.to_string())?[0];
        if p.velocity.z > 0.0 && p.position.z > 0.0101 {
            return Ok(p.velocity.z);
        }
    }
    Err("stays".to_owned())
}

#[test]
fn an_impact_at_100_metres_a_second() {
    for variant in variants() {
        for (share, limit) in [(0.5, 0.03), (0.05, 5e-3)] {
            let speed = impact(&variant, 5e10, share).expect("it bounces");
            FAST.equals(
                &format!("{}, {share} of the critical step", variant.name()),
                speed,
                "m/s",
                50.0,
                limit,
            );
        }
        let said = impact(&variant, 1e7, 0.5).expect_err("too soft");
        STOPPED.refused(
            &variant.name(),
            &said,
            &["particle 7", "in one step", "limit 25.0 %", "shorten time.dt"],
        );
    }
}

/// The law with stiffer grains: Young's modulus [Pa], and for the linear law the stiffness that stores as much at 100 m/s.
fn stiff(variant: &Variant, restitution: f64, young: f64) -> Setup {
    let mut setup = variant.smooth(restitution);
    setup.materials.iter_mut().for_each(|m| m.young = young);
    for c in &mut setup.contacts {
        c.set("stiffness", c.number("stiffness").map(|_| 1e4 * young / 1e7));
    }
    setup
}

/// A grain that is thrown at the target; whether it was stopped, or came back, and never was on the other side.
fn thrown(variant: &Variant, at: Target, speed: f64, dt: f64, offset: f64) -> Result<bool, String> {
    let mut setup = variant.smooth(0.5);
    setup.step = Step::Fixed(dt);
    let wall = target(at, dt);
    let rising = wall.motion.velocity.z;
    setup.walls = vec![wall];
    // Somewhere in the step before it touches, a little to the side.
    let way = (speed + rising) * dt;
    let position =
        Vec3::new(0.37 * offset * RADIUS, 0.11 * offset * RADIUS, 1.05 * RADIUS + way * (1.0 + offset));
    let velocity = Vec3::new(0.0, 0.0, -speed);
    setup.particles = vec![Particle { velocity, ..grain(7, position) }];
    let Ok(mut sim) = Simulation::new(setup) else { return Ok(true) };
    let reach = if let Target::Spheres(share) = at { -2.0 * share * RADIUS } else { 0.0 };
    // Under many wall spheres at once it loses nearly all of its speed, and takes long to rise.
    for _ in 0..4000 {
        if let Err(halt) = sim.step() {
            let text = halt.to_string();
            return if text.contains("particle 7") { Ok(true) } else { Err(text) };
        }
        let Ok(all) = sim.particles() else { return Ok(true) };
        let (p, surface) = (all[0], rising * sim.time());
        if !(p.position.z - surface > reach) {
            return Err(format!("is at {} m, the wall at {surface} m", p.position.z));
        }
        if p.velocity.z > rising && p.position.z - surface > 1.01 * RADIUS {
            return Ok(false);
        }
    }
    Err(format!("neither bounced nor stopped: {:?}", sim.particles().map(|all| all[0])))
}

/// Speeds from one that bounces to some that pass the wall in a single step, at every phase of the step.
#[test]
fn nothing_is_on_the_other_side_without_a_stop() {
    for variant in variants() {
        let limit =
            dem::critical_step(&Setup { particles: vec![grain(1, Vec3::zeros())], ..variant.smooth(0.5) });
        let dt = 0.3 * limit.expect("contacts").dt;
        for at in TARGETS {
            let (mut stops, mut bounces) = (0, 0);
            for share in [0.001, 0.01, 0.05, 0.1, 0.2, 0.249, 0.26, 0.5, 1.0, 1.9, 2.1, 5.0, 100.0] {
                for phase in 0..PHASES {
                    let (speed, offset) = (share * RADIUS / dt, f64::from(phase) / f64::from(PHASES));
                    match thrown(&variant, at, speed, dt, offset) {
                        Ok(true) => stops += 1,
                        Ok(false) => bounces += 1,
                        Err(what) => panic!(
                            "{}, {at:?}, {share} of its radius a step, phase {phase}: {what}",
                            variant.name()
                        ),
                    }
                }
            }
            let on = format!("{}: {at:?}, {} throws, {stops} stopped", variant.name(), stops + bounces);
            TUNNEL.within(&on, 0.0, "grains on the other side", 0.0);
            assert!(stops > 0, "{on}");
        }
    }
}
