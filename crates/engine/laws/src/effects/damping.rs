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

use super::describe::{Key, MOST, Range};
use super::law::ContactLaw;
use super::numbers::numbers;
use crate::float::Float;
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

/// η_t.
pub const TANGENTIAL_DAMPING: Key = Key {
    name: "tangential_damping",
    unit: "N s/m",
    range: Range::UpTo(MOST),
    required: false,
    example: "0.3",
    doc: "η_t of the tangential dashpot; absent: γ √(k_t m*) of the restitution, or η_n √(k_t/k_n)",
};

/// e of every normal law.
pub const RESTITUTION: Key = Key {
    name: "restitution",
    unit: "",
    range: Range::UpTo(1.0),
    required: true,
    example: "0.5",
    doc: "e of a head-on impact; with cohesion or \"jkr\" that of the same contact without adhesion, whose cost comes on top",
};

/// η_n of linear laws.
pub const NORMAL_DAMPING: Key = Key {
    name: "normal_damping",
    unit: "N s/m",
    range: Range::Positive,
    required: false,
    example: "0.5",
    doc: "η_n of the dashpot, instead of `restitution`; without one: `restitution = 1`",
};

/// Damping ratio of a linear oscillator that rebounds with restitution `e` when it is let go at δ = 0:
///
/// ```text
/// γ = −2 ln e / √(π² + ln² e),   c = γ √(k m*)         γ → 2 (critical) for e → 0
/// ```
///
/// Exact, by inversion of e = exp(−c t_c / 2m*), t_c = π / √(k/m* − (c/2m*)²).
pub fn damping_ratio(restitution: f64) -> f64 {
    if restitution <= 0.0 {
        return 2.0;
    }
    let ln = libm::log(restitution);
    -2.0 * ln / (core::f64::consts::PI * core::f64::consts::PI + ln * ln).root()
}

/// γ of the normal and of the tangential dashpot [–], of a contact whose √(S m*) and √(k_t m*) are given [kg/s]: those of the restitution, or η over them.
pub fn damping_ratios(law: &ContactLaw, [normal, tangential]: [f64; 2]) -> [f64; 2] {
    let of_restitution = || damping_ratio(law.number(RESTITUTION.name).unwrap_or(f64::NAN));
    let along = law.number(NORMAL_DAMPING.name).map_or_else(of_restitution, |eta| eta / normal);
    [along, law.number(TANGENTIAL_DAMPING.name).map_or(along, |eta| eta / tangential)]
}

numbers!(Damping { ratio: f64, first: f64, second: f64, booked: [f64; 2], dissipates: f64 });
