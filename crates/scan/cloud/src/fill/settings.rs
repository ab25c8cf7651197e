//! What to fill and how, and why a cloud cannot be filled.

use super::darts::Method;
use super::mesh::cover::Mesher;
use crate::points::TooFar;
use geom::{Shape, Vec3};
use thiserror::Error;

/// Most points that are added.
pub(crate) const MOST: f64 = 5e7;

/// What to fill and how.
#[derive(Debug, Clone, Default)]
pub struct Settings {
    /// Least distance of added points [m]; as dense as the surroundings when not given.
    pub spacing: Option<f64>,
    /// Holes are where the density is at most this [1/m²]; a quarter of the density around when not given.
    pub below: Option<f64>,
    /// The spacing that will be asked for [m]: surface that the scan is too sparse for is filled, too.
    pub for_spacing: Option<f64>,
    /// Fill only in these shapes, and there whatever the outline.
    pub regions: Vec<Shape>,
    /// Where scanners stood [m], beside the viewpoints that the cloud states.
    pub seen_from: Vec<Vec3>,
    /// Whether holes between two surfaces are filled, too, where no viewpoint is known.
    pub bridge: bool,
    /// Widest hole to fill [m]; a fifth of the cloud's diagonal when not given.
    pub max_hole: Option<f64>,
    /// How points are spread.
    pub method: Method,
    /// How holes are meshed.
    pub mesher: Mesher,
    /// Radii of the balls that mesh a hole [m], growing; fitted to each hole when empty.
    pub balls: Vec<f64>,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Why a cloud cannot be filled.
#[derive(Debug, Error, PartialEq)]
pub enum FillError {
    /// A point so far away that its distances cannot be computed with.
    #[error(transparent)]
    TooFar(#[from] TooFar),
    /// A spacing so small that memory would not hold the points.
    #[error(
        "a spacing of {spacing} m puts {points:.1e} points into the holes, more than {MOST:.0e}: give a wider spacing"
    )]
    TooMany {
        /// Least distance of added points [m].
        spacing: f64,
        /// Points wanted.
        points: f64,
    },
    /// A spacing so small that memory would not hold the points of the sparse surface.
    #[error(
        "for a spacing of {spacing} m the surface needs {points:.1e} more points, more than {MOST:.0e}: give a wider spacing; is the \
         cloud in millimetres?"
    )]
    TooManySparse {
        /// The spacing that will be asked for [m].
        spacing: f64,
        /// Points wanted.
        points: f64,
    },
}
