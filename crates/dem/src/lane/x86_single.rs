//! Four and eight contacts at a time in single precision, between rows in double precision, by AVX2 and AVX-512.
//!
//! Safety of this file: as for [`super::x86`]; nothing here reads or writes memory but through the wide types.
#![allow(unsafe_code)]

use super::x86::{X4, X8};
use super::{Lane, Row, Row4};
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Four floats.
#[derive(Clone, Copy)]
pub struct Y4(__m128);

/// Eight floats.
#[derive(Clone, Copy)]
pub struct Y8(__m256);

macro_rules! single {
    ($t:ident, $wide:ident, $width:literal, $mask:ty, $add:ident, $sub:ident, $mul:ident, $div:ident, $set:ident,
     $sqrt:ident, $min:ident, $max:ident, $xor:ident, $and:ident, $cmp:ident, $blend:ident, $movemask:ident,
     $narrow:ident, $widen:ident) => {
        single!(@ $t, Add, add, $add);
        single!(@ $t, Sub, sub, $sub);
        single!(@ $t, Mul, mul, $mul);
        single!(@ $t, Div, div, $div);
        impl Neg for $t {
            type Output = $t;
            #[inline(always)]
            fn neg(self) -> $t {
                // SAFETY: see the module's head. Flips the sign bit, as scalar negation does.
                $t(unsafe { $xor(self.0, $set(-0.0)) })
            }
        }
        impl Lane for $t {
            const WIDTH: usize = $width;
            const TINY: f64 = f32::TINY;
            type Mask = $mask;
            type Wide = $wide;

            #[inline(always)]
            fn narrow(wide: $wide) -> $t {
                // SAFETY: see the module's head.
                $t(unsafe { $narrow(wide.0) })
            }
            #[inline(always)]
            fn widen(self) -> $wide {
                // SAFETY: see the module's head.
                $wide(unsafe { $widen(self.0) })
            }
            #[inline(always)]
            fn overlap(gap: $t, reach: $t, distance: $t) -> $t {
                gap / (reach + distance)
            }
            #[inline(always)]
            fn splat(x: f64) -> $t {
                // SAFETY: see the module's head.
                $t(unsafe { $set(x as f32) })
            }
            #[inline(always)]
            fn load(from: &[f64]) -> $t {
                $t::narrow($wide::load(from))
            }
            #[inline(always)]
            fn store(self, to: &mut [f64]) {
                self.widen().store(to);
            }
            #[inline(always)]
            fn sqrt(self) -> $t {
                // SAFETY: see the module's head.
                $t(unsafe { $sqrt(self.0) })
            }
            #[inline(always)]
            fn min(self, o: $t) -> $t {
                // SAFETY: see the module's head.
                $t(unsafe { $min(self.0, o.0) })
            }
            #[inline(always)]
            fn max(self, o: $t) -> $t {
                // SAFETY: see the module's head.
                $t(unsafe { $max(self.0, o.0) })
            }
            #[inline(always)]
            fn gt(self, o: $t) -> $mask {
                // SAFETY: see the module's head.
                unsafe { $cmp::<_CMP_GT_OQ>(self.0, o.0) }
            }
            #[inline(always)]
            fn select(mask: $mask, yes: $t, no: $t) -> $t {
                // SAFETY: see the module's head.
                $t(unsafe { $blend(no.0, yes.0, mask) })
            }
            #[inline(always)]
            fn both(a: $mask, b: $mask) -> $mask {
                // SAFETY: see the module's head.
                unsafe { $and(a, b) }
            }
            #[inline(always)]
            fn any(mask: $mask) -> bool {
                // SAFETY: see the module's head.
                unsafe { $movemask(mask) != 0 }
            }
            #[inline(always)]
            fn rows(table: &[Row], index: &[u32]) -> [$t; 8] {
                $wide::rows(table, index).map($t::narrow)
            }
            #[inline(always)]
            fn rows4(table: &[Row4], index: &[u32]) -> [$t; 4] {
                $wide::rows4(table, index).map($t::narrow)
            }
            #[inline(always)]
            fn store_rows(columns: [$t; 8], to: &mut [f64]) {
                $wide::store_rows(columns.map($t::widen), to);
            }
            #[inline(always)]
            fn store_rows4(columns: [$t; 4], to: &mut [f64]) {
                $wide::store_rows4(columns.map($t::widen), to);
            }
        }
    };
    (@ $t:ident, $trait:ident, $f:ident, $op:ident) => {
        impl $trait for $t {
            type Output = $t;
            #[inline(always)]
            fn $f(self, o: $t) -> $t {
                // SAFETY: see the module's head.
                $t(unsafe { $op(self.0, o.0) })
            }
        }
    };
}

single!(
    Y4,
    X4,
    4,
    __m128,
    _mm_add_ps,
    _mm_sub_ps,
    _mm_mul_ps,
    _mm_div_ps,
    _mm_set1_ps,
    _mm_sqrt_ps,
    _mm_min_ps,
    _mm_max_ps,
    _mm_xor_ps,
    _mm_and_ps,
    _mm_cmp_ps,
    _mm_blendv_ps,
    _mm_movemask_ps,
    _mm256_cvtpd_ps,
    _mm256_cvtps_pd
);
single!(
    Y8,
    X8,
    8,
    __m256,
    _mm256_add_ps,
    _mm256_sub_ps,
    _mm256_mul_ps,
    _mm256_div_ps,
    _mm256_set1_ps,
    _mm256_sqrt_ps,
    _mm256_min_ps,
    _mm256_max_ps,
    _mm256_xor_ps,
    _mm256_and_ps,
    _mm256_cmp_ps,
    _mm256_blendv_ps,
    _mm256_movemask_ps,
    _mm512_cvtpd_ps,
    _mm512_cvtps_pd
);
