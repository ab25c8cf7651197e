//! Sliding friction: a tangential spring and dashpot, capped by Coulomb's law.
//!
//! ```text
//! ξ ← ξ + v_t Δt        the spring turns with the contact and stretches
//! F_t = −k_t ξ − c_t v_t     sticks while |F_t| ≤ μ F_p
//! F_t = μ F_p F_t/|F_t|      slides otherwise; ξ is cut back to match
//! k_t = q S,  c_t = γ √(k_t m*)       S: the normal law's stiffness; q = 4 G*/E* (Mindlin) unless given; c_t may be given, too ([`super::friction`])
//! F_p = F_n,  with JKR F_n + 2 F_po,  with cohesion F_n without its pull
//! ```
//!
//! Cundall & Strack (1979), Géotechnique 29(1), doi:10.1680/geot.1979.29.1.47; Mindlin (1949), J. Appl. Mech. 16. What
//! grains pulled together are pressed by: Thornton (1991), J. Phys. D 24, doi:10.1088/0022-3727/24/11/007. A contact
//! with F_p < 0 carries no tangential force. Comes after every effect that changes F_n.

use super::Numbers;
use super::capped_spring::{CappedSpring, turned};
use super::{
    Contact, ContactEffect, Description, Effect, Field, Friction, Key, Kind, Pair, Range, Response, Slot,
    friction, tangential_ratio, weakening,
};
use crate::simd::{Lane, V};
use alloc::vec::Vec;

/// ξ.
pub const SPRING: Field = Field { name: "sliding", kind: Kind::Vector, unit: "m", doc: "ξ, the spring" };

/// μ.
pub const COEFFICIENT: Key = Key {
    name: "sliding_friction",
    unit: "",
    range: Range::UpTo(1e3),
    required: true,
    example: "0.5",
    doc: "μ: caps the tangential force at μ × what presses, F_n without the pull of cohesion (\"jkr\": F_n + 2 × the strongest pull)",
};

/// What the program knows of it.
pub const DESCRIPTION: Description = Description {
    name: "sliding_friction",
    doc: "tangential spring and dashpot under Coulomb's cap",
    slot: Slot::Sliding,
    keys: &[COEFFICIENT],
    picked: |law| !friction::own_dashpot(law),
    history: &[SPRING],
    every_precision: true,
    idle: |law| law.number("sliding_friction") == Some(0.0),
    ..Description::PLAIN
};

/// What μ is: a number, or a function of the state of the contact.
pub trait Coefficient: Numbers + Send + Sync + 'static {
    /// μ [–] of a contact.
    fn of<R: Lane>(&self, contact: &Contact<R>) -> R;
    /// c_t [N s/m], where that of the law is `of_law`.
    #[inline(always)]
    fn dashpot<R: Lane>(&self, of_law: R) -> R {
        of_law
    }
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
    /// Compliance of the most compliant clump over that of a sphere of its mass: 1 for spheres, more for clumps [–].
    pub compliance: f64,
}

impl<C: Coefficient> SlidingFriction<C> {
    fn with(pair: &Pair, friction: C) -> SlidingFriction<C> {
        let stiffness_ratio = tangential_ratio(pair.law, pair.elastic);
        let (damping_ratio, compliance) = (pair.damping_ratio(), pair.compliance.springs);
        SlidingFriction { friction, stiffness_ratio, damping_ratio, compliance }
    }
}

/// The same at every speed.
impl ContactEffect for SlidingFriction<f64> {
    const DESCRIPTIONS: &'static [&'static Description] = &[&DESCRIPTION];

    fn new(pair: &Pair) -> SlidingFriction<f64> {
        SlidingFriction::with(pair, pair.number("sliding_friction"))
    }
}

/// In full: the same at every speed or weaker with speed, with the law's dashpot or its own.
impl ContactEffect for SlidingFriction<Friction> {
    const DESCRIPTIONS: &'static [&'static Description] =
        &[&DESCRIPTION, &friction::WITH_DASHPOT, &weakening::DESCRIPTION];

    fn new(pair: &Pair) -> SlidingFriction<Friction> {
        SlidingFriction::with(pair, Friction::of(pair))
    }
}

impl<C: Coefficient> Effect for SlidingFriction<C> {
    type History<R: Lane> = V<R>;
    const ROTATES: bool = true;

    #[inline(always)]
    fn apply<R: Lane>(&self, contact: &Contact<R>, dt: R, xi: &mut V<R>, response: &mut Response<R>) {
        // A stiffness of 0 at δ = 0 (Hertz) would be divided by; nothing holds there in any case.
        let stiffness = (R::splat(self.stiffness_ratio) * response.stiffness).max(R::splat(R::TINY));
        let of_law = R::splat(self.damping_ratio * self.stiffness_ratio.sqrt()) * response.impedance;
        let [before, booked, last] = response.earlier(contact);
        let spring = CappedSpring {
            touching: contact.touching,
            stiffness,
            before,
            booked,
            last: R::splat(self.stiffness_ratio) * last,
            damping: self.friction.dashpot(of_law),
            // A quarter of the square of the fastest motion of a close packing: all grains turning the same way, 20 k_t/m*,
            // or layers against layers, 4 (S + k_t)/m*, which the spring would feed otherwise.
            // Clumps, which forces turn as well, are faster by what they yield.
            pace: (R::splat(5.0) * stiffness).max(response.stiffness + stiffness)
                * (R::splat(self.compliance) * contact.inverse_mass),
            cap: self.friction.of(contact) * response.pressing.max(R::splat(0.0)),
        };
        *xi = turned(*xi, contact);
        let pull = spring.pull(xi, contact.slip, dt);
        response.tangential = response.tangential + pull.force;
        response.elastic = response.elastic + pull.elastic;
        response.dissipate(DESCRIPTION.slot, pull.dissipated);
    }
}

impl<C: Numbers> Numbers for SlidingFriction<C> {
    const COUNT: usize = C::COUNT + 3;
    fn put(&self, to: &mut Vec<f64>) {
        let SlidingFriction { friction, stiffness_ratio, damping_ratio, compliance } = self;
        (*friction, ((*stiffness_ratio, *damping_ratio), *compliance)).put(to);
    }
    #[inline(always)]
    fn take(from: &mut &[f64]) -> SlidingFriction<C> {
        let (friction, ((stiffness_ratio, damping_ratio), compliance)) = Numbers::take(from);
        SlidingFriction { friction, stiffness_ratio, damping_ratio, compliance }
    }
}
