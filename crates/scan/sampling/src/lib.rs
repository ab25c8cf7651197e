//! Blue-noise subsampling of a scanned surface, and measures of its quality.
//!
//! ```text
//! poisson     maximal Poisson disk, most isolated point first        the default: distances at least the spacing
//! eliminate   weighted sample elimination                        an exact count
//! relax       Poisson disk, then Lloyd's relaxation on points    more even, less random
//! tile        a pattern laid on patch by patch, seams closed     the pattern's evenness
//! grid        the point nearest to each node of a cubic grid     equal intervals along x, y, z
//! ```
//!
//! Every method picks input points and does not move them. It gives the same result for any number of threads. Where another sheet is
//! nearer than the spacing, distances can be those along the surface (the grid always works in space).

mod amount;
mod beside;
mod crowding;
mod eliminate;
mod lattice;
pub mod nearest;
mod poisson;
mod relax;
mod sheets;
pub mod spectrum;
mod tile;
mod torus;

use geom::Vec3;
use serde::Serialize;
use thiserror::Error;

pub use amount::median_density;
pub use geom::cells;
pub use nearest::{NearestDistances, nearest_distances};
pub use spectrum::{Spectrum, spectrum};

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
    /// How many.
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

impl Sample {
    fn of(thrown: beside::Thrown, spacing: f64, tries: usize) -> Sample {
        Sample { kept: thrown.kept, spacing, tries, beside: thrown.beside }
    }
}

/// What sampling refuses.
#[derive(Debug, Error, PartialEq)]
#[allow(missing_docs)]
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

/// Chooses points of a cloud [m]; those with `forced` set are all kept, and count.
///
/// # Errors
/// No points, coordinates that are not finite, an amount that cannot be met.
pub fn sample(
    points: &[Vec3],
    forced: Option<&[bool]>,
    settings: &SampleSettings,
) -> Result<Sample, SampleError> {
    check(points, forced, settings)?;
    match settings.method {
        Method::Poisson | Method::Tile | Method::Grid => amount::sample_of(points, forced, settings),
        Method::Relax => relax::relax(points, forced, settings),
        Method::Eliminate => eliminate::eliminate(points, forced, settings),
    }
}

fn check(points: &[Vec3], forced: Option<&[bool]>, settings: &SampleSettings) -> Result<(), SampleError> {
    if points.is_empty() {
        return Err(SampleError::Empty);
    }
    if let Some(index) = points.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
        let p = points[index];
        return Err(SampleError::NotFinite { index, x: p.x, y: p.y, z: p.z });
    }
    if let Some(forced) = forced.filter(|f| f.len() != points.len()) {
        return Err(SampleError::Forced { marks: forced.len(), there: points.len() });
    }
    if let Amount::Count(asked) = settings.amount
        && asked > points.len()
    {
        return Err(SampleError::Count { asked, there: points.len() });
    }
    check_settings(settings)
}

/// Checks what can be checked without the points.
///
/// # Errors
/// Lengths, counts and densities that are not positive.
pub fn check_settings(settings: &SampleSettings) -> Result<(), SampleError> {
    match settings.amount {
        Amount::Spacing(r) if !(r > 0.0 && r.is_finite()) => Err(SampleError::Spacing(r)),
        Amount::Count(0) => Err(SampleError::NoCount),
        Amount::Density(low, high) if !(low > 0.0 && high >= low && high.is_finite()) => {
            Err(SampleError::Density { low, high })
        }
        _ => Ok(()),
    }
}
