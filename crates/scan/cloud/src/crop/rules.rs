//! What a crop is asked for: shapes, regions and rules.

use super::marks::MARK;
use super::rule::filter::{Filter, FilterError};
use super::rule::ground::{Ground, GroundError};
use super::rule::outer::Outer;
use super::rule::outliers::Outliers;
use super::rule::scatter::{Scattered, TooWide};
use crate::points::TooFar;
use geom::{Shape, Vec3};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// All rules of one crop.
#[derive(Debug, Clone, Default)]
pub struct Rules {
    /// Keep the points of these shapes; all when there is none.
    pub keep: Vec<Shape>,
    /// Remove the points of these shapes.
    pub remove: Vec<Shape>,
    /// Named regions to keep and to remove; they count as the shapes above do.
    pub regions: Vec<Region>,
    /// Remove what lies beyond the outer shape, when one is described.
    pub outer: Outer,
    /// Keep points whose properties fulfil this condition.
    pub condition: Option<Filter>,
    /// Keep points farther apart than this [m]; with 0, one of each place.
    pub distinct: Option<f64>,
    /// Remove points far from their neighbours.
    pub outliers: Option<Outliers>,
    /// Remove points whose surface every viewpoint sees at more than this angle to its normal [°].
    pub grazing: Option<f64>,
    /// Where scanners stood [m], beside the viewpoints that the cloud states.
    pub seen_from: Vec<Vec3>,
    /// Remove the ground.
    pub ground: Option<Ground>,
    /// Remove points that lie on no surface.
    pub scattered: Option<Scattered>,
    /// Keep only the largest part whose points are connected by steps of at most this [m].
    pub largest: Option<f64>,
    /// What the rules below the outer shape, or marks, remove in these shapes stays.
    pub restore: Vec<Shape>,
    /// Keep all points, and mark those that would go ([`MARK`]).
    pub mark: bool,
}

impl Rules {
    /// Whether no point can go.
    pub fn removes_nothing(&self) -> bool {
        let shapes = self.keep.len() + self.remove.len() + self.regions.len() + self.outer.shapes.len();
        shapes == 0 && self.condition.is_none() && !self.measure()
    }

    /// Whether a rule looks at points together.
    pub(crate) fn measure(&self) -> bool {
        self.distinct.is_some()
            || self.outliers.is_some()
            || self.grazing.is_some()
            || self.ground.is_some()
            || self.scattered.is_some()
            || self.largest.is_some()
    }
}

/// What is done with the points of a region.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Action {
    /// Its points stay, and what is in no such region goes.
    Keep,
    /// Its points go.
    Remove,
    /// It is a piece of the outer shape of the equipment.
    Outer,
}

/// A named part of the plant.
#[derive(Debug, Clone)]
pub struct Region {
    /// Name in the file of regions.
    pub name: String,
    /// The points of the region are those inside this shape.
    pub shape: Shape,
    /// What is done with its points.
    pub action: Action,
}

/// Why a cloud cannot be cropped.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CropError {
    #[error("--where: {0}")]
    Condition(#[from] FilterError),
    #[error(transparent)]
    TooFar(#[from] TooFar),
    #[error(transparent)]
    Ground(#[from] GroundError),
    #[error(transparent)]
    Scattered(#[from] TooWide),
    #[error("--grazing: the cloud states no viewpoint: give --seen-from x,y,z, where the scanner stood")]
    NoViewpoint,
    #[error(
        "--restore: nothing is removed that could be restored: give a rule such as --ground (shapes are not undone), or a cloud with marks (--mark)"
    )]
    NothingToRestore,
    #[error(
        "--mark: no rule is given, and the cloud has no marks, so nothing would be marked: add --ground, --outliers …"
    )]
    NothingToMark,
    #[error("--mark: the cloud has a property '{MARK}' that --mark did not write: rename it first")]
    OtherMarks,
}
