//! One contact at a time in single precision: what the wide lanes of single precision must equal.

use crate::simd::{Indices, Lane, Row, Row4};

impl Lane for f32 {
    const WIDTH: usize = 1;
    const TINY: f64 = 1e-37;
    type Mask = bool;
    type Wide = f64;

    #[inline(always)]
    fn narrow(wide: f64) -> f32 {
        wide as f32
    }
    #[inline(always)]
    fn overlap(gap: f32, reach: f32, distance: f32) -> f32 {
        gap / (reach + distance)
    }
    #[inline(always)]
    fn splat(x: f64) -> f32 {
        x as f32
    }
    #[inline(always)]
    fn load(from: &[f64]) -> f32 {
        from[0] as f32
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        to[0] = f64::from(self);
    }
    #[inline(always)]
    fn sqrt(self) -> f32 {
        f32::sqrt(self)
    }
    #[inline(always)]
    fn min(self, other: f32) -> f32 {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn max(self, other: f32) -> f32 {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn gt(self, other: f32) -> bool {
        self > other
    }
    #[inline(always)]
    fn select(mask: bool, yes: f32, no: f32) -> f32 {
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
    fn rows(table: &[Row], places: Indices) -> [f32; 8] {
        f64::rows(table, places).map(f32::narrow)
    }
    #[inline(always)]
    fn rows4(table: &[Row4], places: Indices) -> [f32; 4] {
        f64::rows4(table, places).map(f32::narrow)
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
