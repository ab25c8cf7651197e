//! Roots and whole numbers on a GPU: `core` does not have them.

/// What the standard library has on processors.
pub trait Float {
    /// √x, rounded as IEEE 754 has it.
    fn sqrt(self) -> Self;
    /// The largest whole number that is no larger.
    fn floor(self) -> Self;
    /// The nearest whole number, of two the one farther from 0.
    fn round(self) -> Self;
}

macro_rules! float {
    ($number:ident, $sqrt:ident, $floor:ident, $round:ident) => {
        impl Float for $number {
            #[inline(always)]
            fn sqrt(self) -> $number {
                core::intrinsics::$sqrt(self)
            }
            #[inline(always)]
            fn floor(self) -> $number {
                core::intrinsics::$floor(self)
            }
            #[inline(always)]
            fn round(self) -> $number {
                core::intrinsics::$round(self)
            }
        }
    };
}
float!(f32, sqrtf32, floorf32, roundf32);
float!(f64, sqrtf64, floorf64, roundf64);
