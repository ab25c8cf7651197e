//! Gathers each particle's loads in a fixed order and moves it: velocity Verlet with predicted velocities.
//!
//! ```text
//! v_n     = v*_n + (a_n − a_{n−1}) Δt/2          a_n from forces at (x_n, v*_n)
//! x_{n+1} = x_n + v_n Δt + a_n Δt²/2
//! v*_{n+1} = v_n + a_n Δt                        predicted, so that forces see one instant
//! ```
//!
//! Velocity Verlet: Swope et al. (1982), J. Chem. Phys. 76; positions and velocities of one instant in the force:
//! Vyas, Ottino, Lueptow & Umbanhowar (2024), arXiv:2410.14798. Rotation in the same way, I = 2/5 m r².

use crate::kernel::{FORCE, FORCE_AND_MOMENT};
use crate::lane::scalar::Each;
use crate::lane::{Four, Row, Row4, Width};
use rayon::prelude::*;

/// Tasks below which one thread is faster than several.
const FEW_TASKS: usize = 5;
/// Particles of one task; fixed, so that results do not depend on the number of threads.
const CHUNK: usize = 1024;

/// Loads of all contacts and who they belong to.
#[derive(Clone, Copy)]
pub struct Loads<'a> {
    /// Loads: [`FORCE_AND_MOMENT`] numbers a contact, or [`FORCE`] without rotation.
    pub loads: &'a [f64],
    /// Couples, four numbers a contact, or empty.
    pub couples: &'a [f64],
    /// First entry of each particle, and one more.
    pub starts: &'a [u32],
    /// Contact × 2, + 1 where the particle is j.
    pub entries: &'a [u32],
}

/// Force [N] and moment [N·m]; the fourth number of each means nothing.
#[derive(Clone, Copy)]
pub struct Sum<Q> {
    pub force: Q,
    pub moment: Q,
}

impl Loads<'_> {
    /// Sum over the contacts of particle `k`, in the order of its entries.
    #[inline(always)]
    pub fn sum<Q: Four, const SPIN: bool>(&self, k: usize) -> Sum<Q> {
        let mut sum = Sum { force: Q::all(0.0), moment: Q::all(0.0) };
        let quarters = self.loads.as_chunks::<4>().0;
        let couples = self.couples.as_chunks::<4>().0;
        let stride = if SPIN { FORCE_AND_MOMENT / 4 } else { FORCE / 4 };
        for &entry in &self.entries[self.starts[k] as usize..self.starts[k + 1] as usize] {
            let (contact, second) = ((entry >> 1) as usize, (entry & 1) as usize);
            let sign = Q::all([1.0, -1.0][second]);
            let row = &quarters[contact * stride..(contact + 1) * stride];
            sum.force = sum.force + sign * Q::read(&row[0]);
            if SPIN {
                // The arms stand behind force and moment: the arm of i, then of j.
                let arm = Q::all(row[second][3]);
                sum.moment = sum.moment - arm * Q::read(&row[1]);
                if !couples.is_empty() {
                    sum.moment = sum.moment + sign * Q::read(&couples[contact]);
                }
            }
        }
        sum
    }

    /// Force [N] and moment [N·m] on particle `k`.
    pub fn on(&self, k: usize, spin: bool) -> ([f64; 3], [f64; 3]) {
        let sum = if spin { self.sum::<Each, true>(k) } else { self.sum::<Each, false>(k) };
        let three = |q: Each| {
            let mut row = [0.0; 4];
            q.write(&mut row);
            [row[0], row[1], row[2]]
        };
        (three(sum.force), three(sum.moment))
    }
}

/// Columns of some particles.
pub struct Columns<'a> {
    pub first: usize,
    pub rows: &'a mut [Row],
    pub acceleration: &'a mut [Row4],
    pub spins: &'a mut [Row4],
    pub turning: &'a mut [Row4],
    pub home: &'a [Row4],
}

/// What one move found.
#[derive(Clone, Copy, Default)]
pub struct Moved {
    /// Largest square of the distance from home [m²].
    pub away: f64,
    /// Whether a particle moved more than its limit, or is not a number.
    pub wild: bool,
}

/// Step [s], acceleration of free fall [m/s²], largest motion in one step over the radius [–].
#[derive(Clone, Copy)]
pub struct Drive {
    pub dt: f64,
    pub gravity: [f64; 3],
    pub motion_limit: f64,
}

/// Moves all particles by one step, computing with lanes of `width`; all widths give the same bits.
pub fn advance(width: Width, columns: Columns, loads: Loads, drive: Drive) -> Moved {
    let spin = !columns.spins.is_empty();
    let tasks = split(columns);
    let run = |task: Columns| match spin {
        true => dispatch::<true>(width, task, loads, drive),
        false => dispatch::<false>(width, task, loads, drive),
    };
    let join = |a: Moved, b: Moved| Moved { away: a.away.max(b.away), wild: a.wild | b.wild };
    if tasks.len() < FEW_TASKS {
        return tasks.into_iter().map(run).fold(Moved::default(), join);
    }
    tasks.into_par_iter().map(run).reduce(Moved::default, join)
}

fn dispatch<const SPIN: bool>(width: Width, columns: Columns, loads: Loads, drive: Drive) -> Moved {
    match width {
        #[cfg(target_arch = "x86_64")]
        Width::Avx2 | Width::Avx512 => simd::avx2::<SPIN>(columns, loads, drive),
        _ => chunk::<Each, SPIN>(columns, loads, drive),
    }
}

#[cfg(target_arch = "x86_64")]
mod simd {
    //! The move, compiled for wider registers.
    #![allow(unsafe_code)]
    use super::*;
    use crate::lane::x86::X4;

    pub fn avx2<const SPIN: bool>(columns: Columns, loads: Loads, drive: Drive) -> Moved {
        #[target_feature(enable = "avx2")]
        fn inner<const SPIN: bool>(columns: Columns, loads: Loads, drive: Drive) -> Moved {
            chunk::<X4, SPIN>(columns, loads, drive)
        }
        // SAFETY: these widths are only made where the processor has AVX2.
        unsafe { inner::<SPIN>(columns, loads, drive) }
    }
}

fn split(columns: Columns) -> Vec<Columns> {
    let Columns { rows, acceleration, mut spins, mut turning, home, .. } = columns;
    let mut tasks = Vec::with_capacity(rows.len() / CHUNK + 1);
    let parts = rows.chunks_mut(CHUNK).zip(acceleration.chunks_mut(CHUNK)).zip(home.chunks(CHUNK));
    for (c, ((rows, acceleration), home)) in parts.enumerate() {
        let take = rows.len().min(spins.len());
        let (s, spins_rest) = spins.split_at_mut(take);
        let (t, turning_rest) = turning.split_at_mut(take);
        (spins, turning) = (spins_rest, turning_rest);
        tasks.push(Columns { first: c * CHUNK, rows, acceleration, spins: s, turning: t, home });
    }
    tasks
}

#[inline(always)]
fn chunk<Q: Four, const SPIN: bool>(columns: Columns, loads: Loads, drive: Drive) -> Moved {
    let Columns { first, rows, acceleration, spins, turning, home } = columns;
    let [gx, gy, gz] = drive.gravity;
    let gravity = Q::read(&[gx, gy, gz, 0.0]);
    // Rows hold radius and 1/m in the fourth place, which must not move.
    let three = Q::read(&[1.0, 1.0, 1.0, 0.0]);
    let (dt, half, square) = (Q::all(drive.dt), Q::all(0.5 * drive.dt), Q::all(0.5 * drive.dt * drive.dt));
    let mut moved = Moved::default();
    for k in 0..rows.len() {
        let sum = loads.sum::<Q, SPIN>(first + k);
        let ([place, velocity], []) = rows[k].as_chunks_mut::<4>() else { continue };
        let (radius, inverse_mass) = (place[3], velocity[3]);
        let new = (sum.force * Q::all(inverse_mass) + gravity) * three;
        let v = Q::read(velocity) + half * (new - Q::read(&acceleration[k]));
        let moves = (dt * v + square * new) * three;
        let there = Q::read(place) + moves;
        there.write(place);
        (v + dt * new).write(velocity);
        new.write(&mut acceleration[k]);
        let limit = drive.motion_limit * radius;
        // Written so that NaN is caught.
        moved.wild |= !(length2(moves) <= limit * limit);
        moved.away = moved.away.max(length2(there - Q::read(&home[k])));
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
