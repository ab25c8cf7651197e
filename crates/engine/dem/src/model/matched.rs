//! Damping matched to the time step: so that an impact in finite steps has the restitution asked for, on average over where in a step it begins.
//!
//! ```text
//! e(x, γ₁, γ₂) = e  at x = x_c/2 and x = x_c        x = ω Δt of the impact, x_c: its critical one without friction
//!                   at x = x_c/5 and x_c/2 with e = 1
//! ```
//!
//! The impact is that of the engine: its effects, its averaging over a kick, its integration. It depends on x alone: ω² = k/m* (Hooke), S/m* at the deepest
//! overlap without damping (Hertz). What its dashpot books is matched at the same two x: β₁ and β₂ such that it is the energy that the impact loses. Between and below both points γ₁ and γ₂ leave less than 0.1 % (docs/theory/time-step.md).

use crate::model::step_cause::root;
use crate::setup::Sampling;
use laws::contact::average;
use laws::effects::{Contact, ContactLaw, Damping, Effect, Hertz, Hooke, Response, damping_ratio};
use laws::simd::V;

/// Phases of the step in which the impact begins.
const PHASES: usize = 32;
/// Steps at which a damped impact is matched, over the critical one [–].
const DAMPED: [f64; 2] = [0.5, 1.0];
/// The same of an impact without damping, at the steps that scenes get by default.
const ELASTIC: [f64; 2] = [0.2, 0.5];
/// Below it a rebound is too slow for a relative error to matter [–].
const LEAST: f64 = 0.02;
/// Steps of Newton; they converge in four.
const NEWTON: usize = 8;
/// Steps after which an impact counts as over.
const LONGEST: usize = 100_000;

/// What is matched, of a contact law: in powers of x².
#[derive(Debug, Clone, Copy, PartialEq)]
struct Matched {
    /// γ₁ and γ₂ [–].
    force: [f64; 2],
    /// β₁ and β₂ [–].
    loss: [f64; 2],
}

impl Matched {
    const NOTHING: Matched = Matched { force: [0.0; 2], loss: [0.0; 2] };

    /// Of a contact law; nothing where it has no dashpot of a restitution.
    fn of(law: &ContactLaw) -> Matched {
        let known = Shape::of(law).zip(law.number("restitution"));
        known.map_or(Matched::NOTHING, |(shape, e)| shape.match_to(e))
    }

    /// In steps of `dt` [s].
    fn damping(self, restitution: f64, dt: f64) -> Damping {
        let powers = |[first, second]: [f64; 2]| [first * dt * dt, second * dt.powi(4)];
        let [first, second] = powers(self.force);
        Damping { first, second, booked: powers(self.loss), ..Damping::exact(restitution) }
    }
}

/// Damping of a contact law in steps of `dt` [s].
pub fn damping(law: &ContactLaw, sampling: Sampling, dt: f64) -> Damping {
    let matched = if sampling == Sampling::Sampled { Matched::NOTHING } else { Matched::of(law) };
    matched.damping(law.number("restitution").unwrap_or(f64::NAN), dt)
}

/// γ₁ and γ₂ of a contact law [–]; 0 where there is nothing to match.
pub fn coefficients(law: &ContactLaw) -> [f64; 2] {
    Matched::of(law).force
}

/// How a normal law stiffens.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    /// Not at all.
    Linear,
    /// S ∝ √δ.
    Hertz,
}

/// 4/3 E* √R* = 1.
const MODULUS: f64 = 0.75;

impl Shape {
    /// Of a law with a dashpot.
    fn of(law: &ContactLaw) -> Option<Shape> {
        match law.model("law")? {
            "hooke" => Some(Shape::Linear),
            "hertz" | "jkr" => Some(Shape::Hertz),
            _ => None,
        }
    }

    fn match_to(self, restitution: f64) -> Matched {
        let gamma = damping_ratio(restitution);
        if !(LEAST..=1.0).contains(&restitution) {
            return Matched::NOTHING;
        }
        let most = root(4.0, 4.0 * gamma);
        let at = if gamma == 0.0 { ELASTIC } else { DAMPED };
        let rebounds = |matched| at.map(|share| self.rebounds(restitution, share * most, matched));
        let force =
            solve(|force| rebounds(Matched { force, ..Matched::NOTHING }).map(|r| r.miss(restitution)));
        if gamma == 0.0 {
            return Matched { force, ..Matched::NOTHING };
        }
        let loss = solve(|loss| rebounds(Matched { force, loss }).map(|r| r.unbooked()));
        Matched { force, loss }
    }

    /// Mean over all phases of the step; `pace` is x.
    fn rebounds(self, restitution: f64, pace: f64, matched: Matched) -> Rebound {
        let deepest = libm::pow(1.25, 0.4);
        let dt = match self {
            Shape::Linear => pace,
            Shape::Hertz => pace / (1.5 * deepest.sqrt()).sqrt(),
        };
        let damping = matched.damping(restitution, dt);
        let rebound = |k: usize| self.rebound(damping, dt, (k as f64 + 0.5) / PHASES as f64);
        let of = |number: fn(&Rebound) -> f64, all: &[Rebound]| {
            all.iter().map(number).sum::<f64>() / PHASES as f64
        };
        let all: Vec<Rebound> = (0..PHASES).map(rebound).collect();
        Rebound { speed: of(|r| r.speed, &all), lost: of(|r| r.lost, &all), booked: of(|r| r.booked, &all) }
    }

    /// The impact of a mass of 1 and a speed of 1 on a wall, in steps of `dt`; contact begins `phase` of a step after an instant.
    fn rebound(self, damping: Damping, dt: f64, phase: f64) -> Rebound {
        match self {
            Shape::Linear => rebound(&Hooke { stiffness: 1.0, damping }, dt, phase),
            Shape::Hertz => rebound(
                &Hertz { modulus: MODULUS, damping: damping.scaled((5.0f64 / 6.0).sqrt()) },
                dt,
                phase,
            ),
        }
    }
}

/// Where two functions of two numbers are zero, by Newton's method.
fn solve(miss: impl Fn([f64; 2]) -> [f64; 2]) -> [f64; 2] {
    let (mut p, tiny) = ([0.0; 2], 1e-5);
    for _ in 0..NEWTON {
        let here = miss(p);
        let [a, b] = [miss([p[0] + tiny, p[1]]), miss([p[0], p[1] + tiny])];
        let slope = |there: [f64; 2], k: usize| (there[k] - here[k]) / tiny;
        let [(ax, ay), (bx, by)] = [(slope(a, 0), slope(a, 1)), (slope(b, 0), slope(b, 1))];
        let area = ax * by - bx * ay;
        p[0] -= (here[0] * by - bx * here[1]) / area;
        p[1] -= (ax * here[1] - here[0] * ay) / area;
    }
    p
}

/// What an impact leaves.
#[derive(Debug, Clone, Copy)]
struct Rebound {
    /// Speed over that of the approach [–].
    speed: f64,
    /// Energy that is gone, and what the dashpot has booked, over that of the approach [–].
    lost: f64,
    booked: f64,
}

impl Rebound {
    /// Restitution over the one asked for, less 1.
    fn miss(self, restitution: f64) -> f64 {
        self.speed / restitution - 1.0
    }

    /// What is gone without being booked, over what is gone.
    fn unbooked(self) -> f64 {
        1.0 - self.booked / self.lost
    }
}

/// See [`Shape::rebound`].
fn rebound<E: Effect<History<f64> = ()>>(effect: &E, dt: f64, phase: f64) -> Rebound {
    let ahead = Sampling::Averaged.ahead(dt);
    // Overlap, the speed half a step before, and the acceleration of the step before.
    let (mut overlap, mut speed, mut last, mut booked) = (-dt * (2.0 + phase), 1.0, 0.0, 0.0);
    for _ in 0..LONGEST {
        let approach = speed + 0.5 * dt * last;
        let mut contact = head_on(overlap, approach, dt);
        let share = average(ahead, &mut contact, 0.0).unwrap_or(1.0);
        let mut response = Response::zero();
        effect.apply(&contact, share * dt, &mut (), &mut response);
        last = if contact.touching { -response.normal * share } else { 0.0 };
        booked += if contact.touching { response.dissipated[0] } else { 0.0 };
        speed += last * dt;
        overlap += speed * dt;
        if speed < 0.0 && overlap - speed * dt < 0.0 {
            break;
        }
    }
    Rebound { speed: -speed, lost: 1.0 - speed * speed, booked: 2.0 * booked }
}

/// The contact of a particle of mass and radius 1 with a flat wall.
fn head_on(overlap: f64, approach: f64, dt: f64) -> Contact<f64> {
    Contact {
        touching: overlap > 0.0,
        normal: V::zero(),
        overlap,
        present: overlap,
        partial: 0.0,
        before: overlap - approach * dt,
        radius: 1.0,
        smaller: 1.0,
        share: 1.0,
        share_before: 1.0,
        curvature: 0.0,
        mass: 1.0,
        inverse_mass: 1.0,
        approach,
        slip: V::zero(),
        spin: V::zero(),
        lever: 0.0,
        stiffness_last: 0.0,
        inertia: 0.4,
        turn: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Worst error over all phases, at the step that a scene gets by default: half the critical one without friction, a fifth with e = 1.
    #[test]
    fn an_impact_has_the_restitution_asked_for_at_every_phase_of_the_step() {
        for shape in [Shape::Linear, Shape::Hertz] {
            for e in [0.05, 0.1, 0.3, 0.5, 0.6, 0.8, 0.9, 0.95, 0.99, 1.0] {
                let matched = shape.match_to(e);
                for share in [0.02, 0.05, 0.1, 0.2, 0.35, 0.5] {
                    let pace = share * root(4.0, 4.0 * damping_ratio(e));
                    let rebound = shape.rebounds(e, pace, matched);
                    let miss = rebound.miss(e);
                    assert!(miss.abs() < 1e-3, "{shape:?}, e = {e}, {share}: {miss}, {matched:?}");
                }
            }
        }
    }

    /// The ledger's error of an impact is what the step makes, not that the dashpot is booked at the wrong instant: without matching it is up to 3 %.
    #[test]
    fn the_dashpot_books_what_the_impact_loses() {
        for shape in [Shape::Linear, Shape::Hertz] {
            for e in [0.1, 0.3, 0.5, 0.6, 0.8, 0.9, 0.95, 0.99] {
                let matched = shape.match_to(e);
                for share in [0.02, 0.05, 0.1, 0.2, 0.35, 0.5] {
                    let pace = share * root(4.0, 4.0 * damping_ratio(e));
                    let rebound = shape.rebounds(e, pace, matched);
                    let made = rebound.booked - rebound.lost;
                    assert!(made.abs() < 2e-3, "{shape:?}, e = {e}, {share}: {made}, {matched:?}");
                }
            }
        }
    }

    /// How the rebound spreads about its mean over the phases, with the damping of exact integration, and the order in which that falls. A
    /// dashpot that begins as δ^¼ leaves h^(5/4) in every sum over steps, not only in the first kick.
    #[test]
    fn the_dashpot_of_hertz_sets_the_order() {
        let spread = |shape: Shape, e: f64, dt: f64| {
            let out = |k: usize| {
                let (phase, dt) = ((k as f64 + 0.5) / 64.0, dt * (1.0 + 7e-4 * k as f64));
                shape.rebound(Damping::exact(e), dt, phase).speed
            };
            let mean = (0..64).map(out).sum::<f64>() / 64.0;
            ((0..64).map(|k| (out(k) - mean).powi(2)).sum::<f64>() / 64.0).sqrt()
        };
        for (shape, e, order) in
            [(Shape::Linear, 0.5, 2.0), (Shape::Hertz, 1.0, 2.5), (Shape::Hertz, 0.5, 1.25)]
        {
            let [coarse, fine] = [0.025, 0.006_25].map(|dt| spread(shape, e, dt));
            let found = (coarse / fine).log2() / 2.0;
            assert!((found - order).abs() < 0.15, "{shape:?}, e = {e}: {found}, expected {order}");
        }
    }
}
