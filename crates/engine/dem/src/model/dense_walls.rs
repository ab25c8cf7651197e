//! Wall spheres that push one grain the same way at once.
//!
//! ```text
//! N = the most centres of a wall's spheres within √(2 R* δ) of one of them,   δ = overlap limit × smaller radius
//! ```
//!
//! Spheres of a wall may lie within each other. Of spheres P apart on a plane N ≈ 2π R* δ/P²; each is a spring, and all push one way, Σ n nᵀ = N. A close
//! packing has 4. A grain pressed by the whole of δ into such a wall would touch more of them, up to (r + R)/R* times as many, the outermost lightly: N is that of an
//! overlap of δ R*/(r + R), a quarter of the limit for equal radii.
//!
//! Where the spheres of a wall act as one contact ([`laws::contact::patch`]), N that are pressed alike are N^¼ times as stiff as one; under a law that yields they do not.

use crate::model::limit::normal;
use crate::setup::{Setup, Wall, WallShape};
use crate::threads::share;
use geom::{Grid, Vec3};
use laws::effects::{ALONG, ContactLaw};

/// Centres that one thread counts the neighbours of.
const TOGETHER: usize = 4096;

/// Radius of the largest sphere of a wall [m]; infinite where it is flat.
pub fn rounding(wall: &Wall) -> f64 {
    match &wall.shape {
        WallShape::Spheres(spheres) => spheres.iter().map(|s| s.1).fold(0.0, f64::max),
        _ => f64::INFINITY,
    }
}

/// R* of a sphere of radius `r` [m] on a wall, and the smaller radius of both [m].
pub fn met(wall: &Wall, r: f64) -> (f64, f64) {
    let other = rounding(wall);
    (if other.is_finite() { r * other / (r + other) } else { r }, r.min(other))
}

/// The walls of a setup, and how many times the four of a close packing they push the largest grain: most walls do so once, and are counted once.
pub struct DenseWalls<'a> {
    setup: &'a Setup,
    largest: f64,
    most: Vec<f64>,
}

impl<'a> DenseWalls<'a> {
    /// Of grains up to this radius [m]: the larger, the more push it.
    pub fn new(setup: &'a Setup, largest: f64) -> DenseWalls<'a> {
        let most = setup.walls.iter().map(|wall| density_on(setup, wall, largest));
        DenseWalls { setup, largest, most: most.collect() }
    }

    /// How many times the four of a close packing push a sphere of radius `r` [m] one way on wall `w`; no fewer than once.
    pub fn on(&self, w: usize, r: f64) -> f64 {
        let known = self.most[w] == 1.0 || r >= self.largest;
        if known { self.most[w] } else { density_on(self.setup, &self.setup.walls[w], r) }
    }
}

/// How many times the four of a close packing push a sphere of radius `r` [m] one way on a wall, up to the overlap at which guards stop a run; no fewer than once.
fn density_on(setup: &Setup, wall: &Wall, r: f64) -> f64 {
    let count = most_on(wall, r, setup.guards.overlap) as f64;
    let met = |law: &ContactLaw| law.between.0 == wall.material || law.between.1 == wall.material;
    let yields = |law: &ContactLaw| met(law) && normal(law).is_some_and(|law| law.yields);
    let share = setup.patches && !setup.contacts.iter().any(yields);
    let stiffness = if share { count.sqrt().sqrt() } else { count };
    (stiffness / ALONG).max(1.0)
}

/// N of a sphere of radius `r` [m] on a wall, up to an overlap that is such a share of the smaller radius; 1 on walls of other kinds.
fn most_on(wall: &Wall, r: f64, overlap: f64) -> usize {
    let WallShape::Spheres(spheres) = &wall.shape else { return 1 };
    let (radius, smaller) = met(wall, r);
    let centres: Vec<Vec3> = spheres.iter().map(|s| s.0).collect();
    most_within(&centres, (2.0 * radius * overlap * smaller).sqrt())
}

/// The most points within `distance` [m] of one of them, itself included; 0 where numbers are none, which is refused elsewhere.
fn most_within(centres: &[Vec3], distance: f64) -> usize {
    let sound = distance > 0.0 && distance.is_finite();
    if !sound || !centres.iter().all(|c| c.iter().all(|x| x.is_finite())) {
        return 0;
    }
    let grid = Grid::new(centres, distance);
    let count = |centre: &Vec3| grid.within(centres, *centre, distance).count();
    let most = |some: &[Vec3]| some.iter().map(count).max().unwrap_or(0);
    share(centres.len() > TOGETHER, centres.chunks(TOGETHER).collect(), most).into_iter().max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(spacing: f64, radius: f64) -> Wall {
        let at = |k: i32| spacing * f64::from(k);
        let sphere = |k: i32| (Vec3::new(at(k % 60), at(k / 60), 0.0), radius);
        let shape = WallShape::Spheres((0..3600).map(sphere).collect());
        Wall::new("w", 0, shape)
    }

    /// N ≈ 2π R* δ/P² on a plane; at ordinary spacings, of about a radius, no more than the four of a packing.
    #[test]
    fn dense_spheres_are_counted() {
        let (r, overlap) = (0.01, 0.25);
        let closed = std::f64::consts::TAU * 0.005 * overlap * r / (0.0005f64 * 0.0005);
        let found = most_on(&grid(0.0005, r), r, overlap) as f64;
        assert!((found / closed - 1.0).abs() < 0.05, "{found}, not {closed}");
        for spacing in [0.008, 0.01, 0.012] {
            let found = most_on(&grid(spacing, r), r, overlap);
            assert!(found as f64 <= ALONG, "{spacing}: {found}");
        }
        let (nan, far) = (vec![Vec3::repeat(f64::NAN)], vec![Vec3::zeros(), Vec3::x()]);
        assert_eq!((most_within(&nan, 1.0), most_within(&far, 0.5), most_within(&far, 0.0)), (0, 1, 0));
    }
}
