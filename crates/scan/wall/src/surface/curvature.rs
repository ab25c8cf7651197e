//! How much the surface bends, against which the spheres of a wall are large or small.

use geom::cells::Cells;
use geom::star::{StarScratch, voids};
use geom::{Grid, Quadratic, Vec3};

/// Points at which the surface is looked at, about.
const LOOKED_AT: usize = 500;
/// How far around each, in spacings: noise of a tenth of a spacing then makes a radius of a hundred.
const REACH: f64 = 6.0;
/// Points around, without which there is no surface.
const FEWEST: usize = 20;
/// Share of the surface that bends more than what is called its bend [–]: edges are few.
const MORE: f64 = 0.25;

/// A radius of curvature [m] that a quarter of the surface falls below; `None` where too few points lie together. `spacing` [m] is that of neighbours.
pub(crate) fn radius(cells: &Cells, spacing: f64) -> Option<f64> {
    let points = &cells.points;
    let (reach, mut work) = (REACH * spacing, StarScratch::default());
    let grid = Grid::new(points, reach);
    let bend = |slot: usize| {
        let (normal, _) = voids(cells, slot as u32, 0.0, &mut work);
        let u =
            normal.cross(&if normal.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() }).try_normalize(1e-9)?;
        let v = normal.cross(&u);
        let local = |k: u32| points[k as usize] - points[slot];
        let near: Vec<Vec3> = grid
            .within(points, points[slot], reach)
            .map(|k| Vec3::new(local(k).dot(&u), local(k).dot(&v), local(k).dot(&normal)))
            .collect();
        let fit = Quadratic::fit(&near).filter(|_| near.len() >= FEWEST)?;
        Some(fit.bend())
    };
    let every = points.len().div_ceil(LOOKED_AT).max(1);
    let mut bends: Vec<f64> = (0..points.len()).step_by(every).filter_map(bend).collect();
    if bends.is_empty() {
        return None;
    }
    bends.sort_by(|a, b| b.total_cmp(a));
    Some(1.0 / bends[(MORE * bends.len() as f64) as usize])
}
