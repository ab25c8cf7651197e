//! Roots on a GPU: `core` does not have them.

/// What the standard library has on processors.
pub trait Float {
    /// √x, rounded as IEEE 754 has it.
    fn sqrt(self) -> Self;
}

macro_rules! float {
    ($number:ident, $sqrt:ident) => {
        impl Float for $number {
            #[inline(always)]
            fn sqrt(self) -> $number {
                core::intrinsics::$sqrt(self)
            }
        }
    };
}
float!(f32, sqrtf32);
float!(f64, sqrtf64);
