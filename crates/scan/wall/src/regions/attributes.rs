//! What a wall sphere is made of, and how it moves.

use geom::Vec3;
use record::{MaterialRecord, POISSON, is_poisson, name};
use thiserror::Error;

/// An attribute that cannot be.
#[derive(Debug, Error, PartialEq)]
pub enum AttributeError {
    #[error("{place}: {what} {value}: must be {range}")]
    Range { place: String, what: &'static str, value: f64, range: &'static str },
    #[error("{place}: material '{name}' has two sets of values: give one of the two another name")]
    TwoOfOneName { place: String, name: String },
    #[error("{place}: the name {name:?} has {}: {}", name::in_words(*c), name::CURE)]
    ControlCharacter { place: String, name: String, c: char },
    #[error("{place}: the material has no name: give it one, so that the scene can refer to it")]
    NoName { place: String },
}

/// Checks the values of a material; `place` says where they stand.
///
/// # Errors
/// A value outside its range.
pub fn check_material(material: &MaterialRecord, place: &str) -> Result<(), AttributeError> {
    let range = |what, value: Option<f64>, fits: fn(f64) -> bool, range| match value {
        Some(value) if !fits(value) => {
            Err(AttributeError::Range { place: place.to_owned(), what, value, range })
        }
        _ => Ok(()),
    };
    if material.name.is_empty() {
        return Err(AttributeError::NoName { place: place.to_owned() });
    }
    if let Some(c) = name::forbidden(&material.name) {
        let (place, name) = (place.to_owned(), material.name.clone());
        return Err(AttributeError::ControlCharacter { place, name, c });
    }
    range("young [Pa]", material.young, |x| x > 0.0 && x.is_finite(), "positive")?;
    range("poisson", material.poisson, is_poisson, POISSON)?;
    range("friction", material.friction, |x| x >= 0.0 && x.is_finite(), "0 or more")?;
    range("restitution", material.restitution, |x| (0.0..=1.0).contains(&x), "from 0 to 1")
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
