//! Eight contacts at a time in single precision, between rows in double precision, by AVX2 and AVX-512.
//!
//! Safety of this file: as for [`crate::simd::x86`]; nothing here reads or writes memory but through the wide types.
#![expect(unsafe_code, reason = "the processor's own vector instructions")]

use crate::simd::two::Two;
use crate::simd::x86::{X4, X8, operators};
use crate::simd::{Indices, Lane, Row, Row4};
use core::arch::x86_64::*;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// Eight floats beside two times four doubles.
#[derive(Clone, Copy)]
pub struct Y4(__m256);

/// Eight floats beside eight doubles.
#[derive(Clone, Copy)]
pub struct Y8(__m256);

type X4x2 = Two<X4>;

#[inline(always)]
unsafe fn narrow4(wide: X4x2) -> __m256 {
    // SAFETY: registers only: the wide numbers were made where the processor has AVX2.
    unsafe { _mm256_set_m128(_mm256_cvtpd_ps(wide.1.0), _mm256_cvtpd_ps(wide.0.0)) }
}

#[inline(always)]
unsafe fn widen4(y: __m256) -> X4x2 {
    // SAFETY: registers only: the caller has made `y` where the processor has AVX2.
    let half = |h| X4(unsafe { _mm256_cvtps_pd(h) });
    // SAFETY: registers only: the caller has made `y` where the processor has AVX2.
    unsafe { Two(half(_mm256_castps256_ps128(y)), half(_mm256_extractf128_ps::<1>(y))) }
}

#[inline(always)]
unsafe fn narrow8(wide: X8) -> __m256 {
    // SAFETY: registers only: an X8 is made only where the processor has AVX-512.
    unsafe { _mm512_cvtpd_ps(wide.0) }
}

#[inline(always)]
unsafe fn widen8(y: __m256) -> X8 {
    // SAFETY: registers only: the caller is inlined into kernels for AVX-512.
    X8(unsafe { _mm512_cvtps_pd(y) })
}

/// Rows of four from four columns: the first holds rows 0 and 4, and so on.
#[inline(always)]
unsafe fn quads([a, b, c, d]: [__m256; 4]) -> [__m256; 4] {
    // SAFETY: registers only: the caller has made the columns where the processor has AVX2.
    unsafe {
        let (ab, cd) = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
        let (ab2, cd2) = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
        [
            _mm256_shuffle_ps::<0x44>(ab, cd),
            _mm256_shuffle_ps::<0xEE>(ab, cd),
            _mm256_shuffle_ps::<0x44>(ab2, cd2),
            _mm256_shuffle_ps::<0xEE>(ab2, cd2),
        ]
    }
}

/// The lower halves of both, or the upper ones.
#[inline(always)]
unsafe fn halves(a: __m256, b: __m256, upper: bool) -> __m256 {
    // SAFETY: registers only: the caller has made both where the processor has AVX2.
    unsafe { if upper { _mm256_permute2f128_ps::<0x31>(a, b) } else { _mm256_permute2f128_ps::<0x20>(a, b) } }
}

macro_rules! single {
    ($t:ident, $wide:ident, $narrow:ident, $widen:ident) => {
        operators!(
            $t,
            _mm256_add_ps,
            _mm256_sub_ps,
            _mm256_mul_ps,
            _mm256_div_ps,
            _mm256_xor_ps,
            _mm256_set1_ps
        );
        impl $t {
            /// In double precision.
            #[inline(always)]
            fn widen(self) -> $wide {
                // SAFETY: `self` was made where the processor has the width of its type, as the function asks for.
                unsafe { $widen(self.0) }
            }
        }
        impl Lane for $t {
            const WIDTH: usize = 8;
            const TINY: f64 = f32::TINY;
            type Mask = __m256;
            type Wide = $wide;

            #[inline(always)]
            fn narrow(wide: $wide) -> $t {
                // SAFETY: `wide` was made where the processor has the width of its type, as the function asks for.
                $t(unsafe { $narrow(wide) })
            }
            #[inline(always)]
            fn overlap(gap: $t, reach: $t, distance: $t) -> $t {
                gap / (reach + distance)
            }
            #[inline(always)]
            fn splat(x: f64) -> $t {
                // SAFETY: registers only: this is inlined into kernels of its width, which are called after asking the processor.
                $t(unsafe { _mm256_set1_ps(x as f32) })
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
                // SAFETY: registers only: `self` was made where the processor has the width of its type.
                $t(unsafe { _mm256_sqrt_ps(self.0) })
            }
            #[inline(always)]
            fn min(self, o: $t) -> $t {
                // SAFETY: registers only: both operands were made where the processor has the width of their type.
                $t(unsafe { _mm256_min_ps(self.0, o.0) })
            }
            #[inline(always)]
            fn max(self, o: $t) -> $t {
                // SAFETY: registers only: both operands were made where the processor has the width of their type.
                $t(unsafe { _mm256_max_ps(self.0, o.0) })
            }
            #[inline(always)]
            fn gt(self, o: $t) -> __m256 {
                // SAFETY: registers only: both operands were made where the processor has the width of their type.
                unsafe { _mm256_cmp_ps::<_CMP_GT_OQ>(self.0, o.0) }
            }
            #[inline(always)]
            fn select(mask: __m256, yes: $t, no: $t) -> $t {
                // SAFETY: registers only: the mask comes from a comparison of this width.
                $t(unsafe { _mm256_blendv_ps(no.0, yes.0, mask) })
            }
            #[inline(always)]
            fn both(a: __m256, b: __m256) -> __m256 {
                // SAFETY: registers only: both masks come from comparisons of this width.
                unsafe { _mm256_and_ps(a, b) }
            }
            #[inline(always)]
            fn any(mask: __m256) -> bool {
                // SAFETY: registers only: the mask comes from a comparison of this width.
                unsafe { _mm256_movemask_ps(mask) != 0 }
            }
            #[inline(always)]
            fn rows(table: &[Row], indices: Indices) -> [$t; 8] {
                let c = $wide::rows(table, indices);
                let n = $t::narrow;
                [n(c[0]), n(c[1]), n(c[2]), n(c[3]), n(c[4]), n(c[5]), n(c[6]), n(c[7])]
            }
            #[inline(always)]
            fn rows4(table: &[Row4], indices: Indices) -> [$t; 4] {
                let c = $wide::rows4(table, indices);
                let n = $t::narrow;
                [n(c[0]), n(c[1]), n(c[2]), n(c[3])]
            }
            #[inline(always)]
            fn store_rows(columns: [$t; 8], to: &mut [f64]) {
                let [a, b, c, d, e, f, g, h] = columns;
                let w = $t::widen;
                $wide::store_rows([w(a), w(b), w(c), w(d), w(e), w(f), w(g), w(h)], to);
            }
            #[inline(always)]
            fn store_rows4(columns: [$t; 4], to: &mut [f64]) {
                let [a, b, c, d] = columns;
                let w = $t::widen;
                $wide::store_rows4([w(a), w(b), w(c), w(d)], to);
            }
            #[inline(always)]
            fn load_single(from: &[f32]) -> $t {
                let from = &from[..8];
                // SAFETY: eight floats are there, as checked above; the kernel around is one for AVX2 at least.
                $t(unsafe { _mm256_loadu_ps(from.as_ptr()) })
            }
            #[inline(always)]
            fn store_single(self, to: &mut [f32]) {
                let to = &mut to[..8];
                // SAFETY: there is room for eight floats, as checked above; `self` was made where the processor has AVX.
                unsafe { _mm256_storeu_ps(to.as_mut_ptr(), self.0) }
            }
            #[inline(always)]
            fn store_rows_single(columns: [$t; 8], to: &mut [f32]) {
                let [a, b, c, d, e, f, g, h] = columns;
                // SAFETY: the columns were made where the processor has AVX2, as the function asks for.
                let (low, high) = unsafe { (quads([a.0, b.0, c.0, d.0]), quads([e.0, f.0, g.0, h.0])) };
                for (k, row) in to[..64].as_chunks_mut::<8>().0.iter_mut().enumerate() {
                    let (l, h) = (low[k % 4], high[k % 4]);
                    // SAFETY: a row is eight floats; the halves come from columns that were made where the processor has AVX2.
                    unsafe {
                        _mm256_storeu_ps(row.as_mut_ptr(), halves(l, h, k >= 4));
                    }
                }
            }
            #[inline(always)]
            fn store_rows4_single(columns: [$t; 4], to: &mut [f32]) {
                let [a, b, c, d] = columns;
                // SAFETY: the columns were made where the processor has AVX2, as the function asks for.
                let q = unsafe { quads([a.0, b.0, c.0, d.0]) };
                for (k, rows) in to[..32].as_chunks_mut::<8>().0.iter_mut().enumerate() {
                    let (one, next) = (q[k % 2 * 2], q[k % 2 * 2 + 1]);
                    // SAFETY: two rows are eight floats; the halves come from columns that were made where the processor has AVX2.
                    unsafe {
                        _mm256_storeu_ps(rows.as_mut_ptr(), halves(one, next, k >= 2));
                    }
                }
            }
        }
    };
}

single!(Y4, X4x2, narrow4, widen4);
single!(Y8, X8, narrow8, widen8);
