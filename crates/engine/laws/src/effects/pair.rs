//! What effects are made of: the numbers of a contact law, and what follows from its two materials.

use super::friction::TANGENTIAL_DAMPING;
use super::{ContactLaw, Damping, NORMAL_DAMPING, RESTITUTION, active};
use crate::float::Float;
use alloc::string::String;
use serde::{Deserialize, Serialize};

/// Elastic constants of a pair.
///
/// ```text
/// 1/E* = (1 − ν_i²)/E_i + (1 − ν_j²)/E_j,   1/G* = (2 − ν_i)/G_i + (2 − ν_j)/G_j,   G = E / 2(1 + ν)
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// E* [Pa].
    pub modulus: f64,
    /// Tangential over normal stiffness at the same overlap, 4 G*/E* [–].
    pub tangential_ratio: f64,
}

impl Elastic {
    /// Constants of two materials in contact.
    pub fn of(a: &Material, b: &Material) -> Elastic {
        let compliance = |m: &Material| (1.0 - m.poisson * m.poisson) / m.young;
        let shear = |m: &Material| 2.0 * (1.0 + m.poisson) * (2.0 - m.poisson) / m.young;
        let modulus = 1.0 / (compliance(a) + compliance(b));
        Elastic { modulus, tangential_ratio: 4.0 / (shear(a) + shear(b)) / modulus }
    }
}

/// Largest overlap of a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OverlapLimit {
    /// R* [m].
    pub radius: f64,
    /// The smaller radius [m].
    pub smaller: f64,
    /// Largest overlap over the smaller radius [–].
    pub share: f64,
}

impl OverlapLimit {
    /// That overlap [m].
    pub fn overlap(&self) -> f64 {
        self.share * self.smaller
    }
}

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

/// Elastic constants and density.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Name, for messages.
    pub name: String,
    /// Density [kg/m³]; of no effect for walls.
    pub density: f64,
    /// Young's modulus [Pa].
    pub young: f64,
    /// Poisson's ratio [–].
    pub poisson: f64,
}

/// Compliance of the most compliant clump of two materials, with all its contacts, over that of a sphere of its mass with twelve [–].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compliance {
    /// To contacts alone; 1 without clumps, and walls of spheres that lie deep within each other.
    pub clumps: f64,
    /// The same for the pace of tangential springs. Where bonds set it, which know nothing of the stiffness of contacts, so much that the springs are always late by
    /// half a step.
    pub springs: f64,
}
