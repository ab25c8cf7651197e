//! Sliding friction in full: a coefficient that is constant or weakens with speed, and the dashpot of the normal law or a given one.
//!
//! ```text
//! c_t = γ √(k_t m*)      with `restitution`
//! c_t = η_t              with `tangential_damping`
//! c_t = η_n √(k_t/k_n)   with `normal_damping` alone: the share that a restitution would give it
//! ```

use super::damping::{NORMAL_DAMPING, TANGENTIAL_DAMPING};
use super::numbers::numbers;
use super::sliding_friction::{self, COEFFICIENT};
use super::weakening::Weakening;
use super::{Coefficient, Contact, ContactLaw, Description, Pair, tangential_ratio};
use crate::simd::Lane;
use alloc::format;

/// What the program knows of constant friction whose dashpot is given.
pub const WITH_DASHPOT: Description = Description {
    name: "sliding friction with a dashpot",
    doc: "sliding friction whose dashpot is given directly",
    keys: &[COEFFICIENT, TANGENTIAL_DAMPING],
    picked: own_dashpot,
    every_precision: false,
    ..sliding_friction::DESCRIPTION
};

/// Whether a law's tangential dashpot is not that of its restitution.
pub fn own_dashpot(law: &ContactLaw) -> bool {
    [&TANGENTIAL_DAMPING, &NORMAL_DAMPING].iter().any(|key| law.number(key.name).is_some())
}

/// μ and c_t of a pair. Which, is a branch for each group of contacts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    coefficient: Mu,
    /// η_t; `None`: the law's [N s/m].
    dashpot: Option<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Mu {
    Constant(f64),
    Weakening(Weakening),
}

impl Friction {
    /// Of a pair whose law asks for friction.
    pub fn of(pair: &Pair) -> Friction {
        let [at_rest, sliding, speed] =
            ["static", "dynamic", "speed"].map(|key| pair.number(&format!("sliding_friction.{key}")));
        let weakening = Mu::Weakening(Weakening { at_rest, sliding, speed });
        let of_normal = || {
            let ratio = tangential_ratio(pair.law, pair.elastic);
            Some(pair.law.number(NORMAL_DAMPING.name)? * ratio.sqrt())
        };
        Friction {
            coefficient: pair.law.number(COEFFICIENT.name).map_or(weakening, Mu::Constant),
            dashpot: pair.law.number(TANGENTIAL_DAMPING.name).or_else(of_normal),
        }
    }
}

impl Coefficient for Friction {
    #[inline(always)]
    fn of<R: Lane>(&self, contact: &Contact<R>) -> R {
        match self.coefficient {
            Mu::Constant(mu) => mu.of(contact),
            Mu::Weakening(mu) => mu.of(contact),
        }
    }

    #[inline(always)]
    fn dashpot<R: Lane>(&self, of_law: R) -> R {
        match self.dashpot {
            None => of_law,
            Some(given) => R::splat(given),
        }
    }
}

numbers!(Friction { coefficient: Mu, dashpot: Option<f64> });
numbers!(Mu: Constant(f64) or Weakening(Weakening));
