//! Moves each particle by the sum of its forces: velocity Verlet with predicted velocities.
//!
//! ```text
//! v_n     = v*_n + (a_n − a_{n−1}) Δt/2          a_n from forces at (x_n, v*_n)
//! x_{n+1} = x_n + v_n Δt + a_n Δt²/2
//! v*_{n+1} = v_n + a_n Δt                        predicted, so that forces see one instant
//! ```
//!
//! Velocity Verlet: Swope et al. (1982), J. Chem. Phys. 76; positions and velocities of one instant in the force:
//! Vyas, Ottino, Lueptow & Umbanhowar (2024), arXiv:2410.14798. Rotation in the same way, I = 2/5 m r².

use crate::kernel::Sums;
use crate::kernel::wrenches::split_off;
use crate::simd::number::with_layout;
use crate::simd::{Each, Four, Number, Row, Row4, Width};
use crate::space::sphere::inverse_inertia;
use crate::state::{Particles, SleeperSlices};
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

/// What one move found.
#[derive(Clone, Copy, Default)]
pub struct MoveFlags {
    /// Whether a particle has left its margin.
    pub left_margin: bool,
    /// Whether a particle moved more than its limit, or is not a number.
    pub too_fast: bool,
}

impl MoveFlags {
    /// Either.
    pub fn and(self, o: MoveFlags) -> MoveFlags {
        MoveFlags { left_margin: self.left_margin | o.left_margin, too_fast: self.too_fast | o.too_fast }
    }
}

/// Step [s], acceleration of free fall [m/s²], largest motion in one step over the radius [–].
#[derive(Clone, Copy)]
pub struct MoveInputs {
    pub dt: f64,
    /// How far ahead in time contacts are looked for [s].
    pub ahead: f64,
    pub gravity: [f64; 3],
    pub motion_limit: f64,
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
    use crate::simd::x86::X4;

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
    let sums = sums.as_ref();
    let [gx, gy, gz] = drive.gravity;
    let gravity = Q::read(&[gx, gy, gz, 0.0]);
    // Rows hold radius and 1/m in the fourth place, which must not move.
    let three = Q::read(&[1.0, 1.0, 1.0, 0.0]);
    let (dt, half, square) = (Q::all(drive.dt), Q::all(0.5 * drive.dt), Q::all(0.5 * drive.dt * drive.dt));
    let mut moved = MoveFlags::default();
    for k in 0..rows.len() {
        let ([position, velocity], []) = rows[k].as_chunks_mut::<4>() else { continue };
        let (radius, inverse_mass) = (position[3], velocity[3]);
        let sum = sums.sum::<T, Q, SPIN>(k, radius);
        let new = (sum.force * Q::all(inverse_mass) + gravity) * three;
        let v = Q::read(velocity) + half * (new - Q::read(&acceleration[k]));
        let moves = (dt * v + square * new) * three;
        let there = Q::read(position) + moves;
        there.write(position);
        let predicted = v + dt * new;
        predicted.write(velocity);
        new.write(&mut acceleration[k]);
        let limit = drive.motion_limit * radius;
        // Written so that NaN is caught.
        moved.too_fast |= !(length2(moves) <= limit * limit);
        let mut margin = home[k][3];
        if drive.ahead > 0.0 {
            margin = (margin - drive.ahead * length2(predicted * three).sqrt()).max(0.0);
        }
        moved.left_margin |= length2(there - Q::read(&home[k])) > margin * margin;
        if SPIN {
            let new = sum.moment * Q::all(inverse_inertia(radius, inverse_mass)) * three;
            let w = Q::read(&spins[k]) + half * (new - Q::read(&angular_acceleration[k]));
            (w + dt * new).write(&mut spins[k]);
            new.write(&mut angular_acceleration[k]);
        }
    }
    moved
}

/// x² + y² + z².
#[inline(always)]
fn length2<Q: Four>(v: Q) -> f64 {
    let mut row = [0.0; 4];
    (v * v).write(&mut row);
    row[0] + row[1] + row[2]
}
