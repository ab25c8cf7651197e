//! What effects are made of: the numbers of a contact law, and what follows from its two materials.

use super::damping::{Damping, damping_ratio};
use super::law::ContactLaw;
use super::material::{Compliance, Elastic};
use super::registry::active;

/// A contact law, and what follows from its two materials.
#[derive(Debug, Clone, Copy)]
pub struct Pair<'a> {
    /// The law.
    pub law: &'a ContactLaw,
    /// Constants of the materials.
    pub elastic: Elastic,
    /// Compliance of the clumps of both materials over that of spheres of their mass.
    pub compliance: Compliance,
    /// Damping of the normal law.
    pub damping: Damping,
}

impl Pair<'_> {
    /// A number of the law; NaN, which checks refuse, where it is absent.
    pub fn number(&self, key: &str) -> f64 {
        self.law.number(key).unwrap_or(f64::NAN)
    }

    /// γ of sliding [–].
    pub fn damping_ratio(&self) -> f64 {
        damping_ratio(self.number("restitution"))
    }
}

/// k_t over S [–], the stiffness that effects see of the normal law: k_t/k_n is given, or Mindlin's, and k_n may be another one than S.
pub fn tangential_ratio(law: &ContactLaw, elastic: Elastic) -> f64 {
    let of_stiffness = || Some(law.number("tangential_stiffness")? / law.number("stiffness")?);
    let given = law.number("tangential_ratio").or_else(of_stiffness).unwrap_or(elastic.tangential_ratio);
    given * active(law).find_map(|d| d.normal).map_or(1.0, |normal| (normal.nominal)(law))
}
