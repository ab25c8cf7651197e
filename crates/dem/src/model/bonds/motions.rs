//! Motions that a beam resists, and how fast two bonded particles are in them.

use crate::effects::Material;
use crate::model::Beam;
use crate::setup::Particle;
use crate::space::sphere::mass;
use geom::Vec3;
use nalgebra::Vector6;

/// A motion of one end that a spring resists.
pub(super) struct Motion {
    /// Stiffness [N/m or N·m/rad].
    pub(super) stiffness: f64,
    /// Of i and of j.
    pub(super) ends: [Vector6<f64>; 2],
}

/// Motions that a beam resists, each by itself; rotations are multiplied by the length, so that all are in metres.
pub(super) fn motions(beam: &Beam) -> [Motion; 6] {
    let n = beam.axis;
    let side = (if n.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() }).cross(&n).normalize();
    let across = [side, n.cross(&side)];
    let [along, bend, twist] = beam.stiffness;
    let motion = |stiffness: f64, push: Vec3, turns: [Vec3; 2]| {
        let end = |sign: f64, turn: Vec3| {
            let u = push * sign;
            Vector6::new(u.x, u.y, u.z, turn.x, turn.y, turn.z)
        };
        Motion { stiffness, ends: [end(1.0, turns[0]), end(-1.0, turns[1])] }
    };
    let shear = 12.0 * bend / (beam.length * beam.length);
    let still = Vec3::zeros();
    let sheared = across.map(|e| motion(shear, e, [n.cross(&e) * (-0.5 * beam.length); 2]));
    let bent = across.map(|e| motion(bend, still, [e, -e]));
    let ([s, t], [b, c]) = (sheared, bent);
    [motion(along, n, [still; 2]), motion(twist, still, [n, -n]), s, t, b, c]
}

/// 1/m and 1/I of a particle.
pub(super) fn inverse(particle: &Particle, materials: &[Material]) -> Vector6<f64> {
    let m = mass(particle.radius, materials[particle.material as usize].density);
    let (push, turn) = (1.0 / m, 2.5 / (m * particle.radius * particle.radius));
    Vector6::new(push, push, push, turn, turn, turn)
}

/// The largest frequency of two bonded particles alone [rad/s], of the motions that a beam resists one by one.
pub fn frequency(beam: &Beam, ends: [&Particle; 2], materials: &[Material]) -> f64 {
    let inverse = ends.map(|p| inverse(p, materials));
    let square = |m: &Motion| {
        let of = |e: usize| m.ends[e].component_mul(&m.ends[e]).dot(&inverse[e]);
        m.stiffness * (of(0) + of(1))
    };
    motions(beam).iter().map(square).fold(0.0, f64::max).sqrt()
}
