//! Wrenches of a block of contacts between their computation and their sums.

use super::Batch;
use super::sums::Pairs;
use crate::simd::{BLOCK, FORCE_AND_MOMENT, Number, TORQUE};

/// Wrenches of some contacts, as they have just been computed.
#[repr(align(64))]
pub struct WrenchBuffer<T> {
    /// Forces, with moments where anything rotates.
    pub forces: [T; BLOCK * FORCE_AND_MOMENT],
    /// Torques besides.
    pub torques: [T; BLOCK * TORQUE],
}

impl<T: Number> WrenchBuffer<T> {
    /// Of none.
    #[expect(clippy::new_without_default, reason = "a buffer is made where it is filled, never by default")]
    #[inline(always)]
    pub fn new() -> WrenchBuffer<T> {
        WrenchBuffer {
            forces: [T::default(); BLOCK * FORCE_AND_MOMENT],
            torques: [T::default(); BLOCK * TORQUE],
        }
    }

    /// Adds the wrenches (of `N` numbers) of `width` contacts from slot `at` on to their particles, and copies them where they are kept.
    #[inline(always)]
    pub fn scatter<const N: usize>(&self, batch: &mut Batch, at: usize, width: usize, torques: bool) {
        let pairs = Pairs { i: &batch.i[at..at + width], j: &batch.j[at..at + width], both: batch.both };
        let forces = &self.forces[..width * N];
        let torques = if torques { &self.torques[..width * TORQUE] } else { &[] };
        batch.sums.accumulate::<T, N>(pairs, forces, torques);
        keep(batch.kept.forces, at * N, forces);
        keep(batch.kept.torques, at * TORQUE, torques);
        keep(batch.each.forces, at * N, forces);
        keep(batch.each.torques, at * TORQUE, torques);
    }
}

/// Copies to a column, if there is one.
#[inline(always)]
fn keep<T: Number>(column: &mut [f64], at: usize, rows: &[T]) {
    if !column.is_empty() {
        T::of_mut(column)[at..at + rows.len()].copy_from_slice(rows);
    }
}
