//! Sums of squared distances to planes.

use geom::Vec3;
use nalgebra::Matrix3;
use std::ops::{Add, AddAssign};

/// Q(x) = xᵀ A x + 2 b·x + c, with the sum of the weights.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Quadric {
    a: Matrix3<f64>,
    b: Vec3,
    c: f64,
    weight: f64,
}

impl Quadric {
    /// The plane of a face, weighted by its area.
    pub(super) fn of_face([p, q, r]: [Vec3; 3]) -> Quadric {
        let across = (q - p).cross(&(r - p));
        let size = across.norm();
        if !(size > 0.0) {
            return Quadric::default();
        }
        let (n, weight) = (across / size, size / 2.0);
        let d = -n.dot(&p);
        Quadric { a: n * n.transpose() * weight, b: n * (d * weight), c: d * d * weight, weight }
    }

    pub(super) fn at(&self, x: &Vec3) -> f64 {
        (x.dot(&(self.a * x)) + 2.0 * self.b.dot(x) + self.c).max(0.0)
    }

    pub(super) fn weight(&self) -> f64 {
        self.weight
    }

    /// The place of least Q on the plane g·(x − middle) = h; near the middle where Q does not say.
    pub(super) fn least(&self, middle: &Vec3, g: &Vec3, h: f64) -> Option<Vec3> {
        let soft = self.a + Matrix3::identity() * (1e-3 * self.a.trace() + f64::MIN_POSITIVE);
        let inverse = soft.try_inverse()?;
        let free = inverse * -(self.a * middle + self.b);
        let along = inverse * g;
        let slope = g.dot(&along);
        let held = if slope > 0.0 { free - along * ((g.dot(&free) - h) / slope) } else { free };
        held.iter().all(|c| c.is_finite()).then(|| middle + held)
    }
}

impl Add for Quadric {
    type Output = Quadric;
    fn add(self, o: Quadric) -> Quadric {
        Quadric { a: self.a + o.a, b: self.b + o.b, c: self.c + o.c, weight: self.weight + o.weight }
    }
}

impl AddAssign for Quadric {
    fn add_assign(&mut self, other: Quadric) {
        *self = *self + other;
    }
}
