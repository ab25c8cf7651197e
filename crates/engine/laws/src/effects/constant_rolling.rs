//! Rolling resistance (`rolling_model = "constant"`): a torque against the rolling that does not depend on its speed.
//!
//! ```text
//! rolls    M = −c u,  c = μ_r R* F_p       u = ω_r/|ω_r|,  ω_r = (ω_i − ω_j) − its part along n;  F_p: what presses, as for sliding
//! sticks   M = −E,  while |E| ≤ c          E = −(l/y) n × F_t,  l = (a_i/I_i − a_j/I_j)/(1/I_i + 1/I_j),  a: arms of F_t
//!          − β/y I_r ω_r/Δt                I_r = 2/5 m* R*²,  β = 1/8
//! stops    M = −c u τ − E' (1 − τ)         E': E, or c E/|E| where that is less: it rolls on
//!          τ = (ω_r·u I/yΔt − ½ (E·u − c))/(c − E·u),  0 ≤ τ ≤ 1;   I = 1/(1/I_i + 1/I_j)
//! ```
//!
//! Zhou, Wright, Yang, Xu & Yu (1999), Physica A 269, doi:10.1016/S0378-4371(99)00183-1; model A of Ai, Chen, Rotter & Ooi
//! (2011), Powder Technology 206, doi:10.1016/j.powtec.2010.09.030. They leave open what holds a grain that does not roll. Here it is what friction turns the two against
//! each other by, E. Where rolling ends within a step, M is the mean over the step, whose share τ was rolling: so the step costs its square. The history is u, half as long where it sticks.
//!
//! What is left of the rolling where it sticks is taken by a dashpot, the share β/y of it in a step. I_r is
//! at most the inertia against relative rolling, a quarter of it for equal spheres, so that twelve contacts at
//! once, or three of a wall and nine others, stay below the whole rolling, and ω_r decays to zero instead of jittering. A clump has as many on
//! each of its spheres, and y says how much easier it yields to them all than a sphere of its mass: no less than the number of its spheres; 1 for
//! spheres. Wall spheres so close that more than four push at once count in y, too. What it cannot do: hold a clump on a slope, or a grain that others push,
//! where the dashpot bears the moment and it creeps at a speed ∝ Δt; the spring model holds it.

use super::capped_spring::turned;
use super::numbers::numbers;
use super::rolling_resistance::COEFFICIENT;
use super::{Contact, ContactEffect, Description, Effect, Field, Kind, Model, Pair, Response, Slot};
use crate::simd::{Lane, V};

/// What the program knows of it.
pub const DESCRIPTION: Description = Description {
    name: "constant rolling",
    doc: "a torque of one size against rolling: a clump creeps on a slope",
    slot: Slot::Rolling,
    model: Some(Model { key: "rolling_model", value: "constant", default: false }),
    keys: &[COEFFICIENT],
    history: &[Field {
        name: "rolling",
        kind: Kind::Vector,
        unit: "–",
        doc: "u, the direction of rolling, half as long where it sticks",
    }],
    needs: Some(Slot::Sliding),
    idle: |law| law.number("rolling_resistance") == Some(0.0),
    ..Description::PLAIN
};

/// β, the share of the rolling that one contact of a sphere may take in one step where it sticks [–].
const SHARE: f64 = 0.125;
/// Length of u where it sticks [–].
const STUCK: f64 = 0.5;

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

/// A torque or a velocity, and its size.
#[derive(Clone, Copy)]
struct Arrow<R: Lane>(V<R>, R);

impl<R: Lane> Arrow<R> {
    #[inline(always)]
    fn of(v: V<R>) -> Arrow<R> {
        Arrow(v, v.dot(v).sqrt())
    }

    /// Its direction; zero where it has none.
    #[inline(always)]
    fn direction(self) -> V<R> {
        self.0.scale(R::splat(1.0) / self.1.max(R::splat(R::TINY)))
    }

    /// Cut to this size.
    #[inline(always)]
    fn cut(self, cap: R) -> V<R> {
        self.0.scale((cap / self.1.max(R::splat(R::TINY))).min(R::splat(1.0)))
    }
}

impl Effect for ConstantRolling {
    type History<R: Lane> = V<R>;
    const ROTATES: bool = true;
    const TORQUES: bool = true;

    #[inline(always)]
    fn apply<R: Lane>(&self, contact: &Contact<R>, dt: R, rolled: &mut V<R>, response: &mut Response<R>) {
        let (n, number) = (contact.normal, R::splat);
        let rolling = contact.spin - n.scale(contact.spin.dot(n));
        let cap = number(self.resistance) * contact.radius * response.pressing.max(number(0.0));
        let share = number(1.0 / self.compliance);
        let turns = n.cross(response.tangential).scale(number(0.0) - contact.lever * share);
        let last = turned(*rolled, contact);
        let length = last.dot(last);
        let now = Arrow::of(rolling).direction();
        let fresh = number(0.25 * STUCK * STUCK).gt(length);
        let stuck = R::both(length.gt(number(0.0)), number(0.5).gt(length));

        let way = V::select(fresh, now, last);
        let along = turns.dot(way);
        let left = rolling.dot(way) * (contact.inertia * share / dt) - number(0.5) * (along - cap);
        let slows = cap - along;
        let part = (left / slows.max(number(R::TINY))).max(number(0.0)).min(number(1.0));
        let ever = R::select(left.gt(number(0.0)), number(1.0), number(0.0));
        let part = R::select(slows.gt(number(0.0)), part, ever);
        let rolls = part.gt(number(1.0 - 1e-9));
        let after = Arrow::of(turns);
        let stops = way.scale(cap * part) + after.cut(cap).scale(number(1.0) - part);
        let ended = V::select(after.1.gt(cap), after.direction(), way.scale(number(STUCK)));
        let moving = V::select(rolls, now.scale(cap), stops);
        let next = V::select(rolls, now, ended);

        let inertia = number(0.4) * contact.mass * contact.radius * contact.radius;
        let held = Arrow::of(turns + rolling.scale(number(SHARE) * share * inertia / dt));
        let released = V::select(held.1.gt(cap), held.direction(), last);
        let torque = V::select(stuck, held.cut(cap), moving);
        *rolled = V::select(stuck, released, next);
        response.torque = response.torque - torque;
        let dissipated = R::select(contact.touching, torque.dot(rolling) * dt, number(0.0));
        response.dissipate(DESCRIPTION.slot, dissipated);
    }
}

numbers!(ConstantRolling { resistance: f64, compliance: f64 });
