//! Places for very many spheres: one in each cell of a lattice, moved at random as far as its cell allows.
//!
//! ```text
//! a ≥ 2 R                              side of the cells: the longest found with as many cells in the shape as there are spheres
//! x = middle of the cell + (a/2 − r) u         u uniform in [−1, 1]³: no sphere leaves its cell, so none touch
//! ```
//!
//! A cell counts if the largest sphere (radius R) fits at its middle. Of more cells than spheres, each is taken with the same probability,
//! in one pass (selection sampling: Knuth, The Art of Computer Programming 2, 3.4.2, algorithm S). Time is linear in the number of spheres;
//! random places, one after the other ([`crate::plan::grains::packing`]), take more tries the fuller the shape is.

use crate::plan::grains::obstacles::Taken;
use crate::plan::grains::packing::{Occupied, Radii, holds};
use crate::plan::grains::random::unit;
use geom::{Shape, Vec3};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;

/// Cells are longer than the largest sphere by this share, so that rounding makes none touch.
const GAP: f64 = 1e-9;

/// Cells of a shape.
struct Lattice<'a> {
    shape: &'a Shape,
    /// Spheres that were there.
    occupied: Option<&'a Occupied>,
    low: Vec3,
    side: Vec3,
    count: [usize; 3],
    /// Largest radius [m].
    largest: f64,
}

/// A place for each sphere, inside the shape and touching none that was there.
///
/// # Errors
/// How many fit, if not all do.
pub(in crate::plan) fn places(
    shape: &Shape,
    corners: (Vec3, Vec3),
    radii: &Radii,
    taken: &Taken,
    random: &mut Pcg64Mcg,
) -> Result<Vec<Vec3>, usize> {
    let (count, largest) = (radii.all.len(), radii.all.iter().copied().fold(0.0, f64::max));
    let occupied = Occupied::with(corners, largest, taken);
    let occupied = (!occupied.is_empty()).then_some(&occupied);
    let (lattice, mut cells) = fitting(shape, corners, occupied, (count, largest))?;
    let mut left = radii.iter();
    let mut found = Vec::with_capacity(count);
    for cell in lattice.cells() {
        let middle = lattice.middle(cell);
        if !lattice.counts(&middle) {
            continue;
        }
        let wanted = left.len();
        if unit(random) * (cells as f64) < wanted as f64
            && let Some(&radius) = left.next()
        {
            found.push(lattice.place(middle, radius, random));
        }
        cells -= 1;
    }
    Ok(found)
}

/// The lattice of the longest cells of which at least `wanted` count, and how many do.
fn fitting<'a>(
    shape: &'a Shape,
    (low, high): (Vec3, Vec3),
    occupied: Option<&'a Occupied>,
    (wanted, largest): (usize, f64),
) -> Result<(Lattice<'a>, usize), usize> {
    let (size, least) = (high - low, 2.0 * largest * (1.0 + GAP));
    let mut side = (size.product() / wanted as f64).cbrt().max(least);
    loop {
        let count = [0, 1, 2].map(|a| (size[a] / side) as usize);
        let lattice = Lattice {
            shape,
            occupied,
            low,
            side: Vec3::from([0, 1, 2].map(|a| size[a] / count[a].max(1) as f64)),
            count,
            largest,
        };
        let cells = lattice.fitting_cells();
        if cells >= wanted {
            return Ok((lattice, cells));
        }
        if side <= least {
            return Err(cells);
        }
        let share = (cells as f64 / wanted as f64).cbrt().clamp(0.8, 0.99);
        side = (side * share).max(least);
    }
}

impl Lattice<'_> {
    /// Along z slowest, along x fastest.
    fn cells(&self) -> impl Iterator<Item = [usize; 3]> + use<> {
        let [nx, ny, nz] = self.count;
        (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])))
    }

    /// How many cells count.
    fn fitting_cells(&self) -> usize {
        let [nx, ny, nz] = self.count;
        let row = |y, z| (0..nx).filter(|&x| self.counts(&self.middle([x, y, z]))).count();
        (0..nz).into_par_iter().map(|z| (0..ny).map(|y| row(y, z)).sum::<usize>()).sum()
    }

    fn middle(&self, cell: [usize; 3]) -> Vec3 {
        self.low + Vec3::from(cell.map(|k| k as f64 + 0.5)).component_mul(&self.side)
    }

    /// Whether the largest sphere fits there.
    fn counts(&self, middle: &Vec3) -> bool {
        self.fits(middle, self.largest)
    }

    fn fits(&self, at: &Vec3, radius: f64) -> bool {
        holds(self.shape, at, radius) && self.occupied.is_none_or(|there| there.is_free(at, radius))
    }

    /// A place in a cell that counts: at random, or in the middle where that one is not free.
    fn place(&self, middle: Vec3, radius: f64, random: &mut Pcg64Mcg) -> Vec3 {
        let room = (self.side * 0.5).add_scalar(-radius * (1.0 + GAP));
        let u = Vec3::new(unit(random), unit(random), unit(random)).map(|u| 2.0 * u - 1.0);
        let at = middle + u.component_mul(&room);
        if self.fits(&at, radius) { at } else { middle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::OneOrRange;
    use crate::plan::grains::packing::bounds;
    use crate::plan::grains::random::{diameter, generator};

    fn radii(count: usize) -> Vec<f64> {
        let mut random = generator(3, 1, 0);
        (0..count).map(|_| diameter(OneOrRange { low: 0.006, high: 0.01 }, &mut random) / 2.0).collect()
    }

    fn placed(shape: &str, count: usize, taken: &[(Vec3, f64)]) -> Result<Vec<(Vec3, f64)>, usize> {
        let (shape, radii) = (shape.parse::<Shape>().unwrap(), radii(count));
        let found = places(
            &shape,
            bounds(&shape).unwrap(),
            &Radii { all: &radii, hear: &|_| () },
            &Taken::from(taken.to_vec()),
            &mut generator(0, 1, 0),
        )?;
        assert!(found.iter().zip(&radii).all(|(p, r)| holds(&shape, p, *r)));
        Ok(found.into_iter().zip(radii).collect())
    }

    #[test]
    fn all_lie_inside_and_none_touch() {
        let taken = [(Vec3::new(0.0, 0.0, 0.1), 0.05)];
        for (shape, count) in [
            ("box:-0.1,-0.1,0,0.1,0.1,0.2", 6000),
            ("cylinder:0,0,0,0,0,0.2,0.1", 2500),
            ("sphere:0,0,0.1,0.1", 1000),
        ] {
            let found = placed(shape, count, &taken).unwrap();
            assert_eq!(found.len(), count, "{shape}");
            for (i, (p, r)) in found.iter().enumerate() {
                let apart = |(q, s): &(Vec3, f64)| (p - q).norm() >= r + s;
                assert!(found[..i].iter().all(apart) && taken.iter().all(apart), "{shape}: {i}");
            }
        }
    }

    #[test]
    fn few_spheres_are_spread_over_the_whole_shape_and_too_many_are_counted() {
        let found = placed("box:0,0,0,1,1,1", 1000, &[]).unwrap();
        for axis in 0..3 {
            let mean = found.iter().map(|(p, _)| p[axis]).sum::<f64>() / 1000.0;
            assert!((mean - 0.5).abs() < 0.03, "{mean}");
        }
        let count = |shape: &str| placed(shape, 1200, &[]).map(|found| found.len());
        assert_eq!(count("box:0,0,0,0.1,0.1,0.1"), Err(1000));
        assert_eq!(count("box:0,0,0,1,1,0.001"), Err(0));
    }
}
