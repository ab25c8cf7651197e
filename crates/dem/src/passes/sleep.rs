//! Sleep: particles at rest are held where they are, and nothing of them is computed, until they are disturbed.
//!
//! A particle falls asleep when, for a time, |v| + r|ω| has been below a speed and its residual acceleration |F/m + g| and r|M|/I below a
//! share of g. Its velocity is then zero, and the force on it is kept. It wakes when the force on it differs from that
//! by more than the share of its weight, or the moment by the share of weight × radius. Loads between two sleepers, or of a sleeper on a
//! wall at rest, are those of the step in which they fell asleep: whole blocks of them are passed over,
//! and their sum is kept for each tile ([`RestingTile`]) until a particle in or beside it falls asleep or wakes.
//!
//! Sleeping changes results: by what a bed would still have crept, and by disturbances too weak to wake it.

use crate::neighbours::resting::RestingTile;
use crate::neighbours::slices::Lists;
use crate::passes::integrate::{MoveFlags, MoveInputs, ParticleSlices, advance};
use crate::simd::{Row, Width};
use crate::state::sleepers::SleeperSlices;
use std::ops::Range;

/// Moves those of a tile that are awake, and looks after the others: all of them, where what is `still` has just been found.
pub fn advance_awake(
    width: Width,
    mut columns: ParticleSlices,
    drive: &MoveInputs,
    lists: &Lists,
    still: Option<&RestingTile>,
) -> MoveFlags {
    let mut moved = MoveFlags::default();
    let Some(mut sleeper_slices) = columns.sleeper_slices.take() else {
        return advance(width, columns, drive);
    };
    let first = columns.first;
    let sleeps = &sleeper_slices.asleep[first..first + columns.rows.len()];
    let mut wake = |run: Range<usize>, columns: &mut ParticleSlices, sleeper_slices: &mut SleeperSlices| {
        let (_, rest) = columns.by_ref().split(first + run.start);
        let (awake, _) = rest.split(first + run.end);
        moved = moved.and(advance(width, awake, drive));
        run.for_each(|k| sleeper_slices.check_sleep(k, columns, drive));
    };
    if let Some(still) = still.filter(|s| s.unchanged()) {
        still.awake.iter().for_each(|run| wake(run.clone(), &mut columns, &mut sleeper_slices));
        still.disturbed.iter().for_each(|&k| sleeper_slices.check_wake(k as usize, &mut columns, drive));
        return moved;
    }
    for run in runs(sleeps) {
        if sleeps[run.start] {
            run.for_each(|k| sleeper_slices.keep_asleep(k, &mut columns, drive, lists));
        } else {
            wake(run, &mut columns, &mut sleeper_slices);
        }
    }
    moved
}

impl SleeperSlices<'_> {
    /// A particle that has just moved: whether it falls asleep.
    fn check_sleep(&mut self, k: usize, columns: &mut ParticleSlices, drive: &MoveInputs) {
        let row = columns.rows[k];
        let spin = columns.spins.get(k).map_or(0.0, |w| length([w[0], w[1], w[2]]));
        let turning = columns.turning.get(k).map_or(0.0, |t| length([t[0], t[1], t[2]]));
        let a = columns.acceleration[k];
        let here = columns.first + k;
        let still = length([row[4], row[5], row[6]]) + row[3] * spin < self.speed
            && length([a[0], a[1], a[2]]) < self.wake
            && turning * row[3] < self.wake
            && self.busy.get(here) != Some(&true);
        self.quiet[k] = if still { self.quiet[k] + 1 } else { 0 };
        self.next[k] = self.quiet[k] >= self.steps;
        if !self.next[k] {
            return;
        }
        let (force, moment) = columns.sums.seen().on(here, row[3]);
        let lost = lost(k, columns, drive);
        self.held[k] = Row([force[0], force[1], force[2], moment[0], moment[1], moment[2], lost, 0.0]);
        rest(k, columns);
    }

    /// A sleeper: whether it wakes.
    fn keep_asleep(&mut self, k: usize, columns: &mut ParticleSlices, drive: &MoveInputs, lists: &Lists) {
        self.quiet[k] = self.steps.saturating_add(1);
        self.next[k] = true;
        if lists.disturbed(columns.first + k, self.asleep) {
            self.check_wake(k, columns, drive);
        }
    }

    /// A sleeper that something may have stirred: whether it wakes.
    fn check_wake(&mut self, k: usize, columns: &mut ParticleSlices, drive: &MoveInputs) {
        let here = columns.first + k;
        let row = columns.rows[k];
        let (force, moment) = columns.sums.seen().on(here, row[3]);
        let held = self.held[k];
        let push = length([force[0] - held[0], force[1] - held[1], force[2] - held[2]]) * row[7];
        let twist = length([moment[0] - held[3], moment[1] - held[4], moment[2] - held[5]]) * row[7] / row[3];
        if push > self.wake || twist > self.wake || push.is_nan() {
            (self.quiet[k], self.next[k]) = (0, false);
            let inverse_inertia = 2.5 * row[7] / (row[3] * row[3]);
            for a in 0..3 {
                columns.acceleration[k][a] = force[a] * row[7] + drive.gravity[a];
                if let Some(turning) = columns.turning.get_mut(k) {
                    turning[a] = moment[a] * inverse_inertia;
                }
            }
        }
    }
}

/// What a particle that has just moved loses when it rests there [J]: its kinetic energy half a step ago, and what contacts did
/// not add and its weight will not ([`crate::account`] leaves its last step out).
fn lost(k: usize, columns: &ParticleSlices, drive: &MoveInputs) -> f64 {
    let (row, a, dt) = (columns.rows[k], columns.acceleration[k], drive.dt);
    let mut lost = 0.0;
    for axis in 0..3 {
        let (ahead, g) = (row[4 + axis], drive.gravity[axis]);
        let (now, middle) = (ahead - a[axis] * dt, ahead - 0.5 * a[axis] * dt);
        lost += (0.5 * middle * middle + 0.5 * g * middle * dt - (a[axis] - g) * now * dt) / row[7];
        if let (Some(w), Some(t)) = (columns.spins.get(k), columns.turning.get(k)) {
            let inertia = 0.4 * row[3] * row[3] / row[7];
            let (now, middle) = (w[axis] - t[axis] * dt, w[axis] - 0.5 * t[axis] * dt);
            lost += inertia * (0.5 * middle * middle - t[axis] * now * dt);
        }
    }
    lost
}

/// Takes the velocity that a particle would have next.
fn rest(k: usize, columns: &mut ParticleSlices) {
    columns.rows[k][4..7].fill(0.0);
    if let Some(spin) = columns.spins.get_mut(k) {
        spin[..3].fill(0.0);
    }
}

fn length(v: [f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

/// Runs of equal flags.
pub fn runs(flags: &[bool]) -> impl Iterator<Item = Range<usize>> + '_ {
    let mut from = 0;
    std::iter::from_fn(move || {
        let first = *flags.get(from)?;
        let to = from + flags[from..].iter().take_while(|&&f| f == first).count();
        let run = from..to;
        from = to;
        Some(run)
    })
}
