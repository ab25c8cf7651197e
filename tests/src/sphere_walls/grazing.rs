//! Kinetic energy of grains after grazing impacts over that before: no wall may add to it.
//!
//! Grains come down at 1° to 10° onto a surface without gravity, spinning forwards, backwards or not at all, and fly off. What a
//! grain has when it is free again is its kinetic energy; with e = 1 and no friction it is that of the start, else it is less.

use super::chance::Chance;
use super::plates::touch;
use dem::Simulation;
use dem::setup::*;
use geom::{Vec3, mesh::TriMesh};
use grainpipe_tests::normals::Normal;
use grainpipe_tests::setups::{grain, plane, with_friction};

/// Speed [m/s].
const SPEED: f64 = 0.5;
/// Radius of the grains [m].
pub const RADIUS: f64 = 0.01;
/// Angles of approach above the surface [°].
pub const ANGLES: [f64; 4] = [1.0, 3.0, 6.0, 10.0];
/// Spin over v/r: forwards as it rolls, none, backwards.
const SPINS: [f64; 3] = [1.0, 0.0, -1.0];
/// Grains of each angle and spin.
const EACH: usize = 6;

/// What is grazed.
#[derive(Debug, Clone)]
pub enum Target {
    /// A plane.
    Plane,
    /// A flat mesh of small triangles: grains run over many seams while they touch.
    Mesh,
    /// Wall spheres.
    Spheres(Vec<(Vec3, f64)>),
}

/// A law on a wall.
#[derive(Debug, Clone, Copy)]
pub struct Impact {
    /// Normal law, with what adheres.
    pub normal: Normal,
    /// e [–].
    pub restitution: f64,
    /// μ [–]; `None`: no friction.
    pub friction: Option<f64>,
    /// Time step over the critical one [–].
    pub safety: f64,
}

/// Largest gain and largest loss of kinetic energy over that of the start [–], and the number of grains that flew off.
#[derive(Debug, Clone, Copy)]
pub struct Change {
    /// Largest gain; negative when all lost.
    pub gain: f64,
    /// Largest loss.
    pub loss: f64,
    /// Grains that are free again.
    pub free: usize,
}

/// Grains that graze a target.
///
/// # Panics
/// When a guard trips.
pub fn graze(target: &Target, impact: Impact) -> Change {
    let mut setup = impact.normal.setup(impact.restitution);
    if let Some(friction) = impact.friction {
        setup = with_friction(setup, friction);
    }
    setup.step = Step::Auto(impact.safety);
    setup.walls = vec![wall(target)];
    setup.particles = grains(target);
    // Without friction the engine has no spins.
    if impact.friction.is_none() {
        setup.particles.iter_mut().for_each(|p| p.spin = Vec3::zeros());
    }
    let energy = |p: &Particle| p.velocity.norm_squared() + 0.4 * RADIUS * RADIUS * p.spin.norm_squared();
    let before: Vec<f64> = setup.particles.iter().map(energy).collect();
    let start = setup.particles.clone();
    let mut sim = Simulation::new(setup).expect("sound");
    while sim.time() < 0.2 {
        sim.step().expect("no guard");
    }
    let mut change = Change { gain: f64::NEG_INFINITY, loss: f64::NEG_INFINITY, free: 0 };
    for ((p, from), before) in sim.particles().expect("no guard").iter().zip(&start).zip(before) {
        if p.velocity.z <= 0.0 || p.position.z < from.position.z || p.velocity == from.velocity {
            continue;
        }
        let ratio = energy(p) / before - 1.0;
        change.gain = change.gain.max(ratio);
        change.loss = change.loss.max(-ratio);
        change.free += 1;
    }
    change
}

/// Grains just above the surface, 40 mm apart, with random directions along x and y.
fn grains(target: &Target) -> Vec<Particle> {
    let mut chance = Chance::new(1);
    let mut out = Vec::new();
    let side = ((ANGLES.len() * SPINS.len() * EACH) as f64).sqrt().ceil() as usize;
    for k in 0..ANGLES.len() * SPINS.len() * EACH {
        let (angle, spin) = (ANGLES[k % ANGLES.len()].to_radians(), SPINS[k / ANGLES.len() % SPINS.len()]);
        let place = |n: usize, jitter: f64| 0.048 * (n as f64 - 0.5 * side as f64) + jitter;
        let (x, y) = (place(k % side, chance.between(0.0, 0.01)), place(k / side, chance.between(0.0, 0.01)));
        let top = match target {
            Target::Spheres(spheres) => touch(spheres, RADIUS, x, y).expect("on the wall").0,
            _ => RADIUS,
        };
        // All fly alike, but for a little: they do not meet.
        let azimuth = 0.3 + chance.between(-0.02, 0.02);
        let along = Vec3::new(azimuth.cos(), azimuth.sin(), 0.0);
        let velocity = SPEED * (along * angle.cos() - Vec3::z() * angle.sin());
        let spin = Vec3::z().cross(&along) * (spin * SPEED / RADIUS);
        out.push(Particle { velocity, spin, ..grain(k as u32, Vec3::new(x, y, top + 1e-5)) });
    }
    out
}

fn wall(target: &Target) -> Wall {
    match target {
        Target::Plane => plane(Vec3::z()),
        Target::Mesh => Wall { shape: WallShape::Mesh(triangles(0.36, 0.0041)), ..plane(Vec3::z()) },
        Target::Spheres(spheres) => super::plates::still(spheres),
    }
}

/// A square of 2 × `half` [m] of triangles with legs of `leg` [m].
fn triangles(half: f64, leg: f64) -> TriMesh {
    let n = (2.0 * half / leg).ceil() as u32;
    let corner = |k: u32| -half + leg * f64::from(k);
    let vertices = (0..=n).flat_map(|j| (0..=n).map(move |i| Vec3::new(corner(i), corner(j), 0.0))).collect();
    let at = |i: u32, j: u32| j * (n + 1) + i;
    let square = |(i, j): (u32, u32)| {
        [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
    };
    let faces = (0..n).flat_map(|j| (0..n).map(move |i| (i, j))).flat_map(square).collect();
    TriMesh::new(vertices, faces).expect("sound")
}
