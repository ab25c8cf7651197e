//! The periodic cell: its extent at one instant, how fast that changes, and the images of a particle in it.
//!
//! ```text
//! image n of a particle:  x + n h,  v + n h'         h: lengths of the cell, n: whole numbers, by component
//! affine flow:            u(x) = (h'/h) (x − x₀)     x₀: the centre of the cell, which stays
//! ```

use crate::float::Float;
use alloc::vec;
use alloc::vec::Vec;
use primitives::Vec3;

/// How many periods an image is away, along each axis.
pub type ImageOf = [i8; 3];

/// A periodic cell at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// Lowest and highest coordinate [m] of periodic axes.
    pub range: [Option<(f64, f64)>; 3],
    /// How fast its lengths grow [m/s]; 0 of one at rest.
    pub speed: Vec3,
}

impl Cell {
    /// One whose lengths stay.
    #[inline(always)]
    pub fn at_rest(range: [Option<(f64, f64)>; 3]) -> Cell {
        Cell { range, speed: Vec3::zeros() }
    }

    /// Whether its lengths change.
    pub fn moves(&self) -> bool {
        self.speed != Vec3::zeros()
    }

    /// Lengths along x, y, z [m]; 0 along an open axis.
    #[inline(always)]
    pub fn lengths(&self) -> Vec3 {
        Vec3::from(self.range.map(|p| p.map_or(0.0, |(lo, hi)| hi - lo)))
    }

    /// By how many lengths a position is beyond the cell.
    #[inline(always)]
    pub fn away(&self, p: &Vec3) -> Vec3 {
        let of = |a: usize| self.range[a].map_or(0.0, |(lo, hi)| ((p[a] - lo) / (hi - lo)).whole());
        Vec3::from([0, 1, 2].map(of))
    }

    /// A position, brought back into the cell.
    #[inline(always)]
    pub fn wrapped(&self, p: Vec3) -> Vec3 {
        p - self.lengths().component_mul(&self.away(&p))
    }

    /// Its centre [m]; 0 along an open axis.
    pub fn centre(&self) -> Vec3 {
        Vec3::from(self.range.map(|p| p.map_or(0.0, |(lo, hi)| 0.5 * (lo + hi))))
    }

    /// From the centre of one particle to that of another: how many lengths their nearest images are nearer.
    pub fn between(&self, arm: &Vec3) -> Vec3 {
        let lengths = self.lengths();
        Vec3::from([0, 1, 2].map(|a| if lengths[a] > 0.0 { (arm[a] / lengths[a]).nearest() } else { 0.0 }))
    }

    /// From one centre to another, by the nearest image.
    pub fn nearest(&self, arm: Vec3) -> Vec3 {
        arm - self.lengths().component_mul(&self.between(&arm))
    }

    /// Where an image is, from its particle [m].
    pub fn shift(&self, image: &ImageOf) -> Vec3 {
        of(image).component_mul(&self.lengths())
    }

    /// By how much it is faster than its particle [m/s].
    pub fn drift(&self, image: &ImageOf) -> Vec3 {
        of(image).component_mul(&self.speed)
    }

    /// Velocity of the affine flow at a position [m/s].
    pub fn flow(&self, p: &Vec3) -> Vec3 {
        self.affine(&self.speed, p)
    }

    /// What changes of its lengths make of a position, where all that is in the cell takes its share.
    pub fn affine(&self, change: &Vec3, p: &Vec3) -> Vec3 {
        let of =
            |a: usize| self.range[a].map_or(0.0, |(lo, hi)| change[a] / (hi - lo) * (p[a] - 0.5 * (lo + hi)));
        Vec3::from([0, 1, 2].map(of))
    }

    /// Half of the images that are next to the cell, so that each pair is found once: those whose first number that is not zero is positive.
    pub fn half_of_images(&self) -> Vec<ImageOf> {
        let numbers = self.range.map(|p| if p.is_some() { vec![-1, 0, 1] } else { vec![0] });
        let mut images = Vec::new();
        for &x in &numbers[0] {
            for &y in &numbers[1] {
                for &z in &numbers[2] {
                    if [x, y, z].into_iter().find(|&n| n != 0) == Some(1) {
                        images.push([x, y, z]);
                    }
                }
            }
        }
        images
    }
}

/// As numbers to compute with.
fn of(image: &ImageOf) -> Vec3 {
    Vec3::from(image.map(f64::from))
}
