//! Hertz: elastic spheres, with a dashpot that gives the same restitution at every speed.
//!
//! ```text
//! Fₙ = 4/3 E* √R* δ^{3/2} + c δ̇,   S = dFₙ/dδ = 2 E* √(R* δ),   c = γ √(5/6) √(S m*)
//! ```
//!
//! Hertz (1882), J. reine angew. Math. 92; damping ∝ δ^{1/4}: Tsuji, Tanaka & Ishida (1992), Powder Technology 71,
//! doi:10.1016/0032-5910(92)88030-L; γ from e is exact for contact until δ = 0, not Tsuji's polynomial: Antypov &
//! Elliott (2011), EPL 94, doi:10.1209/0295-5075/94/50004.

use super::numbers::numbers;
use super::{
    Contact, ContactEffect, ContactLaw, Damping, Description, Effect, Elastic, Model, NormalLaw,
    OverlapLimit, Pair, RESTITUTION, Response, Slot,
};
use crate::simd::Lane;
use core::f64::consts::PI;

/// What the program knows of it.
pub const DESCRIPTION: Description = Description {
    name: "hertz",
    doc: "elastic spheres (Hertz–Mindlin), from `young` and `poisson`; the default",
    slot: Slot::Normal,
    model: Some(Model { key: "law", value: "hertz", default: true }),
    keys: &[RESTITUTION],
    every_precision: true,
    normal: Some(NormalLaw {
        stiffest,
        reach: |_, _, _| 0.0,
        nominal: |_| 1.0,
        unloaded_overlap,
        stiffens: true,
        yields: false,
    }),
    ..Description::PLAIN
};

/// dF_n/dδ.
fn stiffest(_: &ContactLaw, elastic: Elastic, at: OverlapLimit) -> f64 {
    2.0 * elastic.modulus * (at.radius * at.share * at.smaller).sqrt()
}

/// (9π²/4) (C/E*)².
fn unloaded_overlap(_: &ContactLaw, elastic: Elastic, density: f64, _: [f64; 2]) -> f64 {
    let ratio = PI * density / elastic.modulus;
    2.25 * (ratio * ratio)
}

/// Hertz's law with a dashpot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hertz {
    /// E* [Pa].
    pub modulus: f64,
    /// γ √(5/6), γ as for [`super::Hooke`].
    pub damping: Damping,
}

impl ContactEffect for Hertz {
    const DESCRIPTIONS: &'static [&'static Description] = &[&DESCRIPTION];

    fn new(pair: &Pair) -> Hertz {
        Hertz { modulus: pair.elastic.modulus, damping: pair.damping.scaled((5.0f64 / 6.0).sqrt()) }
    }
}

impl Effect for Hertz {
    type History<R: Lane> = ();

    #[inline(always)]
    fn apply<R: Lane>(&self, contact: &Contact<R>, dt: R, _: &mut (), response: &mut Response<R>) {
        let overlap = contact.overlap.max(R::splat(0.0));
        let modulus = R::splat(2.0 * self.modulus) * contact.share;
        let s = modulus * (contact.radius * overlap).sqrt();
        response.impedance = (s * contact.mass).sqrt();
        let pace = s * contact.inverse_mass;
        let c = self.damping.of(pace, contact.partial) * response.impedance;
        let elastic = R::splat(2.0 / 3.0) * s * overlap;
        let damping = c * contact.approach;
        response.normal = response.normal + (elastic + damping);
        response.pressing = response.normal;
        response.stiffness = s;
        // S ∝ √δ.
        let before = contact.before.max(R::splat(0.0));
        response.stiffness_last = modulus * contact.share_before * (contact.radius * before).sqrt();
        response.stiffness_before = contact.share_before * (before / overlap.max(R::splat(R::TINY))).sqrt();
        let present = contact.present.max(R::splat(0.0));
        let root = (contact.radius * present).sqrt();
        let spring = R::splat(2.0 / 3.0) * (modulus * root) * present;
        response.elastic = response.elastic + R::splat(0.4) * spring * present;
        response.dissipate(DESCRIPTION.slot, damping * contact.approach * dt * self.damping.dissipates(pace));
    }
}

numbers!(Hertz { modulus: f64, damping: Damping });
