//! Moves all particles of a slice of the columns ([`laws::contact::motion`] has the formula).

use crate::state::{Particles, SleeperSlices};
use laws::contact::wrenches::split_off;
use laws::contact::{MoveFlags, MoveInputs, Mover, Sums};
use laws::simd::{Each, Four, Number, Row, Row4, Width};
use laws::with_layout;
use std::ops::Range;

/// Columns of some particles.
pub struct ParticleSlices<'a> {
    /// Number of the first.
    pub first: usize,
    pub rows: &'a mut [Row],
    pub spins: &'a mut [Row4],
    pub acceleration: &'a mut [Row4],
    pub angular_acceleration: &'a mut [Row4],
    /// Positions at the last rebuild, and margins.
    pub home: &'a [Row4],
    /// Loads on them.
    pub sums: Sums<'a>,
    /// Which particles sleep, where the scene asks for it.
    pub sleeper_slices: Option<SleeperSlices<'a>>,
}

impl<'a> ParticleSlices<'a> {
    /// Those of a range, with their sums; nothing is known of sleep.
    pub fn of(particles: &'a mut Particles, range: Range<usize>, sums: Sums<'a>) -> ParticleSlices<'a> {
        let Particles { rows, spins, acceleration, angular_acceleration, home, .. } = particles;
        let rotating = if spins.is_empty() { 0..0 } else { range.clone() };
        ParticleSlices {
            first: range.start,
            rows: &mut rows[range.clone()],
            spins: &mut spins[rotating.clone()],
            acceleration: &mut acceleration[range.clone()],
            angular_acceleration: &mut angular_acceleration[rotating],
            home: &home[range],
            sums,
            sleeper_slices: None,
        }
    }

    /// Those of a range, counted from the first of these, for a while; whether they sleep is not known of them.
    pub fn range(&mut self, range: Range<usize>) -> ParticleSlices<'_> {
        let rotating = if self.spins.is_empty() { 0..0 } else { range.clone() };
        let mut sums = self.sums.by_ref();
        sums.split_off(range.start);
        ParticleSlices {
            first: self.first + range.start,
            rows: &mut self.rows[range.clone()],
            spins: &mut self.spins[rotating.clone()],
            acceleration: &mut self.acceleration[range.clone()],
            angular_acceleration: &mut self.angular_acceleration[rotating],
            home: &self.home[range.clone()],
            sums: sums.split_off(range.len()),
            sleeper_slices: None,
        }
    }

    /// Takes off the first `n` particles, or all where there are fewer.
    pub fn split_off(&mut self, n: usize) -> ParticleSlices<'a> {
        let (first, n) = (self.first, n.min(self.rows.len()));
        self.first += n;
        ParticleSlices {
            first,
            rows: split_off(&mut self.rows, n),
            spins: split_off(&mut self.spins, n),
            acceleration: split_off(&mut self.acceleration, n),
            angular_acceleration: split_off(&mut self.angular_acceleration, n),
            home: self.home.split_off(..n).unwrap_or_default(),
            sums: self.sums.split_off(n),
            sleeper_slices: self.sleeper_slices.as_mut().map(|s| s.split_off(n)),
        }
    }
}

/// Moves particles by one step, computing with lanes of `width`; all widths give the same bits.
pub fn advance(width: Width, columns: ParticleSlices, drive: &MoveInputs) -> MoveFlags {
    with_layout!(columns.sums.layout, T, ROTATES => dispatch::<T, ROTATES>(width, columns, drive))
}

fn dispatch<T: Number, const SPIN: bool>(
    width: Width,
    columns: ParticleSlices,
    drive: &MoveInputs,
) -> MoveFlags {
    match width {
        #[cfg(target_arch = "x86_64")]
        Width::Avx2 | Width::Avx512 => simd::avx2::<T, SPIN>(columns, drive),
        _ => chunk::<T, Each, SPIN>(columns, drive),
    }
}

#[cfg(target_arch = "x86_64")]
mod simd {
    //! The move, compiled for wider registers.
    #![expect(
        unsafe_code,
        reason = "one loop is compiled for several widths and called after asking the processor"
    )]
    use super::*;
    use laws::simd::x86::X4;

    pub fn avx2<T: Number, const SPIN: bool>(columns: ParticleSlices, drive: &MoveInputs) -> MoveFlags {
        #[target_feature(enable = "avx2")]
        fn inner<T: Number, const SPIN: bool>(columns: ParticleSlices, drive: &MoveInputs) -> MoveFlags {
            chunk::<T, X4, SPIN>(columns, drive)
        }
        // SAFETY: these widths are only made where the processor has AVX2.
        unsafe { inner::<T, SPIN>(columns, drive) }
    }
}

#[inline(always)]
fn chunk<T: Number, Q: Four, const SPIN: bool>(columns: ParticleSlices, drive: &MoveInputs) -> MoveFlags {
    let ParticleSlices { rows, spins, acceleration, angular_acceleration, home, sums, .. } = columns;
    let (sums, mover) = (sums.as_ref(), Mover::<Q>::new(drive));
    let mut moved = MoveFlags::default();
    for k in 0..rows.len() {
        let row = &mut rows[k];
        let sum = sums.sum::<T, Q, SPIN>(k, row.radius());
        moved = moved.and(mover.advance(row, &mut acceleration[k], &home[k], &sum));
        if SPIN {
            mover.turn(row, &mut spins[k], &mut angular_acceleration[k], &sum);
        }
    }
    moved
}
