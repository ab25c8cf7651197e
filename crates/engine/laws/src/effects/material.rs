//! What materials bring to a contact: elastic constants, how deep it may be, how compliant clumps are.

use alloc::string::String;
use serde::{Deserialize, Serialize};

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

/// Compliance of the most compliant clump of two materials, with all its contacts, over that of a sphere of its mass with twelve [–].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compliance {
    /// To contacts alone; 1 without clumps, and walls of spheres that lie deep within each other.
    pub clumps: f64,
    /// The same for the pace of tangential springs. Where bonds set it, which know nothing of the stiffness of contacts, so much that the springs are always late by
    /// half a step.
    pub springs: f64,
}
