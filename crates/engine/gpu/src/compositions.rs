//! The compositions that are compiled for devices as well, and how a device gets one: as numbers in a fixed order.
//!
//! To add a law: a line in `ported!`, a `fields!` line for its numbers, and a branch in `dem/src/model/compose.rs` that makes it [`Portable`]. It may
//! keep at most 8 numbers of history (`threads.rs`). Then `make -C crates/engine/cuda/kernels`.

use alloc::vec::Vec;
use laws::contact::{Batch, Composition, StepInputs, run};
use laws::effects::{Damping, Effect, Hertz, Hooke, RollingResistance, SlidingFriction};
use laws::simd::Width;
use laws::simd::compiled::Eights;

/// The compositions that devices have, by name: given to the macro that is named.
#[macro_export]
macro_rules! ported {
    ($then:ident) => {
        $then! {
            hooke: $crate::laws::effects::Hooke;
            hooke_sliding: ($crate::laws::effects::Hooke, $crate::laws::effects::SlidingFriction);
            hooke_rolling: ($crate::laws::effects::Hooke, ($crate::laws::effects::SlidingFriction, $crate::laws::effects::RollingResistance));
            hertz: $crate::laws::effects::Hertz;
            hertz_sliding: ($crate::laws::effects::Hertz, $crate::laws::effects::SlidingFriction);
            hertz_rolling: ($crate::laws::effects::Hertz, ($crate::laws::effects::SlidingFriction, $crate::laws::effects::RollingResistance));
        }
    };
}

/// A composition that devices have.
pub trait Ported: Effect + Numbers {
    /// Its name, which is also that of the function that computes it.
    const NAME: &'static str;
}

macro_rules! names {
    ($($name:ident: $effects:ty;)*) => {
        $(impl Ported for $effects {
            const NAME: &'static str = stringify!($name);
        })*
        /// Their names.
        pub const NAMES: &[&str] = &[$(stringify!($name)),*];
    };
}
ported!(names);

/// A composition that is computed here, and can be by a device.
pub struct Portable<E>(pub E);

impl<E: Ported> Composition for Portable<E> {
    fn columns(&self) -> usize {
        self.0.columns()
    }
    fn flips(&self, column: usize) -> bool {
        self.0.flips(column)
    }
    fn rotates(&self) -> bool {
        self.0.rotates()
    }
    fn torques(&self) -> bool {
        self.0.torques()
    }
    fn run(&self, width: Width, step: StepInputs, batch: Batch) -> bool {
        run::<Eights, E, f64>(&self.0, width, step, batch)
    }
    fn ported(&self) -> Option<(&'static str, Vec<f64>)> {
        let mut numbers = Vec::new();
        self.0.put(&mut numbers);
        Some((E::NAME, numbers))
    }
}

/// What a device gets as numbers in a fixed order.
pub trait Numbers: Copy {
    /// How many.
    const COUNT: usize;
    /// Adds them at the end.
    fn put(&self, to: &mut Vec<f64>);
    /// Takes them off the front.
    fn take(from: &mut &[f64]) -> Self;
}

impl Numbers for f64 {
    const COUNT: usize = 1;
    fn put(&self, to: &mut Vec<f64>) {
        to.push(*self);
    }
    #[inline(always)]
    fn take(from: &mut &[f64]) -> f64 {
        let (number, rest) = (from[0], &from[1..]);
        *from = rest;
        number
    }
}

impl<A: Numbers, B: Numbers> Numbers for (A, B) {
    const COUNT: usize = A::COUNT + B::COUNT;
    fn put(&self, to: &mut Vec<f64>) {
        self.0.put(to);
        self.1.put(to);
    }
    #[inline(always)]
    fn take(from: &mut &[f64]) -> (A, B) {
        let first = A::take(from);
        (first, B::take(from))
    }
}

impl Numbers for [f64; 2] {
    const COUNT: usize = 2;
    fn put(&self, to: &mut Vec<f64>) {
        to.extend(self);
    }
    #[inline(always)]
    fn take(from: &mut &[f64]) -> [f64; 2] {
        let first = f64::take(from);
        [first, f64::take(from)]
    }
}

macro_rules! fields {
    ($type:ty { $($field:ident: $of:ty),* }) => {
        impl Numbers for $type {
            const COUNT: usize = 0 $(+ <$of>::COUNT)*;
            fn put(&self, to: &mut Vec<f64>) {
                $(self.$field.put(to);)*
            }
            #[inline(always)]
            fn take(from: &mut &[f64]) -> $type {
                // In the order in which they stand.
                Self { $($field: <$of>::take(from)),* }
            }
        }
    };
}
fields!(Damping { ratio: f64, first: f64, second: f64, booked: [f64; 2], dissipates: f64 });
fields!(Hooke { stiffness: f64, damping: Damping });
fields!(Hertz { modulus: f64, damping: Damping });
fields!(SlidingFriction { friction: f64, stiffness_ratio: f64, damping_ratio: f64, compliance: f64 });
fields!(RollingResistance { resistance: f64 });

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back_as_they_were() {
        let damping = Damping { ratio: 1.0, first: 2.0, second: 3.0, booked: [4.0, 5.0], dissipates: 6.0 };
        let sliding =
            SlidingFriction { friction: 8.0, stiffness_ratio: 9.0, damping_ratio: 10.0, compliance: 11.0 };
        let all = (Hertz { modulus: 7.0, damping }, (sliding, RollingResistance { resistance: 12.0 }));
        let mut numbers = Vec::new();
        all.put(&mut numbers);
        assert_eq!(numbers.len(), <(Hertz, (SlidingFriction, RollingResistance))>::COUNT);
        let mut rest = numbers.as_slice();
        assert_eq!(<(Hertz, (SlidingFriction, RollingResistance))>::take(&mut rest), all);
        assert!(rest.is_empty());
    }
}
