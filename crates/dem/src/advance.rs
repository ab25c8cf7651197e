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
use crate::lane::{Row, Row4};
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

/// Force [N] and moment [N·m].
#[derive(Clone, Copy, Default)]
pub struct Sum {
    pub force: [f64; 3],
    pub moment: [f64; 3],
}

impl Loads<'_> {
    /// Sum over the contacts of particle `k`, in the order of its entries.
    #[inline(always)]
    pub fn sum<const SPIN: bool>(&self, k: usize) -> Sum {
        let mut sum = Sum::default();
        for &entry in &self.entries[self.starts[k] as usize..self.starts[k + 1] as usize] {
            let (contact, second) = ((entry >> 1) as usize, entry & 1);
            let sign = if second == 0 { 1.0 } else { -1.0 };
            let stride = if SPIN { FORCE_AND_MOMENT } else { FORCE };
            let row = &self.loads[contact * stride..(contact + 1) * stride];
            for a in 0..3 {
                sum.force[a] += sign * row[a];
            }
            if SPIN {
                let arm = row[6 + second as usize];
                for a in 0..3 {
                    sum.moment[a] -= arm * row[3 + a];
                }
                if !self.couples.is_empty() {
                    for a in 0..3 {
                        sum.moment[a] += sign * self.couples[4 * contact + a];
                    }
                }
            }
        }
        sum
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

/// Moves all particles by one step.
pub fn advance(columns: Columns, loads: Loads, drive: Drive) -> Moved {
    let spin = !columns.spins.is_empty();
    let tasks = split(columns);
    let run = |task: Columns| {
        if spin { chunk::<true>(task, loads, drive) } else { chunk::<false>(task, loads, drive) }
    };
    let join = |a: Moved, b: Moved| Moved { away: a.away.max(b.away), wild: a.wild | b.wild };
    if tasks.len() < FEW_TASKS {
        return tasks.into_iter().map(run).fold(Moved::default(), join);
    }
    tasks.into_par_iter().map(run).reduce(Moved::default, join)
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

fn chunk<const SPIN: bool>(columns: Columns, loads: Loads, drive: Drive) -> Moved {
    let Columns { first, rows, acceleration, spins, turning, home } = columns;
    let (dt, half, square) = (drive.dt, 0.5 * drive.dt, 0.5 * drive.dt * drive.dt);
    let mut moved = Moved::default();
    for k in 0..rows.len() {
        let sum = loads.sum::<SPIN>(first + k);
        let (row, old) = (&mut rows[k], &mut acceleration[k]);
        let (mut step, mut away) = (0.0, 0.0);
        for a in 0..3 {
            let new = sum.force[a] * row[7] + drive.gravity[a];
            let v = row[4 + a] + half * (new - old[a]);
            let moves = dt * v + square * new;
            row[a] += moves;
            row[4 + a] = v + dt * new;
            old[a] = new;
            step += moves * moves;
            away += (row[a] - home[k][a]) * (row[a] - home[k][a]);
        }
        let limit = drive.motion_limit * row[3];
        // Written so that NaN is caught.
        moved.wild |= !(step <= limit * limit);
        moved.away = moved.away.max(away);
        if SPIN {
            let inverse_inertia = 2.5 * row[7] / (row[3] * row[3]);
            for a in 0..3 {
                let new = sum.moment[a] * inverse_inertia;
                let w = spins[k][a] + half * (new - turning[k][a]);
                spins[k][a] = w + dt * new;
                turning[k][a] = new;
            }
        }
    }
    moved
}
