//! Roots and whole numbers: those of the standard library, and on a GPU, which does not have it, those of the compiler.

/// What `core` does not have.
pub trait Float {
    /// √x, rounded as IEEE 754 has it.
    fn root(self) -> Self;
    /// The largest whole number that is no larger.
    fn whole(self) -> Self;
    /// The nearest whole number, of two the one farther from 0.
    fn nearest(self) -> Self;
}

macro_rules! float {
    ($number:ident: $root:path, $whole:path, $nearest:path) => {
        impl Float for $number {
            #[inline(always)]
            fn root(self) -> $number {
                $root(self)
            }
            #[inline(always)]
            fn whole(self) -> $number {
                $whole(self)
            }
            #[inline(always)]
            fn nearest(self) -> $number {
                $nearest(self)
            }
        }
    };
}

#[cfg(not(target_arch = "nvptx64"))]
mod here {
    use super::Float;
    float!(f32: f32::sqrt, f32::floor, f32::round);
    float!(f64: f64::sqrt, f64::floor, f64::round);
}

#[cfg(target_arch = "nvptx64")]
mod here {
    use super::Float;
    use core::intrinsics::{floorf32, floorf64, roundf32, roundf64, sqrtf32, sqrtf64};
    float!(f32: sqrtf32, floorf32, roundf32);
    float!(f64: sqrtf64, floorf64, roundf64);
}
