//! `[[fill]] lattice`: equal spheres that touch, on all places of a lattice that lie in a shape.
//!
//! ```text
//! cubic        (i, j, k) d
//! hexagonal    (i + (j mod 2)/2 + (k mod 2)/2,   √3/2 (j + (k mod 2)/3),   √6/3 k) d          layers of hexagons, every second one above the gaps
//! ```

use crate::keys::Lattice;
use crate::plan::grains::obstacles::Taken;
use crate::plan::grains::packing::{Occupied, holds};
use geom::{Shape, Vec3};

/// How the spheres of a fill lie: their lattice, its steps and their number along each axis.
struct Sites {
    lattice: Lattice,
    low: Vec3,
    diameter: f64,
    count: [usize; 3],
}

impl Sites {
    /// Steps along x, y, z over the diameter.
    fn steps(lattice: Lattice) -> [f64; 3] {
        match lattice {
            Lattice::Cubic => [1.0; 3],
            Lattice::Hexagonal => [1.0, 0.5 * 3f64.sqrt(), 6f64.sqrt() / 3.0],
        }
    }

    fn at(&self, [i, j, k]: [usize; 3]) -> Vec3 {
        let whole = [i, j, k].map(|n| n as f64);
        let odd = [j, k].map(|n| (n % 2) as f64);
        let steps = Sites::steps(self.lattice);
        let shift = match self.lattice {
            Lattice::Cubic => [0.0; 2],
            Lattice::Hexagonal => [0.5 * (odd[0] + odd[1]), odd[1] / 3.0],
        };
        let place = [whole[0] + shift[0], (whole[1] + shift[1]) * steps[1], whole[2] * steps[2]];
        self.low + Vec3::from(place) * self.diameter
    }
}

/// Places of all spheres of a diameter [m] that lie wholly in the shape and touch none of those that are there, in rows along x; how many sites that would be,
/// if they are more than `most`.
///
/// # Errors
/// The number of sites.
pub(in crate::plan) fn places(
    shape: &Shape,
    corners: (Vec3, Vec3),
    (lattice, diameter): (Lattice, f64),
    taken: &Taken,
    most: u64,
) -> Result<Vec<Vec3>, f64> {
    let (low, high) = corners;
    let steps = Sites::steps(lattice);
    let room = (high - low).map(|side| (side - diameter).max(0.0));
    let number = [0, 1, 2].map(|a| (room[a] / (steps[a] * diameter) * (1.0 + 1e-12)).floor() + 1.0);
    let sites: f64 = number.iter().product();
    if !(sites <= most as f64) {
        return Err(sites);
    }
    let count = number.map(|n| n as usize);
    let sites = Sites { lattice, low: low.add_scalar(0.5 * diameter), diameter, count };
    let occupied = Occupied::with(corners, 0.5 * diameter, taken);
    let [nx, ny, nz] = sites.count;
    let rows = (0..nz).flat_map(|k| (0..ny).map(move |j| (j, k)));
    let all = rows.flat_map(|(j, k)| (0..nx).map(move |i| [i, j, k])).map(|site| sites.at(site));
    // Of a shape that holds whole rows, rounding takes none.
    let radius = 0.5 * diameter * (1.0 - 1e-12);
    let fits = |place: &Vec3| {
        holds(shape, place, radius) && (occupied.is_empty() || occupied.is_free(place, radius))
    };
    Ok(all.filter(fits).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn neighbours(lattice: Lattice) -> (usize, usize) {
        let shape: Shape = "box:0,0,0,1,1,1".parse().expect("a box");
        let corners = (Vec3::zeros(), Vec3::repeat(1.0));
        let all = places(&shape, corners, (lattice, 0.1), &Taken::default(), 10_000).expect("few enough");
        let near = |p: &Vec3| all.iter().filter(|q| ((*q - p).norm() - 0.1).abs() < 1e-9).count();
        let closer = all.iter().flat_map(|p| all.iter().map(move |q| (p - q).norm()));
        assert!(closer.filter(|d| *d > 0.0).all(|d| d > 0.1 - 1e-9));
        (all.len(), all.iter().map(near).max().unwrap_or(0))
    }

    #[test]
    fn spheres_touch_six_or_twelve_others() {
        assert_eq!(neighbours(Lattice::Cubic), (1000, 6));
        let (count, most) = neighbours(Lattice::Hexagonal);
        assert_eq!(most, 12);
        // Close packing fills 74 %, less at the walls.
        assert!(count > 1000, "{count}");
    }

    #[test]
    fn too_many_sites_are_refused_before_they_are_made() {
        let shape: Shape = "box:0,0,0,1,1,1".parse().expect("a box");
        let found = places(
            &shape,
            (Vec3::zeros(), Vec3::repeat(1.0)),
            (Lattice::Cubic, 1e-6),
            &Taken::default(),
            1000,
        );
        assert!(found.is_err_and(|n| n > 9e17));
    }
}
