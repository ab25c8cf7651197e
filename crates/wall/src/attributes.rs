//! What a wall sphere is made of, and how it moves.

use geom::Vec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use thiserror::Error;

/// A material; what is absent is left to the scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
pub struct Material {
    /// Name, by which scenes speak of it.
    pub name: String,
    /// Young's modulus [Pa].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub young: Option<f64>,
    /// Poisson's ratio [–].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub poisson: Option<f64>,
    /// Coefficient of sliding friction [–].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// Coefficient of restitution [–].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
}

/// An attribute that cannot be.
#[derive(Debug, Error, PartialEq)]
#[allow(missing_docs)]
pub enum AttributeError {
    #[error("{place}: {what} {value}: must be {range}")]
    Range { place: String, what: &'static str, value: f64, range: &'static str },
    #[error("{place}: material '{name}' has two sets of values: give one of the two another name")]
    TwoOfOneName { place: String, name: String },
    #[error("{place}: the material has no name: give it one, so that the scene can speak of it")]
    NoName { place: String },
}

impl Material {
    /// Checks the values; `place` says where they stand.
    ///
    /// # Errors
    /// A value outside its range.
    pub fn check(&self, place: &str) -> Result<(), AttributeError> {
        let range = |what, value: Option<f64>, fits: fn(f64) -> bool, range| match value {
            Some(value) if !fits(value) => {
                Err(AttributeError::Range { place: place.to_owned(), what, value, range })
            }
            _ => Ok(()),
        };
        if self.name.is_empty() {
            return Err(AttributeError::NoName { place: place.to_owned() });
        }
        range("young [Pa]", self.young, |x| x > 0.0 && x.is_finite(), "positive")?;
        range("poisson", self.poisson, |x| x > -1.0 && x <= 0.5, "above -1 and at most 0.5")?;
        range("friction", self.friction, |x| x >= 0.0 && x.is_finite(), "0 or more")?;
        range("restitution", self.restitution, |x| (0.0..=1.0).contains(&x), "from 0 to 1")
    }
}

/// Checks a velocity [m/s].
///
/// # Errors
/// Components that are not finite.
pub fn check_velocity(velocity: &Vec3, place: &str) -> Result<(), AttributeError> {
    match velocity.iter().find(|c| !c.is_finite()) {
        Some(&value) => Err(AttributeError::Range {
            place: place.to_owned(),
            what: "velocity [m/s]",
            value,
            range: "finite",
        }),
        None => Ok(()),
    }
}

/// The metadata record `materials`: number → JSON.
pub fn record(materials: &[Material]) -> BTreeMap<String, String> {
    let json = |m: &Material| serde_json::to_string(m).unwrap_or_default();
    materials.iter().enumerate().map(|(n, m)| (n.to_string(), json(m))).collect()
}
