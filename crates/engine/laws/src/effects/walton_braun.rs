//! Walton and Braun's law (`law = "walton_braun"`): a linear spring that yields as it is loaded and unloads along a steeper line.
//!
//! ```text
//! loading:    F_n = k₁ δ                        up to the largest overlap so far, δ_max
//! unloading:  F_n = k₂ (δ − δ₀) ≥ 0,            δ₀ = (1 − k₁/k₂) δ_max; reloading goes back along the same line
//! k₂ = k₁/e²                                    so that an impact rebounds with e at every speed
//! E = F_n²/2k₂,   plastic work W = ½ k₁ (1 − k₁/k₂) δ_max²
//! ```
//!
//! Walton & Braun (1986), J. Rheology 30, doi:10.1122/1.549893. S, which the time step, rolling and dashpots take, is k₂: a
//! contact at rest moves along that line; k_t is a share of k₁, as it is given. The flattened spot is forgotten when the spheres part. It has no dashpot: along the line of
//! unloading nothing is lost, and small vibrations last; W is lost at once, as δ_max grows.

use super::hooke::{STIFFNESS, TANGENTIAL_RATIO, TANGENTIAL_STIFFNESS, contradiction, unloaded_overlap};
use super::numbers::numbers;
use super::{
    Contact, ContactEffect, ContactLaw, Description, Effect, Field, Key, Kind, Model, NormalLaw, Pair,
    RESTITUTION, Range, Response, Slot,
};
use crate::simd::Lane;

/// What the program knows of it.
pub const DESCRIPTION: Description = Description {
    name: "walton_braun",
    doc: "linear spring that yields (ores, moist bulk): loads with `stiffness` k, unloads with k/e², so that e is the same at every speed; no dashpot",
    slot: Slot::Normal,
    model: Some(Model { key: "law", value: "walton_braun", default: false }),
    keys: &[
        STIFFNESS,
        TANGENTIAL_RATIO,
        TANGENTIAL_STIFFNESS,
        Key { range: Range::AboveZeroUpTo(1.0), ..RESTITUTION },
    ],
    contradiction,
    history: &[Field {
        name: "held",
        kind: Kind::Scalar,
        unit: "m",
        doc: "δ_max, the largest overlap so far",
    }],
    normal: Some(NormalLaw {
        stiffest: |law, _, _| unloading(law),
        reach: |_, _, _| 0.0,
        nominal: |law| law.number("stiffness").unwrap_or(f64::NAN) / unloading(law),
        unloaded_overlap,
        stiffens: false,
        yields: true,
    }),
    ..Description::PLAIN
};

/// k₂ [N/m].
fn unloading(law: &ContactLaw) -> f64 {
    let [k, e] = ["stiffness", "restitution"].map(|key| law.number(key).unwrap_or(f64::NAN));
    k / (e * e)
}

/// A spring that yields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaltonBraun {
    /// k₁ [N/m].
    pub loading: f64,
    /// k₂ [N/m].
    pub unloading: f64,
}

impl ContactEffect for WaltonBraun {
    const DESCRIPTIONS: &'static [&'static Description] = &[&DESCRIPTION];

    fn new(pair: &Pair) -> WaltonBraun {
        WaltonBraun { loading: pair.number("stiffness"), unloading: unloading(pair.law) }
    }
}

impl Effect for WaltonBraun {
    /// δ_max [m].
    type History<R: Lane> = R;

    #[inline(always)]
    fn apply<R: Lane>(&self, contact: &Contact<R>, _: R, deepest: &mut R, response: &mut Response<R>) {
        let (number, before) = (R::splat, *deepest);
        *deepest = before.max(contact.overlap);
        let yielded = number(1.0 - self.loading / self.unloading);
        let spring = (contact.overlap - yielded * *deepest).max(number(0.0));
        let held = (contact.present - yielded * *deepest).max(number(0.0));
        let unloading = number(self.unloading) * contact.share;
        let force = unloading * spring;
        response.normal = response.normal + force;
        response.pressing = response.normal;
        response.stiffness = unloading;
        response.stiffness_before = contact.share_before;
        response.stiffness_last = unloading * contact.share_before;
        response.impedance = (response.stiffness * contact.mass).sqrt();
        response.elastic = response.elastic + number(0.5) * unloading * held * held;
        let plastic = number(0.5 * self.loading) * yielded * contact.share;
        response.lost = response.lost + plastic * (*deepest * *deepest - before * before);
    }
}

numbers!(WaltonBraun { loading: f64, unloading: f64 });
