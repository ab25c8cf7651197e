//! One contact at a time: what the wide lanes must equal.

use crate::simd::{Four, Indices, Lane, Row, Row4};
use std::ops::{Add, Mul, Sub};

impl Lane for f64 {
    const WIDTH: usize = 1;
    const TINY: f64 = 1e-300;
    type Mask = bool;
    type Wide = f64;

    #[inline(always)]
    fn narrow(wide: f64) -> f64 {
        wide
    }
    #[inline(always)]
    fn overlap(_: f64, reach: f64, distance: f64) -> f64 {
        reach - distance
    }

    #[inline(always)]
    fn splat(x: f64) -> f64 {
        x
    }
    #[inline(always)]
    fn load(from: &[f64]) -> f64 {
        from[0]
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        to[0] = self;
    }
    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn min(self, other: f64) -> f64 {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn max(self, other: f64) -> f64 {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn gt(self, other: f64) -> bool {
        self > other
    }
    #[inline(always)]
    fn select(mask: bool, yes: f64, no: f64) -> f64 {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn both(a: bool, b: bool) -> bool {
        a & b
    }
    #[inline(always)]
    fn any(mask: bool) -> bool {
        mask
    }
    #[inline(always)]
    fn rows(table: &[Row], places: Indices) -> [f64; 8] {
        table[places.of[0] as usize].0
    }
    #[inline(always)]
    fn rows4(table: &[Row4], places: Indices) -> [f64; 4] {
        table[places.of[0] as usize].0
    }
    #[inline(always)]
    fn store_rows(columns: [f64; 8], to: &mut [f64]) {
        to[..8].copy_from_slice(&columns);
    }
    #[inline(always)]
    fn store_rows4(columns: [f64; 4], to: &mut [f64]) {
        to[..4].copy_from_slice(&columns);
    }
}

/// Four numbers, one after the other.
#[derive(Clone, Copy)]
pub struct Each([f64; 4]);

impl Four for Each {
    #[inline(always)]
    fn read(from: &[f64; 4]) -> Each {
        Each(*from)
    }
    #[inline(always)]
    fn write(self, to: &mut [f64; 4]) {
        *to = self.0;
    }
    #[inline(always)]
    fn all(x: f64) -> Each {
        Each([x; 4])
    }
}

macro_rules! each {
    ($trait:ident, $f:ident, $op:tt) => {
        impl $trait for Each {
            type Output = Each;
            #[inline(always)]
            fn $f(self, o: Each) -> Each {
                Each(std::array::from_fn(|k| self.0[k] $op o.0[k]))
            }
        }
    };
}

each!(Add, add, +);
each!(Sub, sub, -);
each!(Mul, mul, *);
