//! What a contact keeps from step to step: as lanes while an effect computes, as columns in lists.

use crate::simd::{BLOCK, Lane, Number, V};

/// History that is stored as columns of numbers.
pub trait History<R: Lane>: Copy {
    /// Numbers for each contact.
    const COLUMNS: usize;
    /// Reads the lanes from `lane` on in a block of columns, [`BLOCK`] apart.
    fn load<T: Number>(block: &[T], lane: usize) -> Self;
    /// Writes them.
    fn store<T: Number>(self, block: &mut [T], lane: usize);
    /// Sets it to 0 where the mask does not hold.
    fn keep(self, mask: R::Mask) -> Self;
    /// Whether a column changes its sign when i and j are exchanged, as vectors do.
    fn flips(column: usize) -> bool;
}

impl<R: Lane> History<R> for () {
    const COLUMNS: usize = 0;
    #[inline(always)]
    fn load<T: Number>(_: &[T], _: usize) {}
    #[inline(always)]
    fn store<T: Number>(self, _: &mut [T], _: usize) {}
    #[inline(always)]
    fn keep(self, _: R::Mask) {}
    fn flips(_: usize) -> bool {
        false
    }
}

/// A scalar has the same value for i and for j.
impl<R: Lane> History<R> for R {
    const COLUMNS: usize = 1;
    #[inline(always)]
    fn load<T: Number>(block: &[T], lane: usize) -> R {
        T::load(&block[lane..])
    }
    #[inline(always)]
    fn store<T: Number>(self, block: &mut [T], lane: usize) {
        T::store(self, &mut block[lane..]);
    }
    #[inline(always)]
    fn keep(self, mask: R::Mask) -> R {
        R::select(mask, self, R::splat(0.0))
    }
    fn flips(_: usize) -> bool {
        false
    }
}

impl<R: Lane> History<R> for V<R> {
    const COLUMNS: usize = 3;
    #[inline(always)]
    fn load<T: Number>(block: &[T], lane: usize) -> V<R> {
        let (x, y, z) = (&block[lane..], &block[BLOCK + lane..], &block[2 * BLOCK + lane..]);
        V::new(T::load(x), T::load(y), T::load(z))
    }
    #[inline(always)]
    fn store<T: Number>(self, block: &mut [T], lane: usize) {
        T::store(self.x, &mut block[lane..]);
        T::store(self.y, &mut block[BLOCK + lane..]);
        T::store(self.z, &mut block[2 * BLOCK + lane..]);
    }
    #[inline(always)]
    fn keep(self, mask: R::Mask) -> V<R> {
        V::select(mask, self, V::zero())
    }
    fn flips(_: usize) -> bool {
        true
    }
}

impl<R: Lane, A: History<R>, B: History<R>> History<R> for (A, B) {
    const COLUMNS: usize = A::COLUMNS + B::COLUMNS;
    #[inline(always)]
    fn load<T: Number>(block: &[T], lane: usize) -> (A, B) {
        (A::load(block, lane), B::load(&block[A::COLUMNS * BLOCK..], lane))
    }
    #[inline(always)]
    fn store<T: Number>(self, block: &mut [T], lane: usize) {
        self.0.store(block, lane);
        self.1.store(&mut block[A::COLUMNS * BLOCK..], lane);
    }
    #[inline(always)]
    fn keep(self, mask: R::Mask) -> (A, B) {
        (self.0.keep(mask), self.1.keep(mask))
    }
    fn flips(column: usize) -> bool {
        if column < A::COLUMNS { A::flips(column) } else { B::flips(column - A::COLUMNS) }
    }
}
