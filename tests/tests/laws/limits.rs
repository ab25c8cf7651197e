//! Oblique impacts have a limit as the step falls, and it is that of the equations of motion, solved here by themselves.
//!
//! ```text
//! m δ̈ = −F_n,   m v̇ = F_t,   I ω̇ = −(r − δ) F_t + M
//! F_t = −(k ξ + c s), cut to μ F_n;   s = v − (r − δ) ω;   ξ̇ = s, less (|k ξ + c s| − μ F_n)/c where it is cut
//! k ξ stays as k grows, ξ as k falls;   M = −μ_r r F_n ω/|ω|, less where that is more than it takes to hold ω = 0
//! ```

use crate::simulation;
use dem::effects::{Elastic, damping_ratio};
use dem::setup::*;
use dem::{Setup, mass};
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{Law, empty, grain, particles, plane, rolling, run_until, with_friction};

const PART: &str = "Friction and rolling";
const SLIDING: Case =
    case(PART, "240 oblique impacts against their own equations: v_t′ and r ω′, over the speed, by step");
const ROLLING: Case =
    case(PART, "48 oblique impacts with constant rolling resistance: v_t′ and r ω′, over the speed, by step");
const DEFAULT: Case = case(PART, "the same at the default step");

const RADIUS: f64 = 0.01;
const STIFFNESS: f64 = 1e4;

/// An impact on a plane: speeds [m/s].
#[derive(Debug, Clone, Copy)]
struct Impact {
    hertz: bool,
    restitution: f64,
    friction: f64,
    rolling: f64,
    normal: f64,
    along: f64,
    /// r ω.
    spin: f64,
}

/// v and r ω after it [m/s].
type Rebound = [f64; 2];

impl Impact {
    fn speed(&self) -> f64 {
        self.normal.hypot(self.along)
    }

    fn law(&self) -> Law {
        if self.hertz {
            return Law::Hertz;
        }
        Law::Hooke { stiffness: STIFFNESS, tangential_ratio: Some(2.0 / 7.0) }
    }

    fn setup(&self) -> Setup {
        let mut setup = with_friction(empty(self.law(), self.restitution), self.friction);
        if self.rolling > 0.0 {
            setup.contacts.iter_mut().for_each(|c| rolling(c, self.rolling, "constant"));
        }
        setup.walls = vec![plane(Vec3::z())];
        let velocity = Vec3::new(self.along, 0.0, -self.normal);
        let spin = Vec3::new(0.0, self.spin / RADIUS, 0.0);
        let above = Vec3::new(0.0, 0.0, RADIUS + 1e-5 * self.normal);
        setup.particles = vec![Particle { velocity, spin, ..grain(1, above) }];
        setup
    }

    /// By the engine, at a share of the critical step.
    fn found(&self, safety: f64) -> Rebound {
        let mut setup = self.setup();
        setup.step = Step::Auto(safety);
        let mut sim = simulation(setup);
        loop {
            let soon = sim.time() + 1e-4;
            run_until(&mut sim, soon);
            let p = particles(&mut sim)[0];
            if p.velocity.z > 0.0 && p.position.z > RADIUS {
                return [p.velocity.x, RADIUS * p.spin.y];
            }
        }
    }

    /// S, the elastic force, and c of the normal law.
    fn spring(&self, overlap: f64, elastic: Elastic, m: f64) -> [f64; 3] {
        let gamma = damping_ratio(self.restitution);
        if !self.hertz {
            return [STIFFNESS, STIFFNESS * overlap, gamma * (STIFFNESS * m).sqrt()];
        }
        let s = 2.0 * elastic.modulus * (RADIUS * overlap).sqrt();
        [s, s * overlap * (2.0 / 3.0), gamma * (5.0f64 / 6.0).sqrt() * (s * m).sqrt()]
    }

    /// By their own equations, in steps that fall towards first touch, where the stiffness of Hertz changes fastest.
    fn exact(&self, steps: f64) -> Rebound {
        let setup = self.setup();
        let elastic = Elastic::of(&setup.materials[0], &setup.materials[1]);
        let q = if self.hertz { elastic.tangential_ratio } else { 2.0 / 7.0 };
        let m = mass(RADIUS, 2500.0);
        let inertia = 0.4 * m * RADIUS * RADIUS;
        let gamma = damping_ratio(self.restitution);
        let [deep, ..] = self.spring(0.02 * RADIUS, elastic, m);
        let h = (m / deep).sqrt() / steps;
        let (mut delta, mut rate, mut v, mut w, mut held) =
            (0.5 * h * self.normal, self.normal, self.along, self.spin / RADIUS, 0.0f64);
        let mut stiffness = q * self.spring(delta, elastic, m)[0];
        while delta > 0.0 {
            let [s, elastic_force, c] = self.spring(delta, elastic, m);
            let normal = elastic_force + c * rate;
            let (k, dashpot) = (q * s, gamma * (q * s * m).sqrt());
            held *= (k / stiffness).min(1.0);
            stiffness = k;
            let arm = RADIUS - delta;
            let slip = v - arm * w;
            let cap = self.friction * normal.max(0.0);
            let trial = held + 0.5 * h * k * slip + dashpot * slip;
            // The slider gives way such that spring and dashpot bear the cap: exactly, over the step.
            let beyond = (trial.abs() - cap).max(0.0) * trial.signum();
            let gives = if dashpot > 0.0 { 1.0 - (-k * h / dashpot).exp() } else { 1.0 };
            held += h * k * slip - beyond * gives;
            let force = beyond - trial;
            let moment = -arm * force;
            let most = self.rolling * RADIUS * normal.max(0.0);
            let torque = -(moment + inertia * w / h).clamp(-most, most);
            rate -= normal / m * h;
            v += force / m * h;
            w += (moment + torque) / inertia * h;
            delta += rate * h;
        }
        [v, RADIUS * w]
    }
}

/// Numbers between 0 and 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn impact(&mut self, n: u32) -> Impact {
        let angle = (5.0 + 80.0 * self.next()).to_radians();
        Impact {
            hertz: n.is_multiple_of(2),
            restitution: [0.3, 0.5, 0.7, 0.9, 1.0][(n / 2 % 5) as usize],
            friction: 0.1 + 0.5 * self.next(),
            rolling: 0.0,
            normal: angle.cos(),
            along: angle.sin(),
            spin: 2.0 * self.next() - 1.0,
        }
    }
}

/// Worst difference over the speed at each step, and the impact.
fn worst(impacts: &[Impact], steps: &[f64]) -> Vec<(f64, f64)> {
    let exact: Vec<Rebound> = impacts.iter().map(|i| i.exact(40_000.0)).collect();
    let off = |safety: f64| {
        let each = impacts.iter().zip(&exact).map(|(i, e)| {
            let found = i.found(safety);
            (found[0] - e[0]).abs().max((found[1] - e[1]).abs()) / i.speed()
        });
        (safety, each.fold(0.0, f64::max))
    };
    steps.iter().map(|s| off(*s)).collect()
}

#[test]
fn sliding_friction_has_the_limit_of_its_equations() {
    let mut random = Random(3);
    let impacts: Vec<Impact> = (0..240).map(|n| random.impact(n)).collect();
    let found = worst(&impacts, &[0.2, 0.1, 0.05, 0.02, 0.01]);
    SLIDING.order("hooke and hertz, e = 0.3 … 1", &found, 1.0, 0.1);
    SLIDING.within("0.01 of the critical step", found[4].1, "–", 1e-3);
}

#[test]
fn constant_rolling_resistance_has_the_limit_of_its_equations() {
    let mut random = Random(5);
    let mut of = |n| Impact { rolling: 0.05 + 0.3 * random.next(), ..random.impact(n) };
    let impacts: Vec<Impact> = (0..48).map(&mut of).collect();
    let found = worst(&impacts, &[0.5, 0.2, 0.1, 0.05, 0.02, 0.01]);
    DEFAULT.within("half the critical step", found[0].1, "–", 1e-2);
    ROLLING.order("hooke and hertz, e = 0.3 … 1", &found[1..], 1.0, 0.1);
    ROLLING.within("0.01 of the critical step", found[5].1, "–", 1e-3);
}
