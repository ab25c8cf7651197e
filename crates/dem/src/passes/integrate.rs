//! Moves each particle by the sum of its loads: velocity Verlet with predicted velocities.
//!
//! ```text
//! v_n     = v*_n + (a_n − a_{n−1}) Δt/2          a_n from forces at (x_n, v*_n)
//! x_{n+1} = x_n + v_n Δt + a_n Δt²/2
//! v*_{n+1} = v_n + a_n Δt                        predicted, so that forces see one instant
//! ```
//!
//! Velocity Verlet: Swope et al. (1982), J. Chem. Phys. 76; positions and velocities of one instant in the force:
//! Vyas, Ottino, Lueptow & Umbanhowar (2024), arXiv:2410.14798. Rotation in the same way, I = 2/5 m r².

use crate::kernel::sums::Sums;
use crate::simd::number::{Number, as_kept};
use crate::simd::scalar::Each;
use crate::simd::{Four, Row, Row4, Width};
use crate::state::sleepers::SleeperSlices;

/// Columns of some particles.
pub struct ParticleSlices<'a> {
    /// Number of the first.
    pub first: usize,
    pub rows: &'a mut [Row],
    pub spins: &'a mut [Row4],
    pub acceleration: &'a mut [Row4],
    pub turning: &'a mut [Row4],
    /// Where they were listed, and their rooms.
    pub home: &'a [Row4],
    /// Loads on them.
    pub sums: Sums<'a>,
    /// Which particles sleep, where the scene asks for it.
    pub sleeper_slices: Option<SleeperSlices<'a>>,
}

impl<'a> ParticleSlices<'a> {
    /// The same, for a while.
    pub fn by_ref(&mut self) -> ParticleSlices<'_> {
        ParticleSlices {
            first: self.first,
            rows: self.rows,
            spins: self.spins,
            acceleration: self.acceleration,
            turning: self.turning,
            home: self.home,
            sums: self.sums.by_ref(),
            sleeper_slices: self.sleeper_slices.as_mut().map(SleeperSlices::by_ref),
        }
    }

    /// The particles before number `to`, and the others.
    pub fn split(self, to: usize) -> (ParticleSlices<'a>, ParticleSlices<'a>) {
        let n = (to - self.first).min(self.rows.len());
        let turn = n.min(self.spins.len());
        let (rows, rows2) = self.rows.split_at_mut(n);
        let (spins, spins2) = self.spins.split_at_mut(turn);
        let (acceleration, acceleration2) = self.acceleration.split_at_mut(n);
        let (turning, turning2) = self.turning.split_at_mut(turn);
        let (home, home2) = self.home.split_at(n);
        let first = self.first;
        let (sums, sums2) = self.sums.split(n);
        let (sleeper_slices, beds2) = self.sleeper_slices.map(|b| b.split(n)).unzip();
        let one = ParticleSlices { first, rows, spins, acceleration, turning, home, sums, sleeper_slices };
        let two = ParticleSlices {
            first: first + n,
            rows: rows2,
            spins: spins2,
            acceleration: acceleration2,
            turning: turning2,
            home: home2,
            sums: sums2,
            sleeper_slices: beds2,
        };
        (one, two)
    }
}

/// What one move found.
#[derive(Clone, Copy, Default)]
pub struct MoveFlags {
    /// Whether a particle has left the room that its neighbours were listed for.
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
    pub gravity: [f64; 3],
    pub motion_limit: f64,
}

/// Moves particles by one step, computing with lanes of `width`; all widths give the same bits.
pub fn advance(width: Width, columns: ParticleSlices, drive: &MoveInputs) -> MoveFlags {
    as_kept!(columns.sums.form, T, ROTATES => dispatch::<T, ROTATES>(width, columns, drive))
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
    let ParticleSlices { rows, spins, acceleration, turning, home, sums, .. } = columns;
    let loads = sums.seen();
    let [gx, gy, gz] = drive.gravity;
    let gravity = Q::read(&[gx, gy, gz, 0.0]);
    // Rows hold radius and 1/m in the fourth place, which must not move.
    let three = Q::read(&[1.0, 1.0, 1.0, 0.0]);
    let (dt, half, square) = (Q::all(drive.dt), Q::all(0.5 * drive.dt), Q::all(0.5 * drive.dt * drive.dt));
    let mut moved = MoveFlags::default();
    for k in 0..rows.len() {
        let ([place, velocity], []) = rows[k].as_chunks_mut::<4>() else { continue };
        let (radius, inverse_mass) = (place[3], velocity[3]);
        let sum = loads.sum::<T, Q, SPIN>(k, radius);
        let new = (sum.force * Q::all(inverse_mass) + gravity) * three;
        let v = Q::read(velocity) + half * (new - Q::read(&acceleration[k]));
        let moves = (dt * v + square * new) * three;
        let there = Q::read(place) + moves;
        there.write(place);
        (v + dt * new).write(velocity);
        new.write(&mut acceleration[k]);
        let limit = drive.motion_limit * radius;
        // Written so that NaN is caught.
        moved.too_fast |= !(length2(moves) <= limit * limit);
        let margin = home[k][3];
        moved.left_margin |= length2(there - Q::read(&home[k])) > margin * margin;
        if SPIN {
            let new = sum.moment * Q::all(2.5 * inverse_mass / (radius * radius)) * three;
            let w = Q::read(&spins[k]) + half * (new - Q::read(&turning[k]));
            (w + dt * new).write(&mut spins[k]);
            new.write(&mut turning[k]);
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
