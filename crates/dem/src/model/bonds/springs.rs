//! One bond: springs between two particles that depend on their positions and turns alone.
//!
//! ```text
//! U = ½ k_n (d − L)² + ½ k_s γ² + ½ k_b |a_i − a_j|² + ½ k_t (2 sin φ/2)²,      γ = L (w_i a_i + w_j a_j)
//! ```
//!
//! a: n × t, by which the end of the bond, fixed in its particle, is turned out of the line of the centres n; w: distance of the section from both centres over
//! L, so that γ is how far the two halves have slid past each other there; φ: the turn of one end against the other about the bond. Forces and moments are the
//! gradient of U: a bond that is turned as a whole does nothing, however often, and momentum and angular momentum are kept to rounding. Dashpots are the
//! same springs fed by rates.
//!
//! All kinds of bonds are such springs ([`super::kinds`]). Of a beam, w = ½ and k_s = 12 k_b/L²: 2 E I/L (a_i² + a_i·a_j + a_j²).

use crate::setup::BondNumbers;
use geom::Vec3;
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Two bonded particles.
pub struct Ends {
    /// Centre of i relative to j [m].
    pub arm: Vec3,
    /// Velocity of i less that of j [m/s].
    pub velocity: Vec3,
    /// Angular velocities of i and j [rad/s].
    pub spin: [Vec3; 2],
    /// How both have turned since they were bonded.
    pub turn: [UnitQuaternion<f64>; 2],
}

/// What a bond does now.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Pull {
    /// Force on i [N]; j gets the opposite.
    pub force: [f64; 3],
    /// Moments on i and j about their centres [N·m].
    pub moment: [[f64; 3]; 2],
    /// Elastic energy [J].
    pub elastic: f64,
    /// Power that its dashpots take [W].
    pub power: f64,
    /// Largest tension at its rim, largest shear, and mean tension [Pa].
    pub stress: [f64; 3],
}

/// The springs of one bond, and what makes stress of what they bear.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Springs {
    /// The numbers that they are made of.
    pub numbers: BondNumbers,
    /// P_i, P_j and Q of U = ½ P_i a_i² + ½ P_j a_j² + Q a_i·a_j [N·m/rad].
    tilt: [f64; 3],
    /// 1/A [1/m²], and β r/I and β r/J [1/m³], so that no step divides.
    section: [f64; 3],
    /// Share of the shear force's lever that the moment at each centre is less than that at the section [–].
    levers: [f64; 2],
}

impl Springs {
    /// Of these numbers.
    pub fn new(numbers: BondNumbers) -> Springs {
        let [length, radius] = numbers.size;
        let [_, shear, bending, _] = numbers.stiffness;
        let (w, slid) = ([numbers.share, 1.0 - numbers.share], shear * length * length);
        let tilt = [bending + slid * w[0] * w[0], bending + slid * w[1] * w[1], slid * w[0] * w[1] - bending];
        let area = PI * radius * radius;
        let rim = numbers.moments * 4.0 / (area * radius);
        let levers = if numbers.at_ends { [0.0; 2] } else { w };
        Springs { numbers, tilt, section: [1.0 / area, rim, 0.5 * rim], levers }
    }

    /// What they do.
    pub fn pull(&self, ends: &Ends) -> Pull {
        let [along, _, _, twist] = self.numbers.stiffness;
        let [p_i, p_j, q] = self.tilt;
        let distance = ends.arm.norm();
        let per_distance = 1.0 / distance;
        let n = ends.arm * per_distance;
        let t = [0, 1].map(|e| ends.turn[e] * self.numbers.axis);
        let open = distance - self.numbers.size[0];
        let stretch = along * open;
        let c = t.map(|t| n.dot(&t));
        // Of ½ P_i a_i² + ½ P_j a_j² + Q a_i·a_j by n: how the line of the centres is turned back.
        let slope = t[0] * (p_i * c[0] + q * c[1]) + t[1] * (p_j * c[1] + q * c[0]);
        let across = (slope - n * n.dot(&slope)) * per_distance;
        let moment = |own: usize, p: f64| {
            let other = 1 - own;
            t[own].cross(&(n * (p * c[own] + q * c[other]) - t[other] * q))
        };
        let (turned, about) = twisted(&ends.turn, &self.numbers.axis);
        let torque = about * (twist * turned[0] * turned[1]);
        let mixed = t[0].dot(&t[1]) - c[0] * c[1];
        let elastic = 0.5 * (stretch * open + p_i * (1.0 - c[0] * c[0]) + p_j * (1.0 - c[1] * c[1]))
            + q * mixed
            + 0.5 * twist * turned[0] * turned[0];
        let bent = [moment(0, p_i), moment(1, p_j)];
        let stress = self.stress(stretch, &bent, twist * turned[0], per_distance);
        let mut pull = Pull { elastic, stress, ..Pull::default() };
        let (mut force, mut moments) = (across - n * stretch, [bent[0] - torque, bent[1] + torque]);
        if self.numbers.lag > 0.0 {
            let slow = self.slow(ends, &n, per_distance);
            force += slow.0;
            moments = [0, 1].map(|e| moments[e] + slow.1[e]);
            pull.power = slow.2;
        }
        pull.force = force.into();
        pull.moment = moments.map(Into::into);
        pull
    }

    /// Force and moments of the dashpots, and the power that they take.
    fn slow(&self, ends: &Ends, n: &Vec3, per_distance: f64) -> (Vec3, [Vec3; 2], f64) {
        let lag = self.numbers.lag;
        let [along, _, _, twist] = self.numbers.stiffness.map(|k| k * lag);
        let [p_i, p_j, q] = self.tilt.map(|k| k * lag);
        let line = n.cross(&ends.velocity) * per_distance;
        let across = |w: &Vec3| w - n * n.dot(w);
        let rate = ends.spin.map(|w| across(&w) - line);
        let stretching = n.dot(&ends.velocity);
        let twisting = n.dot(&(ends.spin[0] - ends.spin[1]));
        let bent = [-(rate[0] * p_i + rate[1] * q), -(rate[1] * p_j + rate[0] * q)];
        let torque = n * (twist * twisting);
        let force = n.cross(&(bent[0] + bent[1])) * per_distance - n * (along * stretching);
        let power = along * stretching * stretching + twist * twisting * twisting
            - bent[0].dot(&rate[0])
            - bent[1].dot(&rate[1]);
        (force, [bent[0] - torque, bent[1] + torque], power)
    }

    /// σ = F_n/A + β |M| r/I at the worse end, τ = |F_t|/A + β |M_t| r/J, and F_n/A.
    fn stress(&self, stretch: f64, bent: &[Vec3; 2], torque: f64, per_distance: f64) -> [f64; 3] {
        let [per_area, rim, twisted_rim] = self.section;
        // F_t L of the section, across both arms.
        let both = bent[0] + bent[1];
        let there = [0, 1].map(|e| (bent[e] - both * self.levers[e]).norm_squared());
        let most = there[0].max(there[1]).sqrt();
        let (pulled, shear) = (stretch * per_area, both.norm() * per_distance);
        [pulled + most * rim, shear * per_area + torque.abs() * twisted_rim, pulled]
    }
}

/// By how much i is turned against j about the bond, as 2 sin(φ/2) and cos(φ/2), and what φ grows by when i is turned.
///
/// ```text
/// q = q_j⁻¹ q_i = (w, v),  s = v·N:   tan(φ/2) = s/w,   ∂φ = q_i (w² N + w N × v + s v)/(w² + s²)
/// ```
fn twisted(turn: &[UnitQuaternion<f64>; 2], axis: &Vec3) -> ([f64; 2], Vec3) {
    let q = turn[1].inverse() * turn[0];
    let (w, v) = (q.w, Vec3::new(q.i, q.j, q.k));
    let s = v.dot(axis);
    let per_square = 1.0 / (w * w + s * s).max(f64::MIN_POSITIVE);
    let gradient = (axis * (w * w) + axis.cross(&v) * w + v * s) * per_square;
    // q and −q are the same turn.
    let root = per_square.sqrt().copysign(w);
    ([2.0 * s * root, w * root], turn[0] * gradient)
}

#[cfg(test)]
mod tests {
    use super::*;

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

    fn springs(lag: f64) -> Springs {
        Springs::new(BondNumbers { lag, ..numbers() })
    }

    fn turn(x: f64, y: f64, z: f64) -> UnitQuaternion<f64> {
        crate::space::rotation::spun(&Vec3::new(x, y, z))
    }

    fn bent() -> Ends {
        let arm = Vec3::new(0.0185, -0.0085, 0.006);
        let spin = [Vec3::zeros(); 2];
        Ends { arm, velocity: Vec3::zeros(), spin, turn: [turn(0.05, 0.1, -0.07), turn(-0.09, 0.04, 0.11)] }
    }

    #[test]
    fn force_and_moments_are_the_slope_of_the_energy() {
        let (springs, h) = (springs(0.0), 1e-6);
        let pull = springs.pull(&bent());
        for axis in 0..3 {
            let mut step = Vec3::zeros();
            step[axis] = h;
            let slope = |to: &dyn Fn(f64) -> Ends| {
                (springs.pull(&to(1.0)).elastic - springs.pull(&to(-1.0)).elastic) / (2.0 * h)
            };
            let push = slope(&|s| Ends { arm: bent().arm + step * s * 1e-2, ..bent() }) * 1e2;
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
            let ends = Ends { velocity: Vec3::new(0.1, 0.3, -0.2), spin, ..bent() };
            let pull = springs(lag).pull(&ends);
            let [a, b] = pull.moment.map(Vec3::from);
            let sum = a + b + ends.arm.cross(&Vec3::from(pull.force));
            assert!(sum.norm() < 1e-14 * (a.norm() + b.norm()), "{lag}: {sum}");
            assert!(pull.power >= 0.0 && (pull.power > 0.0) == (lag > 0.0));
        }
    }

    #[test]
    fn dashpots_take_the_power_that_they_say() {
        let spin = [Vec3::new(3.0, -1.0, 2.0), Vec3::new(-2.0, 4.0, 1.0)];
        let ends = || Ends { velocity: Vec3::new(0.1, 0.3, -0.2), spin, ..bent() };
        let (with, without) = (springs(1e-3).pull(&ends()), springs(0.0).pull(&ends()));
        let of = |p: &Pull| {
            Vec3::from(p.force).dot(&ends().velocity)
                + Vec3::from(p.moment[0]).dot(&spin[0])
                + Vec3::from(p.moment[1]).dot(&spin[1])
        };
        let taken = of(&without) - of(&with);
        assert!((taken / with.power - 1.0).abs() < 1e-12, "{taken} {}", with.power);
    }

    #[test]
    fn turned_as_a_whole_it_does_nothing() {
        let (springs, all) = (springs(0.0), turn(1.3, -0.4, 2.1));
        let ends = Ends { arm: all * numbers().axis * numbers().size[0], turn: [all; 2], ..bent() };
        let pull = springs.pull(&ends);
        assert!(stiff(&pull.force) < 1e-9 && stiff(&pull.moment[0]) < 1e-11, "{pull:?}");
    }

    /// F_t and M at the section, by statics of one half: what acts on i, moved to the section. Angles are small, because stress is that of small ones.
    #[test]
    fn stress_is_that_at_the_section() {
        let arm = numbers().axis * 0.020_02 + Vec3::new(1e-5, 2e-5, -1e-5);
        let ends = Ends { arm, turn: [turn(1e-3, 2e-3, -1.4e-3), turn(-1.8e-3, 8e-4, 2.2e-3)], ..bent() };
        let pull = springs(0.0).pull(&ends);
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
