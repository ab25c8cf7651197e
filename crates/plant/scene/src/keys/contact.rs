//! Materials, and what they do to each other.

use super::table::table;
use dem::setup::ContactLaw;

table! {
    /// `[[material]]`
    Material section {
        /// Name.
        name: String = required, "", Name, "\"glass\"";
        /// Density; only grains need it.
        density: Option<f64> = absent("–"), "kg/m³", Positive, "2500";
        /// Young's modulus.
        young: f64 = required, "Pa", Positive, "1e7";
        /// Poisson's ratio.
        poisson: f64 = required, "", Poisson, "0.25";
    }
}

/// `[[contact]]`
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// Two names of materials; "*" stands for every one.
    pub between: [String; 2],
    /// Models and numbers as the engine has them; its materials are not known yet.
    pub law: ContactLaw,
    /// Speed of impact at which a linear law is as deep as "hertz" [m/s], instead of `stiffness`.
    pub characteristic_velocity: Option<f64>,
}
