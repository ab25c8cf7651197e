//! Rotations as lanes: unit quaternions.

use crate::simd::{Lane, V};

/// A rotation.
#[derive(Clone, Copy)]
pub struct Turn<R> {
    /// Cosine of half the angle.
    pub w: R,
    /// Sine of half the angle, times the axis.
    pub v: V<R>,
}

impl<R: Lane> Turn<R> {
    /// From columns i, j, k, w.
    #[inline(always)]
    pub fn of([i, j, k, w]: [R; 4]) -> Turn<R> {
        Turn { w, v: V::new(i, j, k) }
    }

    /// The inverse.
    #[inline(always)]
    pub fn inverse(self) -> Turn<R> {
        Turn { w: self.w, v: V::zero() - self.v }
    }

    /// This rotation after another.
    #[inline(always)]
    pub fn after(self, o: Turn<R>) -> Turn<R> {
        let w = self.w * o.w - self.v.dot(o.v);
        Turn { w, v: o.v.scale(self.w) + self.v.scale(o.w) + self.v.cross(o.v) }
    }

    /// A vector, rotated.
    #[inline(always)]
    pub fn apply(self, p: V<R>) -> V<R> {
        let twice = self.v.cross(p).scale(R::splat(2.0));
        p + twice.scale(self.w) + self.v.cross(twice)
    }
}
