//! Rolling resistance (`rolling_model = "constant"`): a torque against the rolling that does not depend on its speed, without history.
//!
//! ```text
//! M = −μ_r R* F_n ω_r/|ω_r|,   ω_r = (ω_i − ω_j) − its part along n
//! |M| ≤ β/y I_r |ω_r| / Δt,    I_r = 2/5 m* R*²,  β = 1/8
//! ```
//!
//! Zhou, Wright, Yang, Xu & Yu (1999), Physica A 269, doi:10.1016/S0378-4371(99)00183-1; model A of Ai, Chen, Rotter & Ooi
//! (2011), Powder Technology 206, doi:10.1016/j.powtec.2010.09.030. Deviation, the second line: a torque of constant size would turn
//! round at every step of a grain at rest. It never takes more than the share β/y of the rolling in one step; below
//! |ω_r| = y μ_r R* F_n Δt/β I_r it is a dashpot, which never makes energy, and ω_r decays to zero instead of jittering. I_r is
//! at most the inertia against relative rolling, a quarter of it for equal spheres, so that twelve contacts at
//! once, or three of a wall and nine others, stay below the whole rolling. A clump has as many on
//! each of its spheres, and y says how much easier it yields to them all than a sphere of its mass: no less than the number of its spheres; 1 for
//! spheres. Wall spheres so close that more than four push at once count in y, too. What it cannot do: hold a grain on a slope, where it creeps at the
//! speed at which the dashpot bears the moment, ∝ Δt; the spring model holds it.

use super::rolling_resistance::COEFFICIENT;
use super::{Contact, ContactEffect, Description, Effect, Model, Pair, Response, Slot};
use crate::simd::Lane;

/// What the program knows of it.
pub const DESCRIPTION: Description = Description {
    name: "constant rolling",
    doc: "a torque of one size against rolling: a particle creeps on a slope",
    slot: Slot::Rolling,
    model: Some(Model { key: "rolling_model", value: "constant", default: false }),
    keys: &[COEFFICIENT],
    needs: Some(Slot::Sliding),
    idle: |law| law.number("rolling_resistance") == Some(0.0),
    ..Description::PLAIN
};

/// β, the share of the rolling that one contact of a sphere may take in one step [–].
const SHARE: f64 = 0.125;

/// A torque of constant size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConstantRolling {
    /// μ_r [–].
    pub resistance: f64,
    /// y: compliance of the most compliant clump over that of a sphere of its mass [–].
    pub compliance: f64,
}

impl ContactEffect for ConstantRolling {
    const DESCRIPTIONS: &'static [&'static Description] = &[&DESCRIPTION];

    fn new(pair: &Pair) -> ConstantRolling {
        ConstantRolling { resistance: pair.number("rolling_resistance"), compliance: pair.compliance.clumps }
    }
}

impl Effect for ConstantRolling {
    type History<R: Lane> = ();
    const ROTATES: bool = true;
    const TORQUES: bool = true;

    #[inline(always)]
    fn apply<R: Lane>(&self, contact: &Contact<R>, dt: R, _: &mut (), response: &mut Response<R>) {
        let n = contact.normal;
        let rolling = contact.spin - n.scale(contact.spin.dot(n));
        let square = rolling.dot(rolling);
        let cap = R::splat(self.resistance) * contact.radius * response.pressing.max(R::splat(0.0));
        let inertia = R::splat(0.4) * contact.mass * contact.radius * contact.radius;
        let dashpot =
            (cap / square.max(R::splat(1e-300)).sqrt()).min(R::splat(SHARE / self.compliance) * inertia / dt);
        response.torque = response.torque - rolling.scale(dashpot);
        let dissipated = R::select(contact.touching, dashpot * square * dt, R::splat(0.0));
        response.dissipate(DESCRIPTION.slot, dissipated);
    }
}
