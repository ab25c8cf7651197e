//! Sliding friction: a tangential spring and dashpot, capped by Coulomb's law.
//!
//! ```text
//! ξ ← ξ + v_t Δt        the spring turns with the contact and stretches
//! F_t = −k_t ξ − c_t v_t     sticks while |F_t| ≤ μ F_p
//! F_t = μ F_p F_t/|F_t|      slides otherwise; ξ is cut back to match
//! k_t = q S,  c_t = γ √(k_t m*)       S: the normal law's stiffness; q = 4 G*/E* (Mindlin) unless given
//! F_p = F_n,  with JKR F_n + 2 F_po,  with cohesion F_n without its pull
//! ```
//!
//! Cundall & Strack (1979), Géotechnique 29(1), doi:10.1680/geot.1979.29.1.47; Mindlin (1949), J. Appl. Mech. 16. What
//! grains pulled together are pressed by: Thornton (1991), J. Phys. D 24, doi:10.1088/0022-3727/24/11/007. Where F_p
//! pulls, nothing holds. Comes after every effect that changes F_n.

use super::capped_spring::{CappedSpring, turned};
use super::describe::{Description, Field, Key, Kind, Range, Slot};
use super::pair::{Pair, tangential_ratio};
use super::weakening::Friction;
use super::{Contact, ContactEffect, Effect, Load, weakening};
use crate::simd::{Lane, V};

/// ξ.
pub const SPRING: Field = Field { name: "sliding", kind: Kind::Vector, unit: "m", doc: "ξ, the spring" };

/// What the program knows of it.
pub const DESCRIPTION: Description = Description {
    name: "sliding_friction",
    doc: "tangential spring and dashpot under Coulomb's cap",
    slot: Slot::Sliding,
    keys: &[Key {
        name: "sliding_friction",
        unit: "",
        range: Range::UpTo(1e3),
        required: true,
        example: "0.5",
        doc: "μ: caps the tangential force at μ × what presses, F_n without the pull of cohesion (\"jkr\": F_n + 2 × the strongest pull)",
    }],
    history: &[SPRING],
    every_precision: true,
    idle: |law| law.number("sliding_friction") == Some(0.0),
    ..Description::PLAIN
};

/// Its entry of the energy ledger.
const LEDGER: usize = DESCRIPTION.slot.ledger();

/// What μ is: a number, or a function of the state of the contact.
pub trait Coefficient: Copy + Send + Sync + 'static {
    /// μ [–] of a contact.
    fn of<R: Lane>(&self, contact: &Contact<R>) -> R;
}

impl Coefficient for f64 {
    #[inline(always)]
    fn of<R: Lane>(&self, _: &Contact<R>) -> R {
        R::splat(*self)
    }
}

/// Tangential spring and dashpot under Coulomb's cap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlidingFriction<C = f64> {
    /// μ [–].
    pub friction: C,
    /// q = k_t/S [–].
    pub stiffness_ratio: f64,
    /// γ [–], as for the normal law.
    pub damping_ratio: f64,
    /// How much easier than a sphere of its mass the easiest body yields: 1 for spheres, more for clumps [–].
    pub yielding: f64,
}

impl<C: Coefficient> SlidingFriction<C> {
    fn new(pair: &Pair, friction: C) -> SlidingFriction<C> {
        let stiffness_ratio = tangential_ratio(pair.law, pair.elastic);
        let (damping_ratio, yielding) = (pair.damping_ratio(), pair.ease.springs);
        SlidingFriction { friction, stiffness_ratio, damping_ratio, yielding }
    }
}

/// The same at every speed.
impl ContactEffect for SlidingFriction<f64> {
    const DESCRIPTIONS: &'static [&'static Description] = &[&DESCRIPTION];

    fn of(pair: &Pair) -> Option<SlidingFriction<f64>> {
        DESCRIPTION.asked_for(pair.law).then(|| SlidingFriction::new(pair, pair.number("sliding_friction")))
    }
}

/// The same at every speed, or weaker with speed.
impl ContactEffect for SlidingFriction<Friction> {
    const DESCRIPTIONS: &'static [&'static Description] = &[&DESCRIPTION, &weakening::DESCRIPTION];

    fn of(pair: &Pair) -> Option<SlidingFriction<Friction>> {
        Some(SlidingFriction::new(pair, Friction::of(pair)?))
    }
}

impl<C: Coefficient> Effect for SlidingFriction<C> {
    type Memory<R: Lane> = V<R>;
    const ROTATES: bool = true;

    #[inline(always)]
    fn apply<R: Lane>(&self, contact: &Contact<R>, dt: R, xi: &mut V<R>, load: &mut Load<R>) {
        // A stiffness of 0 at δ = 0 (Hertz) would be divided by; nothing holds there in any case.
        let stiffness = (R::splat(self.stiffness_ratio) * load.stiffness).max(R::splat(R::TINY));
        let spring = CappedSpring {
            touching: contact.touching,
            stiffness,
            before: load.stiffness_before,
            damping: R::splat(self.damping_ratio * self.stiffness_ratio.sqrt()) * load.impedance,
            // A quarter of the square of the fastest motion of a close packing: all grains turning the same way, 20 k_t/m*,
            // or layers against layers, 4 (S + k_t)/m*, which the spring would feed otherwise.
            // Clumps, which forces turn as well, are faster by what they yield.
            pace: (R::splat(5.0) * stiffness).max(load.stiffness + stiffness)
                * (R::splat(self.yielding) * contact.inverse_mass),
            cap: self.friction.of(contact) * load.pressing.max(R::splat(0.0)),
        };
        *xi = turned(*xi, contact);
        let pull = spring.pull(xi, contact.slip, dt);
        load.tangential = load.tangential + pull.force;
        load.elastic = load.elastic + pull.elastic;
        load.dissipated[LEDGER] = load.dissipated[LEDGER] + pull.dissipated;
    }
}
