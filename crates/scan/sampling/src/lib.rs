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
mod settings;
mod sheets;
pub mod spectrum;
mod tile;
mod torus;

use geom::Vec3;

pub use amount::median_density;
pub use geom::cells;
pub use nearest::{NearestDistances, nearest_distances};
pub use settings::{Amount, Distance, Method, Sample, SampleError, SampleSettings};
pub use spectrum::{Spectrum, spectrum};

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
