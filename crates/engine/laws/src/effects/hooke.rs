//! Hooke: a linear spring and dashpot along the normal.
//!
//! ```text
//! Fₙ = k δ + c δ̇,   c = γ √(k m*)       e = exp(−c t_c / 2m*),  t_c = π / √(k/m* − (c/2m*)²)
//! ```
//!
//! Cundall & Strack (1979), Géotechnique 29(1), doi:10.1680/geot.1979.29.1.47. γ from the restitution:
//! [`super::damping_ratio`]. The contact lasts until δ = 0, so that e comes out exactly; the force may pull a little
//! in its last moment.

use super::damping::RESTITUTION;
use super::numbers::numbers;
use super::{
    Contact, ContactLaw, Contradiction, Damping, Description, Effect, Elastic, Key, Model, NormalLaw,
    OverlapLimit, Pair, Range, Response, Slot, hooke_direct,
};
use crate::simd::Lane;
use alloc::borrow::ToOwned as _;
use core::f64::consts::PI;

/// k of linear laws.
pub const STIFFNESS: Key = Key {
    name: "stiffness",
    unit: "N/m",
    range: Range::Positive,
    required: true,
    example: "1e5",
    doc: "k_n; instead `characteristic_velocity` [m/s]: the speed at which two of the largest grains store as much as with \"hertz\"",
};
/// k_t/k of linear laws.
pub const TANGENTIAL_RATIO: Key = Key {
    name: "tangential_ratio",
    unit: "",
    range: Range::Positive,
    required: false,
    example: "0.8",
    doc: "k_t/k_n, of the `stiffness` or modulus as it is given; absent: 4 G*/E* of the materials (Mindlin)",
};

/// k_t of linear laws, as a number.
pub const TANGENTIAL_STIFFNESS: Key = Key {
    name: "tangential_stiffness",
    unit: "N/m",
    range: Range::Positive,
    required: false,
    example: "8e4",
    doc: "k_t, instead of `tangential_ratio`",
};

/// Keys that give k_t: without sliding friction nothing has it.
pub const TANGENTIAL: [&str; 2] = [TANGENTIAL_RATIO.name, TANGENTIAL_STIFFNESS.name];

/// k_t is given once.
pub fn contradiction(law: &ContactLaw) -> Option<Contradiction> {
    let both = law.number(TANGENTIAL_RATIO.name).and(law.number(TANGENTIAL_STIFFNESS.name));
    both.map(|_| Contradiction {
        key: TANGENTIAL_STIFFNESS.name,
        why: "is given, and tangential_ratio, too: both say what k_t is".to_owned(),
        cure: "take one of them out",
    })
}

/// What the program knows of it.
pub const DESCRIPTION: Description = Description {
    name: "hooke",
    doc: "linear spring and dashpot",
    slot: Slot::Normal,
    model: Some(Model { key: "law", value: "hooke", default: false }),
    keys: &[STIFFNESS, TANGENTIAL_RATIO, TANGENTIAL_STIFFNESS, RESTITUTION],
    picked: |law| !(hooke_direct::DESCRIPTION.picked)(law),
    contradiction,
    every_precision: true,
    normal: Some(NormalLaw {
        stiffest,
        reach: |_, _, _| 0.0,
        nominal: |_| 1.0,
        unloaded_overlap,
        stiffens: false,
        yields: false,
    }),
    ..Description::PLAIN
};

/// S = k.
fn stiffest(law: &ContactLaw, _: Elastic, _: OverlapLimit) -> f64 {
    law.number("stiffness").unwrap_or(f64::NAN)
}

/// 0 as long as C < k/2πR*: the pull grows as the spring does.
pub fn unloaded_overlap(law: &ContactLaw, _: Elastic, density: f64, [_, largest]: [f64; 2]) -> f64 {
    let stiffness = law.number("stiffness").unwrap_or(f64::NAN);
    if density < stiffness / (2.0 * PI * largest) || density == 0.0 { 0.0 } else { f64::INFINITY }
}

/// Linear spring and dashpot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hooke {
    /// k [N/m].
    pub stiffness: f64,
    /// γ.
    pub damping: Damping,
}

impl Hooke {
    /// That of a pair whose law asks for it.
    pub fn new(pair: &Pair) -> Hooke {
        Hooke { stiffness: pair.number("stiffness"), damping: pair.damping }
    }
}

impl Effect for Hooke {
    type History<R: Lane> = ();

    #[inline(always)]
    fn apply<R: Lane>(&self, contact: &Contact<R>, dt: R, _: &mut (), response: &mut Response<R>) {
        let k = R::splat(self.stiffness) * contact.share;
        response.impedance = (k * contact.mass).sqrt();
        let pace = k * contact.inverse_mass;
        let c = self.damping.of(pace, contact.partial) * response.impedance;
        spring_and_dashpot([k, c], self.damping.dissipates(pace), contact, dt, response);
    }
}

/// Adds the force of a spring k [N/m] and of a dashpot c [N s/m]; `dissipates` is the share of c v² Δt that is booked.
#[inline(always)]
pub fn spring_and_dashpot<R: Lane>(
    [k, c]: [R; 2],
    dissipates: R,
    contact: &Contact<R>,
    dt: R,
    response: &mut Response<R>,
) {
    let damping = c * contact.approach;
    response.normal = response.normal + (k * contact.overlap + damping);
    response.pressing = response.normal;
    response.stiffness = k;
    response.stiffness_before = contact.share_before;
    response.stiffness_last = k * contact.share_before;
    response.elastic = response.elastic + R::splat(0.5) * k * contact.present * contact.present;
    response.dissipate(DESCRIPTION.slot, damping * contact.approach * dt * dissipates);
}

numbers!(Hooke { stiffness: f64, damping: Damping });
