//! Effects as numbers in a fixed order: a device gets them so.

use alloc::vec::Vec;

/// What can be written as numbers in a fixed order.
pub trait Numbers: Copy {
    /// How many.
    const COUNT: usize;
    /// Adds them at the end.
    fn put(&self, to: &mut Vec<f64>);
    /// Takes them off the front.
    ///
    /// # Panics
    /// When there are fewer.
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

impl Numbers for () {
    const COUNT: usize = 0;
    fn put(&self, _: &mut Vec<f64>) {}
    #[inline(always)]
    fn take(_: &mut &[f64]) {}
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

/// 1 and its numbers, or as many zeros.
impl<T: Numbers> Numbers for Option<T> {
    const COUNT: usize = 1 + T::COUNT;
    fn put(&self, to: &mut Vec<f64>) {
        to.push(f64::from(u8::from(self.is_some())));
        match self {
            Some(value) => value.put(to),
            None => to.resize(to.len() + T::COUNT, 0.0),
        }
    }
    #[inline(always)]
    fn take(from: &mut &[f64]) -> Option<T> {
        let there = f64::take(from) > 0.0;
        let value = T::take(from);
        there.then_some(value)
    }
}

/// [`Numbers`] of a structure, by its fields; or of an enum of two variants that hold a value each.
macro_rules! numbers {
    ($type:ty { $($field:ident: $of:ty),* $(,)? }) => {
        impl $crate::effects::Numbers for $type {
            const COUNT: usize = 0 $(+ <$of as $crate::effects::Numbers>::COUNT)*;
            fn put(&self, to: &mut alloc::vec::Vec<f64>) {
                // A field that is missing here does not compile.
                let Self { $($field),* } = self;
                $($crate::effects::Numbers::put($field, to);)*
            }
            #[inline(always)]
            fn take(from: &mut &[f64]) -> Self {
                // In the order in which they stand.
                Self { $($field: <$of as $crate::effects::Numbers>::take(from)),* }
            }
        }
    };
    ($type:ty: $first:ident($a:ty) or $second:ident($b:ty)) => {
        impl $crate::effects::Numbers for $type {
            const COUNT: usize = <(Option<$a>, Option<$b>) as $crate::effects::Numbers>::COUNT;
            fn put(&self, to: &mut alloc::vec::Vec<f64>) {
                let both: (Option<$a>, Option<$b>) = match self {
                    Self::$first(value) => (Some(*value), None),
                    Self::$second(value) => (None, Some(*value)),
                };
                $crate::effects::Numbers::put(&both, to);
            }
            #[inline(always)]
            fn take(from: &mut &[f64]) -> Self {
                // The one that is not there is zeros.
                let is_first = <f64 as $crate::effects::Numbers>::take(from) > 0.0;
                let a = <$a as $crate::effects::Numbers>::take(from);
                <f64 as $crate::effects::Numbers>::take(from);
                let b = <$b as $crate::effects::Numbers>::take(from);
                if is_first { Self::$first(a) } else { Self::$second(b) }
            }
        }
    };
}
pub(super) use numbers;
