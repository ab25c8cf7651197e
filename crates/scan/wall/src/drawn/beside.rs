//! A drawing beside a scan: its surface stands in where the scan has no points.
//!
//! Positions close together on the drawing and the points of the scan are thinned as one cloud (Poisson disk), in which every point of the
//! scan is kept.

use super::candidate::MOST;
use super::sides;
use crate::settings::WallError;
use geom::{Grid, Vec3, mesh::TriMesh};
use rayon::prelude::*;
use sampling::{Amount, Distance, Method, SampleSettings};

/// Least distance of a position of the drawing from the points of the scan, in distances of neighbours: as near as Poisson-disk samples are.
const CLOSEST: f64 = 0.73;
/// Positions that are chosen from, in a square of the distance of neighbours.
const DENSE: f64 = 30.0;

/// What a drawing adds to a scan.
#[derive(Debug, Clone, PartialEq)]
pub struct Beside {
    /// Positions on the drawing's surface where the scan has no points [m].
    pub positions: Vec<Vec3>,
    /// The point of the scan nearest to each.
    pub nearest: Vec<u32>,
    /// Share of the scan's points that are farther from the drawing than the distance of neighbours [–].
    pub off: f64,
}

/// Positions on the drawing where `points` [m], whose neighbours are `spacing` [m] apart, leave it free.
///
/// # Errors
/// A mesh without area, or far too large for the spacing.
pub fn beside(mesh: &TriMesh, points: &[Vec3], spacing: f64) -> Result<Beside, WallError> {
    let surface = sides::DrawnSurface::new(mesh, None).ok_or(WallError::NoArea)?;
    let wanted = DENSE * surface.area / (spacing * spacing);
    if wanted > MOST {
        return Err(WallError::TooManySpheres { spacing, area: surface.area, count: wanted / DENSE });
    }
    let drawn: Vec<Vec3> = surface.scattered(wanted as usize).into_iter().map(|(at, _)| at).collect();
    let on_drawing = Grid::new(&drawn, spacing);
    let is_off = |p: &&Vec3| on_drawing.within(&drawn, **p, spacing).next().is_none();
    let off = points.par_iter().filter(is_off).count() as f64 / points.len().max(1) as f64;
    let all: Vec<Vec3> = points.iter().copied().chain(drawn).collect();
    let forced: Vec<bool> = (0..all.len()).map(|i| i < points.len()).collect();
    let amount = Amount::Spacing(CLOSEST * spacing);
    let settings = SampleSettings { amount, method: Method::Poisson, distance: Distance::Space, seed: 0 };
    let kept = sampling::sample(&all, Some(&forced), &settings)?.kept;
    let positions: Vec<Vec3> =
        kept.iter().filter(|&&i| i as usize >= points.len()).map(|&i| all[i as usize]).collect();
    let grid = Grid::new(points, spacing);
    let nearest = positions.par_iter().map(|p| grid.nearest(points, *p, spacing).unwrap_or(0)).collect();
    Ok(Beside { positions, nearest, off })
}
