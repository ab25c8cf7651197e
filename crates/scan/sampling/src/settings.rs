//! What is asked for, what was chosen, and what is refused.

use serde::Serialize;
use thiserror::Error;

/// How points are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Maximal Poisson disk.
    #[default]
    Poisson,
    /// Weighted sample elimination.
    Eliminate,
    /// Poisson disk, then relaxation.
    Relax,
    /// A pattern made beforehand, laid onto the surface patch by patch, its seams closed.
    Tile,
    /// The point nearest to each node of a cubic grid through the origin.
    Grid,
}

/// Which distances count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Distance {
    /// Along the surface, where another sheet is nearer than the spacing.
    Surface,
    /// In space: what is near on another sheet is near.
    #[default]
    Space,
}

/// How many points are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Amount {
    /// Least distance between kept points (grid: distance between nodes) [m].
    Spacing(f64),
    /// Number of kept points.
    Count(usize),
    /// Lowest and highest number of kept points per area [1/m²].
    Density(f64, f64),
}

/// What is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampleSettings {
    pub amount: Amount,
    /// How they are chosen.
    pub method: Method,
    /// Which distances count.
    pub distance: Distance,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// The points that were chosen.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Indices of the kept points, ascending.
    pub kept: Vec<u32>,
    /// The spacing in force [m]: no two points that were chosen are nearer (poisson), or the one it started from.
    pub spacing: f64,
    /// Samplings it took to find the spacing.
    pub tries: usize,
    /// Points that are there because a nearer one lies on another sheet.
    pub beside: usize,
}

/// What sampling refuses.
#[derive(Debug, Error, PartialEq)]
pub enum SampleError {
    #[error("the cloud has no points: nothing to sample; check the previous tool")]
    Empty,
    #[error(
        "point {index}: coordinates ({x}, {y}, {z}) m are not finite: remove it first, e.g. with cloud-crop"
    )]
    NotFinite { index: usize, x: f64, y: f64, z: f64 },
    #[error("spacing {0} m: must be a positive length")]
    Spacing(f64),
    #[error("count 0: must be at least 1")]
    NoCount,
    #[error("count {asked}: there are only {there} points; ask for at most that many")]
    Count { asked: usize, there: usize },
    #[error("density {low},{high} points/m²: must be positive numbers, the lower one first")]
    Density { low: f64, high: f64 },
    #[error(
        "count {asked}: {distinct} distinct points were found, the rest are duplicates; ask for at most that many"
    )]
    Duplicates { asked: usize, distinct: usize },
    #[error("{forced} points must be kept, which is more than the count {count}: ask for at least as many")]
    TooManyForced { forced: usize, count: usize },
    #[error("marks of {marks} points are given for a cloud of {there}")]
    Forced { marks: usize, there: usize },
}
