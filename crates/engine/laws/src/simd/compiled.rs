//! One source, compiled for every width of lanes and called by what the processor has.

use crate::simd::{Lane, Two, Width};
#[cfg(target_arch = "x86_64")]
use crate::simd::{
    x86::{X4, X8},
    x86_single::{Y4, Y8},
};

/// Work on lanes of any width; every width gives the same bits.
pub trait Job {
    /// What it gives.
    type Output;
    /// Does it with lanes `R`; inlined always, into the function that is compiled for their registers.
    fn run<R: Lane>(self) -> Self::Output;
}

/// The lanes of each width.
pub trait Lanes {
    /// One at a time.
    type Scalar: Lane;
    /// With AVX2.
    #[cfg(target_arch = "x86_64")]
    type Avx2: Lane;
    /// With AVX-512.
    #[cfg(target_arch = "x86_64")]
    type Avx512: Lane;
}

/// Double precision, eight at a time: for long chains of roots and divisions.
pub struct Eights;
/// Double precision, as many at a time as a register holds: for work with many numbers at once.
pub struct Registers;
/// Single precision.
pub struct Singles;

macro_rules! lanes {
    ($name:ident, $scalar:ty, $avx2:ty, $avx512:ty) => {
        impl Lanes for $name {
            type Scalar = $scalar;
            #[cfg(target_arch = "x86_64")]
            type Avx2 = $avx2;
            #[cfg(target_arch = "x86_64")]
            type Avx512 = $avx512;
        }
    };
}
lanes!(Eights, f64, Two<X4>, X8);
lanes!(Registers, f64, X4, X8);
lanes!(Singles, f32, Y4, Y8);

/// Does a job with the lanes `L` of a width.
pub fn run<L: Lanes, J: Job>(width: Width, job: J) -> J::Output {
    match width {
        #[cfg(target_arch = "x86_64")]
        Width::Avx512 => wide::avx512::<L, J>(job),
        #[cfg(target_arch = "x86_64")]
        Width::Avx2 => wide::avx2::<L, J>(job),
        _ => job.run::<L::Scalar>(),
    }
}

#[cfg(target_arch = "x86_64")]
mod wide {
    #![expect(
        unsafe_code,
        reason = "one source is compiled for several widths and called after asking the processor"
    )]
    use super::{Job, Lanes};

    macro_rules! compiled {
        ($name:ident, $lanes:ident, $features:literal) => {
            pub fn $name<L: Lanes, J: Job>(job: J) -> J::Output {
                #[target_feature(enable = $features)]
                fn inner<L: Lanes, J: Job>(job: J) -> J::Output {
                    job.run::<L::$lanes>()
                }
                // SAFETY: a width is only made where the processor has its features.
                unsafe { inner::<L, J>(job) }
            }
        };
    }
    compiled!(avx512, Avx512, "avx512f,avx512dq,avx2");
    compiled!(avx2, Avx2, "avx2");
}
