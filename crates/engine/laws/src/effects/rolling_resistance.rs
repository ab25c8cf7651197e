//! Rolling resistance (`rolling_model = "spring"`): a rotational spring and dashpot, capped by a torque proportional to the normal force.
//!
//! ```text
//! θ ← θ + ω_r Δt,   ω_r = (ω_i − ω_j) − its part along n
//! M = −k_r θ − c_r ω_r,  |M| ≤ μ_r R* F_p        F_p: what presses, as for sliding: with JKR F_n + 2 F_po, with cohesion F_n without its pull
//! k_r = 2.25 S (μ_r R*)²,   c_r = 2 η √(k_r I_r),  η = 0.3,  I_r = 7/5 m* R*²
//! ```
//!
//! Elastic–plastic spring–dashpot model: Ai, Chen, Rotter & Ooi (2011), Powder Technology 206, eqs 18–24,
//! doi:10.1016/j.powtec.2010.09.030, model C. Deviation: the dashpot acts within the cap and not beside it, so that
//! M never exceeds the cap.

use super::capped_spring::{CappedSpring, turned};
use super::numbers::numbers;
use super::{
    Contact, ContactEffect, ContactLaw, Description, Effect, Field, Key, Kind, Model, Pair, Range, Response,
    Slot, Turning, TurningPair,
};
use crate::simd::{Lane, V};

/// μ_r.
pub const COEFFICIENT: Key = Key {
    name: "rolling_resistance",
    unit: "",
    range: Range::UpTo(1e3),
    required: true,
    example: "0.1",
    doc: "μ_r: caps the torque at μ_r R* × what presses, as `sliding_friction` counts it",
};

/// What the program knows of it.
pub const DESCRIPTION: Description = Description {
    name: "rolling_resistance",
    doc: "a spring and dashpot against rolling, under a cap: holds a particle on a slope",
    slot: Slot::Rolling,
    model: Some(Model { key: "rolling_model", value: "spring", default: true }),
    keys: &[COEFFICIENT],
    history: &[Field { name: "rolling", kind: Kind::Vector, unit: "rad", doc: "θ, the spring" }],
    needs: Some(Slot::Sliding),
    every_precision: true,
    idle: |law| law.number("rolling_resistance") == Some(0.0),
    turning: Some(turning),
    ..Description::PLAIN
};

/// 8 × 5/2 c_r over its arm and √(S m*); one hundredth of it stands for the spring.
fn turning(law: &ContactLaw, pair: &TurningPair) -> Turning {
    let resistance = law.number("rolling_resistance").unwrap_or(0.0);
    Turning { stiffness: 0.0, damping: 21.5 * pair.dense * pair.share * resistance * pair.impedance }
}

/// Share of critical damping [–].
const ETA: f64 = 0.3;

/// Rotational spring and dashpot under a cap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RollingResistance {
    /// μ_r [–].
    pub resistance: f64,
}

impl ContactEffect for RollingResistance {
    const DESCRIPTIONS: &'static [&'static Description] = &[&DESCRIPTION];

    fn new(pair: &Pair) -> RollingResistance {
        RollingResistance { resistance: pair.number("rolling_resistance") }
    }
}

impl Effect for RollingResistance {
    type History<R: Lane> = V<R>;
    const ROTATES: bool = true;
    const TORQUES: bool = true;

    #[inline(always)]
    fn apply<R: Lane>(&self, contact: &Contact<R>, dt: R, theta: &mut V<R>, response: &mut Response<R>) {
        let n = contact.normal;
        let rolling = contact.spin - n.scale(contact.spin.dot(n));
        let arm = R::splat(self.resistance) * contact.radius;
        let stiffness = (R::splat(2.25) * response.stiffness * arm * arm).max(R::splat(R::TINY));
        let [before, booked, last] = response.earlier(contact);
        let spring = CappedSpring {
            touching: contact.touching,
            stiffness,
            before,
            booked,
            last: R::splat(2.25) * last * arm * arm,
            // √(k_r I_r) = √(2.25 S (μ_r R*)² 7/5 m* R*²), and the frequency k_r/I_r, without R*.
            damping: R::splat(2.0 * ETA * (2.25f64 * 1.4).sqrt()) * arm * contact.radius * response.impedance,
            pace: R::splat(0.25 * 2.25 / 1.4 * self.resistance * self.resistance)
                * response.stiffness
                * contact.inverse_mass,
            cap: arm * response.pressing.max(R::splat(0.0)),
        };
        *theta = turned(*theta, contact);
        let pull = spring.pull(theta, rolling, dt);
        response.torque = response.torque + pull.force;
        response.elastic = response.elastic + pull.elastic;
        response.dissipate(DESCRIPTION.slot, pull.dissipated);
    }
}

numbers!(RollingResistance { resistance: f64 });
