//! Sliding friction that weakens with the speed of sliding (`sliding_friction = { static, dynamic, speed }`): an example of a
//! coefficient that depends on the state of its contact.
//!
//! ```text
//! μ(v) = μ_d + (μ_s − μ_d) / (1 + (|v_t|/v_c)²)          μ_s at rest, half-way at v_c, μ_d far above
//! ```
//!
//! Hess & Soom (1990), J. Tribology 112(1), doi:10.1115/1.2920220, without the viscous term.

use super::damping::TANGENTIAL_DAMPING;
use super::numbers::numbers;
use super::sliding_friction::SPRING;
use super::{Coefficient, Contact, ContactLaw, Contradiction, Description, Key, Range, Slot};
use crate::simd::Lane;
use alloc::format;

/// What the program knows of it.
pub const DESCRIPTION: Description = Description {
    name: "weakening friction",
    doc: "sliding friction μ_d + (μ_s − μ_d)/(1 + (v/v_c)²), of `{ static, dynamic, speed }`",
    slot: Slot::Sliding,
    keys: &[
        Key {
            name: "sliding_friction.static",
            unit: "",
            range: Range::UpTo(1e3),
            required: true,
            example: "0.6",
            doc: "μ_s, at rest",
        },
        Key {
            name: "sliding_friction.dynamic",
            unit: "",
            range: Range::UpTo(1e3),
            required: true,
            example: "0.4",
            doc: "μ_d, far above the speed",
        },
        Key {
            name: "sliding_friction.speed",
            unit: "m/s",
            range: Range::Positive,
            required: true,
            example: "0.01",
            doc: "v_c, where friction is half-way",
        },
        TANGENTIAL_DAMPING,
    ],
    history: &[SPRING],
    idle: |law| {
        ["sliding_friction.static", "sliding_friction.dynamic"].iter().all(|k| law.number(k) == Some(0.0))
    },
    contradiction,
    ..Description::PLAIN
};

fn contradiction(law: &ContactLaw) -> Option<Contradiction> {
    let [at_rest, sliding] =
        ["sliding_friction.static", "sliding_friction.dynamic"].map(|key| law.number(key));
    (sliding > at_rest).then(|| Contradiction {
        key: "sliding_friction.dynamic",
        why: format!("is above static = {}: friction weakens with speed", at_rest.unwrap_or(0.0)),
        cure: "swap them, or give one number for both",
    })
}

/// μ(v).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weakening {
    /// μ_s [–].
    pub at_rest: f64,
    /// μ_d [–].
    pub sliding: f64,
    /// v_c [m/s].
    pub speed: f64,
}

impl Coefficient for Weakening {
    #[inline(always)]
    fn of<R: Lane>(&self, contact: &Contact<R>) -> R {
        let square = R::splat(1.0 / (self.speed * self.speed)) * contact.slip.dot(contact.slip);
        R::splat(self.sliding) + R::splat(self.at_rest - self.sliding) / (R::splat(1.0) + square)
    }
}

numbers!(Weakening { at_rest: f64, sliding: f64, speed: f64 });
