//! The cross-section of an insertion: its shape as seen along the velocity.

use crate::plan::grains::packing::{bounds, holds};
use crate::plan::grains::random::unit;
use dem::setup::Zone;
use geom::{Plane, Shape, Vec3};
use rand_pcg::Pcg64Mcg;

/// The shape as seen along the velocity.
#[derive(Debug, Clone)]
pub(in crate::plan) struct Section {
    shape: Shape,
    /// Along the velocity, and twice across it.
    pub frame: [Vec3; 3],
    /// Lowest and highest coordinate of the shape along each of them [m].
    pub ranges: [(f64, f64); 3],
}

impl Section {
    /// `None` for a shape without end.
    pub fn new(shape: Shape, axis: Vec3) -> Option<Section> {
        let (low, high) = bounds(&shape)?;
        let across = axis.cross(&if axis.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() }).normalize();
        let frame = [axis, across, axis.cross(&across)];
        let ranges = frame.map(|n| extent(&n, &low, &high));
        Some(Section { shape, frame, ranges })
    }

    /// The range that the shape covers along a direction, by its box [m].
    pub fn along(&self, n: &Vec3) -> (f64, f64) {
        bounds(&self.shape).map_or((0.0, 0.0), |(low, high)| extent(n, &low, &high))
    }

    /// The box of all spheres of a radius [m] on their way through it.
    pub fn box_around(&self, radius: f64) -> (Vec3, Vec3) {
        let corner = |n: usize| -> Vec3 {
            (0..3)
                .map(|a| self.frame[a] * if n >> a & 1 == 0 { self.ranges[a].0 } else { self.ranges[a].1 })
                .sum()
        };
        let (low, high) = (0..8)
            .map(corner)
            .fold((Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)), |(low, high), p| {
                (low.inf(&p), high.sup(&p))
            });
        (low - Vec3::repeat(radius), high + Vec3::repeat(radius))
    }

    fn middle(&self, n: usize) -> f64 {
        (self.ranges[n].0 + self.ranges[n].1) / 2.0
    }

    pub fn size(&self, n: usize) -> f64 {
        self.ranges[n].1 - self.ranges[n].0
    }

    /// The zone: its calculation plane is where the shape ends.
    pub fn zone(&self) -> Zone {
        let end = self.frame[0] * self.ranges[0].1;
        let point = end + self.frame[1] * self.middle(1) + self.frame[2] * self.middle(2);
        Zone::new(Plane { point, normal: self.frame[0] }, self.size(0))
    }

    /// A random position across the flow where a sphere fits.
    pub fn candidate(&self, radius: f64, random: &mut Pcg64Mcg) -> Option<Vec3> {
        let [u, w] = [1, 2].map(|n| self.ranges[n].0 + self.size(n) * unit(random));
        let across = self.frame[1] * u + self.frame[2] * w;
        holds(&self.shape, &(across + self.frame[0] * self.middle(0)), radius).then_some(across)
    }
}

/// The range that a box covers along a direction.
fn extent(n: &Vec3, low: &Vec3, high: &Vec3) -> (f64, f64) {
    let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
    let reach: f64 = (0..3).map(|a| (n[a] * half[a]).abs()).sum();
    (n.dot(&middle) - reach, n.dot(&middle) + reach)
}
