//! Two lanes side by side.
//!
//! A contact is one long chain of roots and divisions, each of which waits for the one before: a processor computes two chains
//! in hardly more time than one. Eight contacts as one lane need registers that not every processor has.

use crate::simd::{Indices, Lane, Row, Row4};
use core::ops::{Add, Div, Mul, Neg, Sub};

/// The first contacts, and as many more.
#[derive(Clone, Copy)]
pub struct Two<R>(pub R, pub R);

macro_rules! operator {
    ($trait:ident, $name:ident) => {
        impl<R: Lane> $trait for Two<R> {
            type Output = Two<R>;
            #[inline(always)]
            fn $name(self, o: Two<R>) -> Two<R> {
                Two(self.0.$name(o.0), self.1.$name(o.1))
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl<R: Lane> Neg for Two<R> {
    type Output = Two<R>;
    #[inline(always)]
    fn neg(self) -> Two<R> {
        Two(-self.0, -self.1)
    }
}

impl<R: Lane> Lane for Two<R> {
    const WIDTH: usize = 2 * R::WIDTH;
    const TINY: f64 = R::TINY;
    type Mask = (R::Mask, R::Mask);
    type Wide = Two<R::Wide>;

    #[inline(always)]
    fn narrow(wide: Two<R::Wide>) -> Two<R> {
        Two(R::narrow(wide.0), R::narrow(wide.1))
    }
    #[inline(always)]
    fn overlap(gap: Two<R>, reach: Two<R>, distance: Two<R>) -> Two<R> {
        Two(R::overlap(gap.0, reach.0, distance.0), R::overlap(gap.1, reach.1, distance.1))
    }
    #[inline(always)]
    fn splat(x: f64) -> Two<R> {
        Two(R::splat(x), R::splat(x))
    }
    #[inline(always)]
    fn load(from: &[f64]) -> Two<R> {
        Two(R::load(from), R::load(&from[R::WIDTH..]))
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        self.0.store(to);
        self.1.store(&mut to[R::WIDTH..]);
    }
    #[inline(always)]
    fn sqrt(self) -> Two<R> {
        Two(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    fn min(self, o: Two<R>) -> Two<R> {
        Two(self.0.min(o.0), self.1.min(o.1))
    }
    #[inline(always)]
    fn max(self, o: Two<R>) -> Two<R> {
        Two(self.0.max(o.0), self.1.max(o.1))
    }
    #[inline(always)]
    fn gt(self, o: Two<R>) -> Self::Mask {
        (self.0.gt(o.0), self.1.gt(o.1))
    }
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Two<R>, no: Two<R>) -> Two<R> {
        Two(R::select(mask.0, yes.0, no.0), R::select(mask.1, yes.1, no.1))
    }
    #[inline(always)]
    fn both(a: Self::Mask, b: Self::Mask) -> Self::Mask {
        (R::both(a.0, b.0), R::both(a.1, b.1))
    }
    #[inline(always)]
    fn any(mask: Self::Mask) -> bool {
        R::any(mask.0) | R::any(mask.1)
    }
    #[inline(always)]
    fn rows(table: &[Row], indices: Indices) -> [Two<R>; 8] {
        let (a, b) = (R::rows(table, indices), R::rows(table, indices.from(R::WIDTH)));
        [
            Two(a[0], b[0]),
            Two(a[1], b[1]),
            Two(a[2], b[2]),
            Two(a[3], b[3]),
            Two(a[4], b[4]),
            Two(a[5], b[5]),
            Two(a[6], b[6]),
            Two(a[7], b[7]),
        ]
    }
    #[inline(always)]
    fn rows4(table: &[Row4], indices: Indices) -> [Two<R>; 4] {
        let (a, b) = (R::rows4(table, indices), R::rows4(table, indices.from(R::WIDTH)));
        [Two(a[0], b[0]), Two(a[1], b[1]), Two(a[2], b[2]), Two(a[3], b[3])]
    }
    #[inline(always)]
    fn store_rows(columns: [Two<R>; 8], to: &mut [f64]) {
        let [a, b, c, d, e, f, g, h] = columns;
        R::store_rows([a.0, b.0, c.0, d.0, e.0, f.0, g.0, h.0], to);
        R::store_rows([a.1, b.1, c.1, d.1, e.1, f.1, g.1, h.1], &mut to[8 * R::WIDTH..]);
    }
    #[inline(always)]
    fn store_rows4(columns: [Two<R>; 4], to: &mut [f64]) {
        let [a, b, c, d] = columns;
        R::store_rows4([a.0, b.0, c.0, d.0], to);
        R::store_rows4([a.1, b.1, c.1, d.1], &mut to[4 * R::WIDTH..]);
    }
}
