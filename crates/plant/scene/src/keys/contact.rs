//! Materials, and what they do to each other.

use super::unit;
use dem::setup::ContactLaw;
use serde::Deserialize;

/// `[[material]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Name.
    pub name: String,
    /// Density [kg/m³]; walls need none.
    #[serde(default, deserialize_with = "unit::density")]
    pub density: Option<f64>,
    /// Young's modulus [Pa].
    #[serde(deserialize_with = "unit::pascals")]
    pub young: f64,
    /// Poisson's ratio [–].
    #[serde(deserialize_with = "unit::plain")]
    pub poisson: f64,
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
