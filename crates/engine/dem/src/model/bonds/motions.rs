//! Motions that a bond resists, and how fast two bonded particles are in them.

use crate::model::bonds::kinds::End;
use crate::setup::BondNumbers;
use geom::Vec3;
use nalgebra::Vector6;

/// A motion of one end that a spring resists.
pub(super) struct Motion {
    /// Stiffness [N/m or N·m/rad].
    pub(super) stiffness: f64,
    /// Of i and of j.
    pub(super) ends: [Vector6<f64>; 2],
}

/// Motions that a bond along `n` resists, each by itself.
pub(super) fn motions(bond: &BondNumbers, n: &Vec3) -> [Motion; 6] {
    let side = (if n.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() }).cross(n).normalize();
    let across = [side, n.cross(&side)];
    let [along, shear, bend, twist] = bond.stiffness;
    let motion = |stiffness: f64, push: Vec3, turns: [Vec3; 2]| {
        let end = |sign: f64, turn: Vec3| {
            let u = push * sign;
            Vector6::new(u.x, u.y, u.z, turn.x, turn.y, turn.z)
        };
        Motion { stiffness, ends: [end(1.0, turns[0]), end(-1.0, turns[1])] }
    };
    let still = Vec3::zeros();
    let arms = [bond.share, 1.0 - bond.share].map(|share| -share * bond.size[0]);
    let sheared = across.map(|e| motion(shear, e, arms.map(|arm| n.cross(&e) * arm)));
    let bent = across.map(|e| motion(bend, still, [e, -e]));
    let ([s, t], [b, c]) = (sheared, bent);
    [motion(along, *n, [still; 2]), motion(twist, still, [*n, -n]), s, t, b, c]
}

/// 1/m and 1/I of a particle.
pub(super) fn inverse(end: &End) -> Vector6<f64> {
    let (push, turn) = (1.0 / end.mass, 2.5 / (end.mass * end.radius * end.radius));
    Vector6::new(push, push, push, turn, turn, turn)
}

/// The largest frequency of two bonded particles alone [rad/s], of the motions that a bond resists one by one.
pub(super) fn frequency(bond: &BondNumbers, ends: [End; 2]) -> f64 {
    let inverse = ends.map(|end| inverse(&end));
    let square = |m: &Motion| {
        let of = |e: usize| m.ends[e].component_mul(&m.ends[e]).dot(&inverse[e]);
        m.stiffness * (of(0) + of(1))
    };
    motions(bond, &bond.axis).iter().map(square).fold(0.0, f64::max).sqrt()
}
