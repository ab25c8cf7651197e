//! One contact at a time: what the wide lanes of the same precision must equal.

use crate::float::Float;
use crate::simd::{Four, Indices, Lane, Row, Row4};
use core::ops::{Add, Mul, Sub};

/// What is the same in both precisions.
macro_rules! one_at_a_time {
    ($number:ident) => {
        const WIDTH: usize = 1;
        type Mask = bool;
        type Wide = f64;

        #[inline(always)]
        fn splat(x: f64) -> $number {
            $number::narrow(x)
        }
        #[inline(always)]
        fn load(from: &[f64]) -> $number {
            $number::narrow(from[0])
        }
        #[inline(always)]
        fn store(self, to: &mut [f64]) {
            to[0] = f64::from(self);
        }
        #[inline(always)]
        fn sqrt(self) -> $number {
            Float::root(self)
        }
        #[inline(always)]
        fn min(self, other: $number) -> $number {
            if self < other { self } else { other }
        }
        #[inline(always)]
        fn max(self, other: $number) -> $number {
            if self > other { self } else { other }
        }
        #[inline(always)]
        fn gt(self, other: $number) -> bool {
            self > other
        }
        #[inline(always)]
        fn select(mask: bool, yes: $number, no: $number) -> $number {
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
    };
}

impl Lane for f64 {
    one_at_a_time!(f64);
    const TINY: f64 = 1e-300;

    #[inline(always)]
    fn narrow(wide: f64) -> f64 {
        wide
    }
    #[inline(always)]
    fn overlap(_: f64, reach: f64, distance: f64) -> f64 {
        reach - distance
    }
    #[inline(always)]
    fn rows(table: &[Row], indices: Indices) -> [f64; 8] {
        table[indices.of[0] as usize].0
    }
    #[inline(always)]
    fn rows4(table: &[Row4], indices: Indices) -> [f64; 4] {
        table[indices.of[0] as usize].0
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

impl Lane for f32 {
    one_at_a_time!(f32);
    const TINY: f64 = 1e-37;

    #[inline(always)]
    fn narrow(wide: f64) -> f32 {
        wide as f32
    }
    #[inline(always)]
    fn overlap(gap: f32, reach: f32, distance: f32) -> f32 {
        gap / (reach + distance)
    }
    #[inline(always)]
    fn rows(table: &[Row], indices: Indices) -> [f32; 8] {
        f64::rows(table, indices).map(f32::narrow)
    }
    #[inline(always)]
    fn rows4(table: &[Row4], indices: Indices) -> [f32; 4] {
        f64::rows4(table, indices).map(f32::narrow)
    }
    #[inline(always)]
    fn store_rows(columns: [f32; 8], to: &mut [f64]) {
        f64::store_rows(columns.map(f64::from), to);
    }
    #[inline(always)]
    fn store_rows4(columns: [f32; 4], to: &mut [f64]) {
        f64::store_rows4(columns.map(f64::from), to);
    }
    #[inline(always)]
    fn load_single(from: &[f32]) -> f32 {
        from[0]
    }
    #[inline(always)]
    fn store_single(self, to: &mut [f32]) {
        to[0] = self;
    }
    #[inline(always)]
    fn store_rows_single(columns: [f32; 8], to: &mut [f32]) {
        to[..8].copy_from_slice(&columns);
    }
    #[inline(always)]
    fn store_rows4_single(columns: [f32; 4], to: &mut [f32]) {
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
                Each(core::array::from_fn(|k| self.0[k] $op o.0[k]))
            }
        }
    };
}

each!(Add, add, +);
each!(Sub, sub, -);
each!(Mul, mul, *);
