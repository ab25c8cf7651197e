//! Four and eight contacts at a time by AVX2 and AVX-512.
//!
//! Safety of this file: the types are made only inside kernels that [`crate::simd::Width`] dispatches to after
//! asking the processor; every load and store is preceded by a check of its slice's length or of the
//! index, as in scalar code. All functions are inlined into those kernels.
#![expect(unsafe_code, reason = "the processor's own vector instructions")]

use crate::simd::{Four, Indices, Lane, Row, Row4};
use core::arch::x86_64::*;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// Asks for the cache line of an address.
#[inline(always)]
pub fn fetch<T>(at: *const T) {
    // SAFETY: a hint, which reads nothing and may be given any address.
    unsafe { _mm_prefetch::<_MM_HINT_T0>(at.cast()) }
}

/// Four doubles.
#[derive(Clone, Copy)]
pub struct X4(pub __m256d);

/// Eight doubles.
#[derive(Clone, Copy)]
pub struct X8(pub __m512d);

/// Arithmetic of a type of lanes.
macro_rules! operators {
    ($t:ident, $add:ident, $sub:ident, $mul:ident, $div:ident, $xor:ident, $set:ident) => {
        operators!(@ $t, Add, add, $add);
        operators!(@ $t, Sub, sub, $sub);
        operators!(@ $t, Mul, mul, $mul);
        operators!(@ $t, Div, div, $div);
        impl Neg for $t {
            type Output = $t;
            #[inline(always)]
            fn neg(self) -> $t {
                // SAFETY: registers only: `self` was made where the processor has the width of its type. Flips the sign bit, as scalar negation does.
                $t(unsafe { $xor(self.0, $set(-0.0)) })
            }
        }
    };
    (@ $t:ident, $trait:ident, $f:ident, $op:ident) => {
        impl $trait for $t {
            type Output = $t;
            #[inline(always)]
            fn $f(self, o: $t) -> $t {
                // SAFETY: registers only: both operands were made where the processor has the width of their type.
                $t(unsafe { $op(self.0, o.0) })
            }
        }
    };
}
pub(crate) use operators;

operators!(X4, _mm256_add_pd, _mm256_sub_pd, _mm256_mul_pd, _mm256_div_pd, _mm256_xor_pd, _mm256_set1_pd);
operators!(X8, _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd, _mm512_div_pd, _mm512_xor_pd, _mm512_set1_pd);

/// Functions of [`Lane`] that are one instruction for `$n` doubles.
macro_rules! doubles {
    ($t:ident, $n:literal, $set:ident, $load:ident, $store:ident, $sqrt:ident, $min:ident, $max:ident) => {
        const WIDTH: usize = $n;
        const TINY: f64 = f64::TINY;
        type Wide = $t;

        #[inline(always)]
        fn narrow(wide: $t) -> $t {
            wide
        }
        #[inline(always)]
        fn overlap(_: $t, reach: $t, distance: $t) -> $t {
            reach - distance
        }
        #[inline(always)]
        fn splat(x: f64) -> $t {
            // SAFETY: registers only: this is inlined into kernels of its width, which are called after asking the processor.
            $t(unsafe { $set(x) })
        }
        #[inline(always)]
        fn load(from: &[f64]) -> $t {
            let from = &from[..$n];
            // SAFETY: as many numbers, as checked above.
            $t(unsafe { $load(from.as_ptr()) })
        }
        #[inline(always)]
        fn store(self, to: &mut [f64]) {
            let to = &mut to[..$n];
            // SAFETY: as many numbers, as checked above.
            unsafe { $store(to.as_mut_ptr(), self.0) }
        }
        #[inline(always)]
        fn sqrt(self) -> $t {
            // SAFETY: registers only: `self` was made where the processor has the width of its type.
            $t(unsafe { $sqrt(self.0) })
        }
        #[inline(always)]
        fn min(self, o: $t) -> $t {
            // SAFETY: registers only: both operands were made where the processor has the width of their type.
            $t(unsafe { $min(self.0, o.0) })
        }
        #[inline(always)]
        fn max(self, o: $t) -> $t {
            // SAFETY: registers only: both operands were made where the processor has the width of their type.
            $t(unsafe { $max(self.0, o.0) })
        }
    };
}

/// The first `N` indices, and the start of the table that they point into.
#[inline(always)]
fn first<'a, const N: usize, T>(table: &'a [T], indices: Indices<'a>) -> (&'a [u32], *const T) {
    assert!(indices.rows <= table.len());
    (&indices.of[..N], table.as_ptr())
}

#[inline(always)]
fn transpose4(r: [__m256d; 4]) -> [__m256d; 4] {
    // SAFETY: registers only: the rows were loaded where the processor has AVX2.
    unsafe {
        let a = _mm256_unpacklo_pd(r[0], r[1]);
        let b = _mm256_unpackhi_pd(r[0], r[1]);
        let c = _mm256_unpacklo_pd(r[2], r[3]);
        let d = _mm256_unpackhi_pd(r[2], r[3]);
        [
            _mm256_permute2f128_pd::<0x20>(a, c),
            _mm256_permute2f128_pd::<0x20>(b, d),
            _mm256_permute2f128_pd::<0x31>(a, c),
            _mm256_permute2f128_pd::<0x31>(b, d),
        ]
    }
}

#[inline(always)]
fn transpose8(r: [__m512d; 8]) -> [__m512d; 8] {
    // SAFETY: registers only: the rows were loaded where the processor has AVX-512.
    unsafe {
        let lo = |a, b| _mm512_unpacklo_pd(a, b);
        let hi = |a, b| _mm512_unpackhi_pd(a, b);
        let t = [
            lo(r[0], r[1]),
            hi(r[0], r[1]),
            lo(r[2], r[3]),
            hi(r[2], r[3]),
            lo(r[4], r[5]),
            hi(r[4], r[5]),
            lo(r[6], r[7]),
            hi(r[6], r[7]),
        ];
        let even = |a, b| _mm512_shuffle_f64x2::<0x88>(a, b);
        let odd = |a, b| _mm512_shuffle_f64x2::<0xdd>(a, b);
        // u[k]: columns k and k + 4 of rows 0–3 (first four) and 4–7 (last four), in 128-bit pairs
        let u = [even(t[0], t[2]), even(t[1], t[3]), odd(t[0], t[2]), odd(t[1], t[3])];
        let v = [even(t[4], t[6]), even(t[5], t[7]), odd(t[4], t[6]), odd(t[5], t[7])];
        [
            even(u[0], v[0]),
            even(u[1], v[1]),
            even(u[2], v[2]),
            even(u[3], v[3]),
            odd(u[0], v[0]),
            odd(u[1], v[1]),
            odd(u[2], v[2]),
            odd(u[3], v[3]),
        ]
    }
}

impl Lane for X4 {
    doubles!(
        X4,
        4,
        _mm256_set1_pd,
        _mm256_loadu_pd,
        _mm256_storeu_pd,
        _mm256_sqrt_pd,
        _mm256_min_pd,
        _mm256_max_pd
    );
    type Mask = __m256d;

    #[inline(always)]
    fn gt(self, o: X4) -> __m256d {
        // SAFETY: registers only: an X4 is made only where the processor has AVX2.
        unsafe { _mm256_cmp_pd::<_CMP_GT_OQ>(self.0, o.0) }
    }
    #[inline(always)]
    fn select(mask: __m256d, yes: X4, no: X4) -> X4 {
        // SAFETY: registers only: the mask comes from a comparison of this width.
        X4(unsafe { _mm256_blendv_pd(no.0, yes.0, mask) })
    }
    #[inline(always)]
    fn both(a: __m256d, b: __m256d) -> __m256d {
        // SAFETY: registers only: both masks come from comparisons of this width.
        unsafe { _mm256_and_pd(a, b) }
    }
    #[inline(always)]
    fn any(mask: __m256d) -> bool {
        // SAFETY: registers only: the mask comes from a comparison of this width.
        unsafe { _mm256_movemask_pd(mask) != 0 }
    }
    #[inline(always)]
    fn rows(table: &[Row], indices: Indices) -> [X4; 8] {
        let (of, table) = first::<4, Row>(table, indices);
        // SAFETY: the row is one of the table, has eight numbers, and `at` is 0 or 4.
        let half =
            |k: usize, at: usize| unsafe { _mm256_loadu_pd(table.add(of[k] as usize).cast::<f64>().add(at)) };
        let a = transpose4([half(0, 0), half(1, 0), half(2, 0), half(3, 0)]);
        let b = transpose4([half(0, 4), half(1, 4), half(2, 4), half(3, 4)]);
        [X4(a[0]), X4(a[1]), X4(a[2]), X4(a[3]), X4(b[0]), X4(b[1]), X4(b[2]), X4(b[3])]
    }
    #[inline(always)]
    fn rows4(table: &[Row4], indices: Indices) -> [X4; 4] {
        let (of, table) = first::<4, Row4>(table, indices);
        // SAFETY: the row is one of the table, and has four numbers.
        let row = |k: usize| unsafe { _mm256_loadu_pd(table.add(of[k] as usize).cast()) };
        transpose4([row(0), row(1), row(2), row(3)]).map(X4)
    }
    #[inline(always)]
    fn store_rows(c: [X4; 8], to: &mut [f64]) {
        let a = transpose4([c[0].0, c[1].0, c[2].0, c[3].0]);
        let b = transpose4([c[4].0, c[5].0, c[6].0, c[7].0]);
        for k in 0..4 {
            X4(a[k]).store(&mut to[8 * k..]);
            X4(b[k]).store(&mut to[8 * k + 4..]);
        }
    }
    #[inline(always)]
    fn store_rows4(c: [X4; 4], to: &mut [f64]) {
        let rows = transpose4([c[0].0, c[1].0, c[2].0, c[3].0]);
        for (k, row) in rows.into_iter().enumerate() {
            X4(row).store(&mut to[4 * k..]);
        }
    }
}

impl Lane for X8 {
    doubles!(
        X8,
        8,
        _mm512_set1_pd,
        _mm512_loadu_pd,
        _mm512_storeu_pd,
        _mm512_sqrt_pd,
        _mm512_min_pd,
        _mm512_max_pd
    );
    type Mask = __mmask8;

    #[inline(always)]
    fn gt(self, o: X8) -> __mmask8 {
        // SAFETY: registers only: an X8 is made only where the processor has AVX-512.
        unsafe { _mm512_cmp_pd_mask::<_CMP_GT_OQ>(self.0, o.0) }
    }
    #[inline(always)]
    fn select(mask: __mmask8, yes: X8, no: X8) -> X8 {
        // SAFETY: registers only: the mask comes from a comparison of this width.
        X8(unsafe { _mm512_mask_blend_pd(mask, no.0, yes.0) })
    }
    #[inline(always)]
    fn both(a: __mmask8, b: __mmask8) -> __mmask8 {
        a & b
    }
    #[inline(always)]
    fn any(mask: __mmask8) -> bool {
        mask != 0
    }
    #[inline(always)]
    fn rows(table: &[Row], indices: Indices) -> [X8; 8] {
        let (of, table) = first::<8, Row>(table, indices);
        // SAFETY: the row is one of the table, and has eight numbers.
        let row = |k: usize| unsafe { _mm512_loadu_pd(table.add(of[k] as usize).cast()) };
        transpose8([row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7)]).map(X8)
    }
    #[inline(always)]
    fn rows4(table: &[Row4], indices: Indices) -> [X8; 4] {
        let (a, b) = (X4::rows4(table, indices), X4::rows4(table, indices.from(4)));
        // SAFETY: registers only: this is inlined into kernels for AVX-512, which are called after asking the processor.
        let join = |k: usize| unsafe { X8(_mm512_insertf64x4::<1>(_mm512_castpd256_pd512(a[k].0), b[k].0)) };
        [join(0), join(1), join(2), join(3)]
    }
    #[inline(always)]
    fn store_rows(c: [X8; 8], to: &mut [f64]) {
        let rows = transpose8(c.map(|x| x.0));
        for (k, row) in rows.into_iter().enumerate() {
            X8(row).store(&mut to[8 * k..]);
        }
    }
    #[inline(always)]
    fn store_rows4(c: [X8; 4], to: &mut [f64]) {
        // SAFETY: registers only: an X8 is made only where the processor has AVX-512.
        let half = |x: X8| unsafe { (X4(_mm512_castpd512_pd256(x.0)), X4(_mm512_extractf64x4_pd::<1>(x.0))) };
        let (a, b) = (c.map(|x| half(x).0), c.map(|x| half(x).1));
        X4::store_rows4(a, to);
        X4::store_rows4(b, &mut to[16..]);
    }
}

impl Four for X4 {
    #[inline(always)]
    fn read(from: &[f64; 4]) -> X4 {
        X4::load(from)
    }
    #[inline(always)]
    fn write(self, to: &mut [f64; 4]) {
        self.store(to);
    }
    #[inline(always)]
    fn all(x: f64) -> X4 {
        X4::splat(x)
    }
}
