//! Twisting resistance: a rotational spring and dashpot about the normal, capped by a torque proportional to the normal force.
//!
//! ```text
//! φ ← φ + ω_n Δt,   ω_n = (ω_i − ω_j)·n
//! M = (−k_w φ − c_w ω_n) n,  |M| ≤ μ_w R* F_p        F_p: what presses, as for sliding: with JKR F_n + 2 F_po, with cohesion F_n without its pull
//! k_w = k_t R*²,   c_w = 2 η √(k_w I_w),  η = 0.3,  I_w = 2/5 m* R*²
//! ```
//!
//! Torsion of Luding (2008), Granular Matter 10(4), doi:10.1007/s10035-008-0099-x: the law of sliding for the displacement R* φ,
//! with the stiffness of sliding. Deviations: the dashpot is a share of the critical one, as for rolling. φ is a number: it turns
//! with the contact by itself, and is the same for i and for j.

use super::capped_spring::CappedSpring;
use super::numbers::numbers;
use super::{
    ALONG, Contact, ContactEffect, ContactLaw, Description, Effect, Field, Key, Kind, Pair, Range, Response,
    Slot, Turning, TurningPair, tangential_ratio,
};
use crate::simd::Lane;
use crate::space::sphere::TURNS;

/// What the program knows of it.
pub const DESCRIPTION: Description = Description {
    name: "twisting_resistance",
    doc: "a spring and dashpot about the normal, under a cap",
    slot: Slot::Twisting,
    keys: &[Key {
        name: "twisting_resistance",
        unit: "",
        range: Range::UpTo(1e3),
        required: true,
        example: "0.05",
        doc: "μ_w: caps the torque at μ_w R* × what presses, as `sliding_friction` counts it",
    }],
    history: &[Field { name: "twisting", kind: Kind::Scalar, unit: "rad", doc: "φ, the angle" }],
    needs: Some(Slot::Sliding),
    idle: |law| law.number("twisting_resistance") == Some(0.0),
    turning: Some(turning),
    ..Description::PLAIN
};

/// 4 × 5/2 of k_w and c_w, η = 0.3.
fn turning(_: &ContactLaw, pair: &TurningPair) -> Turning {
    let straight = ALONG * pair.dense;
    Turning {
        stiffness: straight * TURNS * pair.share * pair.tangential,
        damping: straight * TURNS * 0.6 * 0.4f64.sqrt() * pair.share * pair.tangential_impedance,
    }
}

/// Share of critical damping [–].
const ETA: f64 = 0.3;

/// Spring and dashpot about the normal, under a cap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwistingResistance {
    /// μ_w [–].
    pub resistance: f64,
    /// k_t/S [–], as for sliding.
    pub stiffness_ratio: f64,
    /// As for sliding [–].
    pub compliance: f64,
}

impl ContactEffect for TwistingResistance {
    const DESCRIPTIONS: &'static [&'static Description] = &[&DESCRIPTION];

    fn new(pair: &Pair) -> TwistingResistance {
        let stiffness_ratio = tangential_ratio(pair.law, pair.elastic);
        let (resistance, compliance) = (pair.number("twisting_resistance"), pair.compliance.springs);
        TwistingResistance { resistance, stiffness_ratio, compliance }
    }
}

impl Effect for TwistingResistance {
    type History<R: Lane> = R;
    const ROTATES: bool = true;
    const TORQUES: bool = true;

    #[inline(always)]
    fn apply<R: Lane>(&self, contact: &Contact<R>, dt: R, phi: &mut R, response: &mut Response<R>) {
        let square = contact.radius * contact.radius;
        let stiffness = (R::splat(self.stiffness_ratio) * response.stiffness * square).max(R::splat(1e-150));
        let inertia = R::splat(0.4) * contact.mass * square;
        let [before, booked, last] = response.earlier(contact);
        let spring = CappedSpring {
            touching: contact.touching,
            stiffness,
            before,
            booked,
            last: R::splat(self.stiffness_ratio) * last * square,
            damping: R::splat(2.0 * ETA) * (stiffness * inertia).sqrt(),
            pace: R::splat(0.25 * self.compliance) * stiffness / inertia,
            cap: R::splat(self.resistance) * contact.radius * response.pressing.max(R::splat(0.0)),
        };
        let pull = spring.pull(phi, contact.spin.dot(contact.normal), dt);
        response.torque = response.torque + contact.normal.scale(pull.force);
        response.elastic = response.elastic + pull.elastic;
        response.dissipate(DESCRIPTION.slot, pull.dissipated);
    }
}

numbers!(TwistingResistance { resistance: f64, stiffness_ratio: f64, compliance: f64 });
