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

/// `[[bond]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bond {
    /// Two names of materials.
    pub between: [String; 2],
    /// Largest gap between two surfaces at t = 0 that is bonded [m].
    #[serde(deserialize_with = "unit::metres")]
    pub gap: f64,
    /// Radius of a bond over the smaller of both particles' [–]; absent: 1.
    #[serde(default, deserialize_with = "unit::plain")]
    pub radius_ratio: Option<f64>,
    /// Young's modulus of bonds [Pa].
    #[serde(deserialize_with = "unit::pascals")]
    pub young: f64,
    /// Their Poisson's ratio [–], for the shear modulus.
    #[serde(deserialize_with = "unit::plain")]
    pub poisson: f64,
    /// Tension at the rim that breaks one [Pa]; absent: none does.
    #[serde(default, deserialize_with = "unit::pascals")]
    pub tensile_strength: Option<f64>,
    /// Shear that breaks one [Pa]; absent: none does.
    #[serde(default, deserialize_with = "unit::pascals")]
    pub shear_strength: Option<f64>,
    /// γ of dashpots beside the springs [–]; absent: none.
    #[serde(default, deserialize_with = "unit::plain")]
    pub damping: Option<f64>,
}
