//! Blue-noise subsampling of a scanned surface, and the measures of how blue it is.
//!
//! ```text
//! poisson     maximal Poisson disk, loneliest point first        the default: distances at least the spacing
//! eliminate   weighted sample elimination                        an exact count
//! relax       Poisson disk, then Lloyd's relaxation on points    more even, less random
//! grid        the point nearest to each node of a cubic grid     equal intervals along x, y, z
//! ```
//!
//! Every method picks input points and moves none, gives the same result for any number of threads, and uses space,
//! not the surface: two sheets closer than the spacing are thinned as if they were one.

mod amount;
pub mod cells;
mod eliminate;
mod lattice;
pub mod nearest;
pub mod plot;
mod poisson;
mod relax;
pub mod spectrum;

use geom::Vec3;
use serde::Serialize;
use thiserror::Error;

pub use amount::median_density;
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
    /// The point nearest to each node of a cubic grid through the origin.
    Grid,
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
pub struct Wish {
    /// How many.
    pub amount: Amount,
    /// How they are chosen.
    pub method: Method,
    /// Seed of chance.
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
}

/// What sampling refuses.
#[derive(Debug, Error, PartialEq)]
#[allow(missing_docs)]
pub enum SampleError {
    #[error("the cloud has no points: nothing to sample; check the step before")]
    Empty,
    #[error(
        "point {index}: coordinates ({x}, {y}, {z}) m are not finite: remove it first, e.g. with cloud-crop"
    )]
    NotFinite { index: usize, x: f64, y: f64, z: f64 },
    #[error("spacing {0} m: must be a positive length")]
    Spacing(f64),
    #[error("count 0: must be at least 1")]
    NoCount,
    #[error("count {asked}: only {there} points are there; ask for at most that many")]
    Count { asked: usize, there: usize },
    #[error("density {low},{high} points/m²: must be positive numbers, the lower one first")]
    Density { low: f64, high: f64 },
    #[error(
        "count {asked}: {distinct} distinct points were found, the rest are duplicates; ask for at most that many"
    )]
    Duplicates { asked: usize, distinct: usize },
    #[error("method {method} with {amount}: not available yet; use {instead}")]
    Unavailable { method: &'static str, amount: &'static str, instead: &'static str },
    #[error("{forced} points must be kept as they are, but only {there} points are in the cloud")]
    Forced { forced: usize, there: usize },
}

/// Chooses points of a cloud [m]; those with `forced` set are all kept, and count.
///
/// # Errors
/// No points, coordinates that are not finite, an amount that cannot be met.
pub fn sample(points: &[Vec3], forced: Option<&[bool]>, wish: &Wish) -> Result<Sample, SampleError> {
    check(points, forced, wish)?;
    match wish.method {
        Method::Poisson => amount::poisson_of(points, forced, wish.amount, wish.seed),
        Method::Relax => relax::relax(points, forced, wish),
        Method::Eliminate => eliminate::eliminate(points, forced, wish),
        Method::Grid => lattice::lattice(points, forced, wish.amount),
    }
}

fn check(points: &[Vec3], forced: Option<&[bool]>, wish: &Wish) -> Result<(), SampleError> {
    if points.is_empty() {
        return Err(SampleError::Empty);
    }
    if let Some(index) = points.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
        let p = points[index];
        return Err(SampleError::NotFinite { index, x: p.x, y: p.y, z: p.z });
    }
    if let Some(forced) = forced.filter(|f| f.len() != points.len()) {
        return Err(SampleError::Forced { forced: forced.len(), there: points.len() });
    }
    if let Amount::Count(asked) = wish.amount
        && asked > points.len()
    {
        return Err(SampleError::Count { asked, there: points.len() });
    }
    check_wish(wish)
}

/// Checks what can be checked without the points.
///
/// # Errors
/// Lengths, counts and densities that are not positive; a method that does not take the amount.
pub fn check_wish(wish: &Wish) -> Result<(), SampleError> {
    match wish.amount {
        Amount::Spacing(r) if !(r > 0.0 && r.is_finite()) => Err(SampleError::Spacing(r)),
        Amount::Count(0) => Err(SampleError::NoCount),
        Amount::Count(_) | Amount::Density(..) if wish.method == Method::Grid => {
            Err(SampleError::Unavailable {
                method: "grid",
                amount: "a count or a density",
                instead: "--spacing",
            })
        }
        Amount::Density(low, high) if !(low > 0.0 && high >= low && high.is_finite()) => {
            Err(SampleError::Density { low, high })
        }
        _ => Ok(()),
    }
}
