//! Sliding friction that weakens with the speed of sliding (`sliding_friction = { static, dynamic, speed }`): an example of a
//! coefficient that depends on the state of its contact.
//!
//! ```text
//! μ(v) = μ_d + (μ_s − μ_d) / (1 + (|v_t|/v_c)²)          μ_s at rest, half-way at v_c, μ_d far above
//! ```
//!
//! Hess & Soom (1990), J. Tribology 112(1), doi:10.1115/1.2920220, without the viscous term.

use super::{Coefficient, Contact};
use crate::lane::Lane;

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

/// A coefficient that may be either, which is asked for each group of contacts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Friction {
    /// μ [–].
    Constant(f64),
    /// μ(v).
    Weakening(Weakening),
}

impl Coefficient for Friction {
    #[inline(always)]
    fn of<R: Lane>(&self, contact: &Contact<R>) -> R {
        match self {
            Friction::Constant(mu) => mu.of(contact),
            Friction::Weakening(mu) => mu.of(contact),
        }
    }
}
