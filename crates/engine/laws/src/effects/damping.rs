//! The damping ratio of a normal law: a number, or matched to the time step.
//!
//! ```text
//! γ(S) = γ + γ₁ (S/m* Δt²) + γ₂ (S/m* Δt²)²
//! ```
//!
//! What a dashpot takes is booked as c v² Δt · (1 + β₁ (S/m* Δt²) + β₂ (S/m* Δt²)²).
//!
//! γ is that of exact integration ([`super::damping_ratio`]); γ₁ and γ₂ are 0, or such that the impact in finite steps has the restitution asked for;
//! β₁ and β₂ are 0, or such that it books what it loses ([`crate::model::matched`]).

use super::damping_ratio;
use crate::simd::Lane;

/// γ of a normal law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damping {
    /// γ [–].
    pub ratio: f64,
    /// γ₁ Δt² [s²].
    pub first: f64,
    /// γ₂ Δt⁴ [s⁴].
    pub second: f64,
    /// β₁ Δt² [s²] and β₂ Δt⁴ [s⁴].
    pub booked: [f64; 2],
    /// 1, or 0 with e = 1: γ then acts only in kicks in which a contact begins or ends, and takes back what the step has made there. Its work is
    /// no dissipation, and contacts that last keep their energy.
    pub dissipates: f64,
}

impl Damping {
    /// That of exact integration, for a restitution.
    pub fn exact(restitution: f64) -> Damping {
        let ratio = damping_ratio(restitution);
        Damping { ratio, dissipates: if ratio > 0.0 { 1.0 } else { 0.0 }, ..Damping::NONE }
    }

    /// None.
    pub const NONE: Damping =
        Damping { ratio: 0.0, first: 0.0, second: 0.0, booked: [0.0; 2], dissipates: 0.0 };

    /// Times a number.
    pub fn scaled(self, by: f64) -> Damping {
        Damping { ratio: by * self.ratio, first: by * self.first, second: by * self.second, ..self }
    }

    /// γ of a contact whose S/m* [1/s²] is `pace`; `partial` is 1 where it begins or ends in the kick, else 0.
    #[inline(always)]
    pub fn of<R: Lane>(&self, pace: R, partial: R) -> R {
        let acts = R::splat(self.dissipates) + R::splat(1.0 - self.dissipates) * partial;
        (R::splat(self.ratio) + pace * (R::splat(self.first) + pace * R::splat(self.second))) * acts
    }

    /// Share of the dashpot's c v² Δt that is booked as dissipated.
    #[inline(always)]
    pub fn dissipates<R: Lane>(&self, pace: R) -> R {
        let [first, second] = self.booked;
        R::splat(self.dissipates) * (R::splat(1.0) + pace * (R::splat(first) + pace * R::splat(second)))
    }
}
