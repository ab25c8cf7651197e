//! Why a text is no table of regions.

use super::attributes::AttributeError;
use super::wear::WearError;
use geom::shape::ShapeError;
use thiserror::Error;

/// Why a file is no table of regions.
#[derive(Debug, Error)]
pub enum RegionsError {
    #[error("{0}")]
    Toml(#[from] toml::de::Error),
    #[error(transparent)]
    Wear(#[from] WearError),
    #[error("region {number} '{name}': {source}")]
    Shape { number: usize, name: String, source: Box<ShapeError> },
    #[error("{place}: roughness {value} m: must be positive")]
    Roughness { place: String, value: f64 },
    #[error(transparent)]
    Attribute(#[from] AttributeError),
    #[error(
        "{place}: give shape, or column and values, or all three: without them the region holds no point"
    )]
    NoPlace { place: String },
    #[error("{place}: {given} without {missing}: column and values choose points together")]
    HalfColumn { place: String, given: &'static str, missing: &'static str },
    #[error("{place}: values = {values:?}: give the smallest, then the largest value")]
    Values { place: String, values: [f64; 2] },
    #[error("{place}: the cloud has no property '{column}': see the file's header")]
    NoColumn { place: String, column: String },
    #[error(
        "{place}: no point has '{column}' from {} to {}; its values are {} to {}: the region would change nothing",
        values[0], values[1], found[0], found[1]
    )]
    NoneInRange { place: String, column: String, values: [f64; 2], found: [f64; 2] },
    #[error(
        "{place}: {property} = [A, B] changes along a column: give column and values = [smallest, largest], or one value"
    )]
    AlongNothing { place: String, property: &'static str },
    #[error("{place}: steps changes nothing: no property has two values, such as friction = [0.3, 0.8]")]
    StepsOfNothing { place: String },
    #[error("{place}: steps = {steps}: must be 2 to {most}")]
    Steps { place: String, steps: u32, most: u32 },
    #[error("more than 65535 regions")]
    TooMany,
}
