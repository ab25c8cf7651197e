//! One bond: a round elastic beam between two centres.

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
    /// Largest tension at its rim, at either end, and largest shear [Pa].
    pub stress: [f64; 2],
}

/// A beam: its size, its springs, and what makes stress of what they bear.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Beam {
    /// Direction from j to i when it was made.
    pub axis: Vec3,
    /// L [m].
    pub length: f64,
    /// r [m].
    pub radius: f64,
    /// E A/L [N/m], E I/L and G J/L [N·m/rad]: against length, bending and twist.
    pub stiffness: [f64; 3],
    /// Dashpots over springs [s].
    pub lag: f64,
    /// 1/A [1/m²] and r/I [1/m³], so that no step divides.
    shares: [f64; 2],
}

impl Beam {
    /// Of a round section A = π r², I = π r⁴/4, J = 2 I.
    pub fn new(axis: Vec3, [length, radius]: [f64; 2], stiffness: [f64; 3], lag: f64) -> Beam {
        let area = PI * radius * radius;
        Beam { axis, length, radius, stiffness, lag, shares: [1.0 / area, 4.0 / (area * radius)] }
    }

    /// Of a size L, r [m] and moduli E, G [Pa], without dashpots.
    pub fn of_moduli(axis: Vec3, [length, radius]: [f64; 2], [young, shear]: [f64; 2]) -> Beam {
        let area = PI * radius * radius;
        let inertia = 0.25 * area * radius * radius;
        let stiffness = [young * area, young * inertia, shear * 2.0 * inertia].map(|k| k / length);
        Beam::new(axis, [length, radius], stiffness, 0.0)
    }

    /// What it does.
    ///
    /// ```text
    /// U = ½ E A/L (d − L)² + 2 E I/L (a_i² + a_i·a_j + a_j²) + ½ G J/L φ²
    /// ```
    ///
    /// a: n × t, by which the end of the beam, fixed in its particle, is turned out of the line of the centres n; φ: the turn of one end against the other
    /// about the beam. Forces and moments are the gradient of U, which depends on positions and rotations alone: a beam that is turned as a
    /// whole does nothing, however often, and momentum and angular momentum are kept to rounding. Dashpots are the same beam fed by rates.
    pub fn pull(&self, ends: &Ends) -> Pull {
        let distance = ends.arm.norm();
        let per_distance = 1.0 / distance;
        let n = ends.arm * per_distance;
        let t = [0, 1].map(|e| ends.turn[e] * self.axis);
        let [along, bend, twist] = self.stiffness;
        let stretch = along * (distance - self.length);
        let bend = 2.0 * bend;
        // Of a_i² + a_i·a_j + a_j² by n: how the line of the centres is turned back.
        let c = t.map(|t| n.dot(&t));
        let slope = t[0] * (2.0 * c[0] + c[1]) + t[1] * (2.0 * c[1] + c[0]);
        let across = (slope - n * n.dot(&slope)) * (bend * per_distance);
        let moment =
            |own: usize, other: usize| t[own].cross(&(n * (2.0 * c[own] + c[other]) - t[other])) * bend;
        let (angle, about) = twisted(&ends.turn, &self.axis);
        let torque = about * (twist * angle);
        let ends_turned = c.map(|c| 1.0 - c * c);
        let mixed = t[0].dot(&t[1]) - c[0] * c[1];
        let elastic = 0.5 * stretch * (distance - self.length)
            + bend * (ends_turned[0] + mixed + ends_turned[1])
            + 0.5 * twist * angle * angle;
        let bending = [moment(0, 1), moment(1, 0)];
        let stress = self.stress(stretch, &bending, twist * angle, per_distance);
        let mut pull = Pull { elastic, stress, ..Pull::default() };
        let (mut force, mut moments) = (across - n * stretch, [bending[0] - torque, bending[1] + torque]);
        if self.lag > 0.0 {
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
        let [along, bend, twist] = self.stiffness.map(|k| k * self.lag);
        let line = n.cross(&ends.velocity) * per_distance;
        let across = |w: &Vec3| w - n * n.dot(w);
        let rate = ends.spin.map(|w| across(&w) - line);
        let stretching = n.dot(&ends.velocity);
        let twisting = n.dot(&(ends.spin[0] - ends.spin[1]));
        let bent = [rate[0] * 2.0 + rate[1], rate[1] * 2.0 + rate[0]].map(|m| m * (-2.0 * bend));
        let torque = n * (twist * twisting);
        let force = n.cross(&(bent[0] + bent[1])) * per_distance - n * (along * stretching);
        let power = along * stretching * stretching + twist * twisting * twisting
            - bent[0].dot(&rate[0])
            - bent[1].dot(&rate[1]);
        (force, [bent[0] - torque, bent[1] + torque], power)
    }

    /// σ = F_n/A + |M| r/I at the worse end, τ = |F_t|/A + |M_t| r/J.
    fn stress(&self, stretch: f64, bending: &[Vec3; 2], torque: f64, per_distance: f64) -> [f64; 2] {
        let [per_area, rim] = self.shares;
        let most = bending[0].norm_squared().max(bending[1].norm_squared()).sqrt();
        let shear = (bending[0] + bending[1]).norm() * per_distance;
        [stretch * per_area + most * rim, shear * per_area + torque.abs() * 0.5 * rim]
    }
}

/// By how much i is turned against j about the beam [rad], and what this angle grows by when i is turned.
///
/// ```text
/// q = q_j⁻¹ q_i = (w, v),  s = v·N:   φ = 2 atan2(s, w),   ∂φ = q_i (w² N + w N × v + s v)/(w² + s²)
/// ```
fn twisted(turn: &[UnitQuaternion<f64>; 2], axis: &Vec3) -> (f64, Vec3) {
    let q = turn[1].inverse() * turn[0];
    let (mut w, mut v) = (q.w, Vec3::new(q.i, q.j, q.k));
    // q and −q are the same turn; of the two angles the smaller one is meant.
    if w < 0.0 {
        (w, v) = (-w, -v);
    }
    let s = v.dot(axis);
    let square = (w * w + s * s).max(f64::MIN_POSITIVE);
    let gradient = (axis * (w * w) + axis.cross(&v) * w + v * s) / square;
    (2.0 * angle_of(s, w), turn[0] * gradient)
}

/// atan(s/w) for w ≥ 0: for small angles its series, to the last digit.
fn angle_of(s: f64, w: f64) -> f64 {
    let x = s / w;
    let square = x * x;
    if square < 1e-4 {
        let rest = square * (0.2 - square * (1.0 / 7.0 - square * (1.0 / 9.0)));
        return x * (1.0 - square * (1.0 / 3.0 - rest));
    }
    libm::atan2(s, w)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_goes_on_as_the_angle() {
        for x in [0.0, 1e-9, 1e-4, -3e-3, 0.009_999_9, 0.010_000_1, -0.3, 2.0] {
            assert!((angle_of(x, 1.0) - f64::atan(x)).abs() <= 2.0 * f64::EPSILON * f64::atan(x).abs());
        }
        for x in [1e-9, 1e-4, 3e-3, 0.019_999_9, 0.020_000_1, 0.3] {
            let q = turn(x, 0.0, 0.0);
            assert!((q.i - (0.5 * x).sin()).abs() <= 2.0 * f64::EPSILON * q.i, "{x}");
            assert!((q.w - (0.5 * x).cos()).abs() <= f64::EPSILON, "{x}");
        }
    }

    fn beam() -> Beam {
        let axis = Vec3::new(2.0, -1.0, 0.5).normalize();
        Beam::of_moduli(axis, [0.02, 0.004], [3e6, 1e6])
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
        let (beam, h) = (beam(), 1e-6);
        let pull = beam.pull(&bent());
        for axis in 0..3 {
            let mut step = Vec3::zeros();
            step[axis] = h;
            let slope = |to: &dyn Fn(f64) -> Ends| {
                (beam.pull(&to(1.0)).elastic - beam.pull(&to(-1.0)).elastic) / (2.0 * h)
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
            let beam = Beam { lag, ..beam() };
            let spin = [Vec3::new(3.0, -1.0, 2.0), Vec3::new(-2.0, 4.0, 1.0)];
            let ends = Ends { velocity: Vec3::new(0.1, 0.3, -0.2), spin, ..bent() };
            let pull = beam.pull(&ends);
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
        let (with, without) = (Beam { lag: 1e-3, ..beam() }.pull(&ends()), beam().pull(&ends()));
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
        let beam = beam();
        let all = turn(1.3, -0.4, 2.1);
        let ends = Ends { arm: all * beam.axis * beam.length, turn: [all; 2], ..bent() };
        let pull = beam.pull(&ends);
        assert!(stiff(&pull.force) < 1e-9 && stiff(&pull.moment[0]) < 1e-11, "{pull:?}");
    }
}
