//! What bonds do: springs between two particles that depend on their positions and turns alone.
//!
//! ```text
//! U = ½ k_n (d − L)² + ½ k_s γ² + ½ k_b |a_i − a_j|² + ½ k_t (2 sin φ/2)²,      γ = L (w_i a_i + w_j a_j)
//!   = ½ k_n (d − L)² + ½ P_i a_i² + ½ P_j a_j² + Q a_i·a_j + ½ k_t (2 sin φ/2)²
//! ```
//!
//! a: n × t, by which the end of the bond, fixed in its particle, is turned out of the line of the centres n; w: distance of the section from both centres over
//! L, so that γ is how far the two halves have slid past each other there; φ: the turn of one end against the other about the bond. Forces and moments are the
//! gradient of U: a bond that is turned as a whole does nothing, however often, and momentum and angular momentum are kept to rounding. Dashpots are the
//! same springs fed by rates.
//!
//! All kinds of bonds are such springs ([`super::kinds`]). Of a beam, w = ½ and k_s = 12 k_b/L²: 2 E I/L (a_i² + a_i·a_j + a_j²).
//!
//! On lanes, as contacts are: inlined, without closures ([`laws::simd`]).

use super::springs::SpringLanes;
use laws::simd::{Lane, Turn, V};
use serde::{Deserialize, Serialize};

/// Bonded particles.
pub struct Ends<R> {
    /// Centre of i relative to j [m].
    pub arm: V<R>,
    /// Velocity of i less that of j [m/s].
    pub velocity: V<R>,
    /// Angular velocities of i and j [rad/s].
    pub spin: [V<R>; 2],
    /// How both have turned since they were bonded.
    pub turn: [Turn<R>; 2],
}

/// What a bond does now.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Pull {
    /// Force on i [N]; j gets the opposite.
    pub force: [f64; 3],
    /// Elastic energy [J].
    pub elastic: f64,
    /// Moments on i and j about their centres [N·m].
    pub moment: [[f64; 3]; 2],
    /// Power that its dashpots take [W].
    pub power: f64,
    /// Largest tension at its rim, largest shear, and mean tension [Pa].
    pub stress: [f64; 3],
}

/// The same of several bonds.
pub struct Pulls<R> {
    /// See [`Pull`].
    pub force: V<R>,
    /// See there.
    pub elastic: R,
    /// See there.
    pub moment: [V<R>; 2],
    /// See there.
    pub power: R,
    /// See there.
    pub stress: [R; 3],
}

/// What bonds do.
#[inline(always)]
pub fn pulls<R: Lane>(springs: &SpringLanes<R>, ends: &Ends<R>) -> Pulls<R> {
    let (half, one) = (R::splat(0.5), R::splat(1.0));
    let [along, shear, bending, twist] = springs.stiffness;
    let w = [springs.share, one - springs.share];
    let slid = shear * springs.length * springs.length;
    let tilt = [bending + slid * w[0] * w[0], bending + slid * w[1] * w[1], slid * w[0] * w[1] - bending];
    let [p_i, p_j, q] = tilt;
    let distance = ends.arm.dot(ends.arm).sqrt();
    let per_distance = one / distance;
    let n = ends.arm.scale(per_distance);
    let turn = [ends.turn[0].after(springs.reference), ends.turn[1]];
    let t = [turn[0].apply(springs.axis), turn[1].apply(springs.axis)];
    let open = distance - springs.length;
    let stretch = along * open;
    let c = [n.dot(t[0]), n.dot(t[1])];
    // Slopes of ½ P_i a_i² + ½ P_j a_j² + Q a_i·a_j by c: how the line of the centres is turned back, and the ends with it.
    let slope = [p_i * c[0] + q * c[1], p_j * c[1] + q * c[0]];
    let both = t[0].scale(slope[0]) + t[1].scale(slope[1]);
    let across = (both - n.scale(n.dot(both))).scale(per_distance);
    let bent = [t[0].cross(n.scale(slope[0]) - t[1].scale(q)), t[1].cross(n.scale(slope[1]) - t[0].scale(q))];
    let (turned, about) = twisted(turn, springs.axis);
    let torque = about.scale(twist * turned[0] * turned[1]);
    let mixed = t[0].dot(t[1]) - c[0] * c[1];
    let elastic = half * (stretch * open + p_i * (one - c[0] * c[0]) + p_j * (one - c[1] * c[1]))
        + q * mixed
        + half * twist * turned[0] * turned[0];
    let stress = stress(springs, stretch, bent, w, twist * turned[0], per_distance);
    let mut found = Pulls {
        force: across - n.scale(stretch),
        elastic,
        moment: [bent[0] - torque, bent[1] + torque],
        power: R::splat(0.0),
        stress,
    };
    let damped = springs.lag.gt(R::splat(0.0));
    if R::any(damped) {
        let (force, moment, power) = slowed(springs, tilt, ends, n, per_distance);
        found.force = V::select(damped, found.force + force, found.force);
        for (own, by) in found.moment.iter_mut().zip(moment) {
            *own = V::select(damped, *own + by, *own);
        }
        found.power = R::select(damped, power, found.power);
    }
    found
}

/// Force and moments of the dashpots, and the power that they take.
#[inline(always)]
fn slowed<R: Lane>(
    springs: &SpringLanes<R>,
    [p_i, p_j, q]: [R; 3],
    ends: &Ends<R>,
    n: V<R>,
    per_distance: R,
) -> (V<R>, [V<R>; 2], R) {
    let lag = springs.lag;
    let (along, twist) = (springs.stiffness[0] * lag, springs.stiffness[3] * lag);
    let (p_i, p_j, q) = (p_i * lag, p_j * lag, q * lag);
    let line = n.cross(ends.velocity).scale(per_distance);
    let rate = [
        ends.spin[0] - n.scale(n.dot(ends.spin[0])) - line,
        ends.spin[1] - n.scale(n.dot(ends.spin[1])) - line,
    ];
    let stretching = n.dot(ends.velocity);
    let twisting = n.dot(ends.spin[0] - ends.spin[1]);
    let against = [rate[0].scale(p_i) + rate[1].scale(q), rate[1].scale(p_j) + rate[0].scale(q)];
    let torque = n.scale(twist * twisting);
    let force =
        V::zero() - n.cross(against[0] + against[1]).scale(per_distance) - n.scale(along * stretching);
    let power = along * stretching * stretching
        + twist * twisting * twisting
        + against[0].dot(rate[0])
        + against[1].dot(rate[1]);
    (force, [V::zero() - against[0] - torque, torque - against[1]], power)
}

/// σ = F_n/A + β |M| r/I at the worse end, τ = |F_t|/A + β |M_t| r/J, and F_n/A.
#[inline(always)]
fn stress<R: Lane>(
    springs: &SpringLanes<R>,
    stretch: R,
    bent: [V<R>; 2],
    w: [R; 2],
    torque: R,
    per_distance: R,
) -> [R; 3] {
    // F_t L of the section, across both arms.
    let both = bent[0] + bent[1];
    let at = springs.at_section;
    let there = [bent[0] - both.scale(w[0] * at), bent[1] - both.scale(w[1] * at)];
    let most = there[0].dot(there[0]).max(there[1].dot(there[1])).sqrt();
    let (pulled, shear) = (stretch * springs.per_area, both.dot(both).sqrt() * per_distance);
    let twisted = torque.max(R::splat(0.0) - torque) * springs.rim * R::splat(0.5);
    [pulled + most * springs.rim, shear * springs.per_area + twisted, pulled]
}

/// By how much i is turned against j about the bond, as 2 sin(φ/2) and cos(φ/2), and what φ grows by when i is turned.
///
/// ```text
/// q = q_j⁻¹ q_i = (w, v),  s = v·N:   tan(φ/2) = s/w,   ∂φ = q_i (w² N + w N × v + s v)/(w² + s²)
/// ```
#[inline(always)]
fn twisted<R: Lane>(turn: [Turn<R>; 2], axis: V<R>) -> ([R; 2], V<R>) {
    let Turn { w, v } = turn[1].inverse().after(turn[0]);
    let s = v.dot(axis);
    let per_square = R::splat(1.0) / (w * w + s * s).max(R::splat(f64::MIN_POSITIVE));
    let gradient = (axis.scale(w * w) + axis.cross(v).scale(w) + v.scale(s)).scale(per_square);
    let root = per_square.sqrt();
    // q and −q are the same turn.
    let root = R::select(R::splat(0.0).gt(w), -root, root);
    ([R::splat(2.0) * s * root, w * root], turn[0].apply(gradient))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::bonds::springs::packed;
    use crate::setup::BondNumbers;
    use geom::Vec3;
    use nalgebra::UnitQuaternion;
    use std::f64::consts::PI;

    /// Springs of every sort, with the section nearer to one end.
    fn numbers() -> BondNumbers {
        BondNumbers {
            axis: Vec3::new(2.0, -1.0, 0.5).normalize(),
            reference: UnitQuaternion::identity(),
            size: [0.02, 0.004],
            share: 0.3,
            stiffness: [7e3, 4e3, 0.03, 0.02],
            lag: 0.0,
            moments: 0.7,
            at_ends: false,
            strength: [1.0, 1.0, 0.0],
            replaces_contact: false,
        }
    }

    /// Two particles, and what a bond of this lag does.
    struct Two {
        arm: Vec3,
        velocity: Vec3,
        spin: [Vec3; 2],
        turn: [UnitQuaternion<f64>; 2],
    }

    impl Two {
        fn pull(&self, lag: f64) -> Pull {
            let lane = |v: &Vec3| V::new(v.x, v.y, v.z);
            let turn = |q: &UnitQuaternion<f64>| Turn::of(q.coords.into());
            let springs = SpringLanes::of(packed(&BondNumbers { lag, ..numbers() }).map(|row| row.0));
            let ends = Ends {
                arm: lane(&self.arm),
                velocity: lane(&self.velocity),
                spin: self.spin.each_ref().map(lane),
                turn: self.turn.each_ref().map(turn),
            };
            let found: Pulls<f64> = pulls(&springs, &ends);
            let array = |v: V<f64>| [v.x, v.y, v.z];
            let Pulls { elastic, power, stress, .. } = found;
            Pull { force: array(found.force), elastic, moment: found.moment.map(array), power, stress }
        }
    }

    fn turn(x: f64, y: f64, z: f64) -> UnitQuaternion<f64> {
        crate::space::rotation::spun(&Vec3::new(x, y, z))
    }

    fn bent() -> Two {
        let arm = Vec3::new(0.0185, -0.0085, 0.006);
        let spin = [Vec3::zeros(); 2];
        Two { arm, velocity: Vec3::zeros(), spin, turn: [turn(0.05, 0.1, -0.07), turn(-0.09, 0.04, 0.11)] }
    }

    #[test]
    fn force_and_moments_are_the_slope_of_the_energy() {
        let h = 1e-6;
        let pull = bent().pull(0.0);
        for axis in 0..3 {
            let mut step = Vec3::zeros();
            step[axis] = h;
            let slope = |to: &dyn Fn(f64) -> Two| {
                (to(1.0).pull(0.0).elastic - to(-1.0).pull(0.0).elastic) / (2.0 * h)
            };
            let push = slope(&|s| Two { arm: bent().arm + step * s * 1e-2, ..bent() }) * 1e2;
            assert!((push + pull.force[axis]).abs() < 1e-7 * stiff(&pull.force), "force {axis}");
            for e in 0..2 {
                let turned = slope(&|s| {
                    let mut ends = bent();
                    ends.turn[e] = crate::space::rotation::spun(&(step * s)) * ends.turn[e];
                    ends
                });
                let m = pull.moment[e];
                assert!(
                    (turned + m[axis]).abs() < 1e-7 * stiff(&m),
                    "moment {e} {axis}: {turned} {}",
                    m[axis]
                );
            }
        }
    }

    fn stiff(v: &[f64; 3]) -> f64 {
        v.iter().map(|x| x.abs()).sum()
    }

    #[test]
    fn angular_momentum_is_kept_with_dashpots_and_without() {
        for lag in [0.0, 1e-3] {
            let spin = [Vec3::new(3.0, -1.0, 2.0), Vec3::new(-2.0, 4.0, 1.0)];
            let ends = Two { velocity: Vec3::new(0.1, 0.3, -0.2), spin, ..bent() };
            let pull = ends.pull(lag);
            let [a, b] = pull.moment.map(Vec3::from);
            let sum = a + b + ends.arm.cross(&Vec3::from(pull.force));
            assert!(sum.norm() < 1e-14 * (a.norm() + b.norm()), "{lag}: {sum}");
            assert!(pull.power >= 0.0 && (pull.power > 0.0) == (lag > 0.0));
        }
    }

    #[test]
    fn dashpots_take_the_power_that_they_say() {
        let spin = [Vec3::new(3.0, -1.0, 2.0), Vec3::new(-2.0, 4.0, 1.0)];
        let ends = Two { velocity: Vec3::new(0.1, 0.3, -0.2), spin, ..bent() };
        let (with, without) = (ends.pull(1e-3), ends.pull(0.0));
        let of = |p: &Pull| {
            Vec3::from(p.force).dot(&ends.velocity)
                + Vec3::from(p.moment[0]).dot(&spin[0])
                + Vec3::from(p.moment[1]).dot(&spin[1])
        };
        let taken = of(&without) - of(&with);
        assert!((taken / with.power - 1.0).abs() < 1e-12, "{taken} {}", with.power);
    }

    #[test]
    fn turned_as_a_whole_it_does_nothing() {
        let all = turn(1.3, -0.4, 2.1);
        let ends = Two { arm: all * numbers().axis * numbers().size[0], turn: [all; 2], ..bent() };
        let pull = ends.pull(0.0);
        assert!(stiff(&pull.force) < 1e-9 && stiff(&pull.moment[0]) < 1e-11, "{pull:?}");
    }

    /// F_t and M at the section, by statics of one half: what acts on i, moved to the section. Angles are small, because stress is that of small ones.
    #[test]
    fn stress_is_that_at_the_section() {
        let arm = numbers().axis * 0.020_02 + Vec3::new(1e-5, 2e-5, -1e-5);
        let ends = Two { arm, turn: [turn(1e-3, 2e-3, -1.4e-3), turn(-1.8e-3, 8e-4, 2.2e-3)], ..bent() };
        let pull = ends.pull(0.0);
        let n = arm.normalize();
        let force = Vec3::from(pull.force);
        let tension = -force.dot(&n);
        let shear = force + n * tension;
        let at = Vec3::from(pull.moment[0]) + (n * (0.3 * arm.norm())).cross(&force);
        let (twist, bending) = (at.dot(&n), at - n * at.dot(&n));
        let area = PI * 0.004 * 0.004;
        let rim = 0.7 * 4.0 / (area * 0.004);
        let expected = [
            tension / area + bending.norm() * rim,
            shear.norm() / area + twist.abs() * 0.5 * rim,
            tension / area,
        ];
        for (found, expected) in pull.stress.iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 5e-3, "{:?} {expected:?}", pull.stress);
        }
    }
}
