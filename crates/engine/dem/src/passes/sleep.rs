//! Sleep: particles at rest are held where they are, and nothing of them is computed, until they are disturbed.
//!
//! A particle falls asleep when, for a time, |v| + r|ω| has been below a speed and its residual acceleration |F/m + g| and r|M|/I below a
//! share of g. Its velocity is then zero, and the force on it is kept. It wakes when the force on it differs from that
//! by more than the share of its weight, or the moment by the share of weight × radius. What touches a wall or a particle that moves
//! neither falls asleep nor sleeps on ([`crate::passes::waking`]). Loads between two sleepers, or of a sleeper on a
//! wall at rest, are those of the step in which they fell asleep: whole blocks of them are passed over,
//! and their sum is kept for each tile ([`RestingTile`]) until a particle in or beside it falls asleep or wakes.
//!
//! Sleeping changes results: by what a bed would still have crept, and by disturbances too weak to wake it.

use crate::model::Model;
use crate::neighbours::RestingTile;
use crate::passes::integrate::{ParticleSlices, advance};
use crate::passes::waking::Stirred;
use crate::state::SleeperSlices;
use geom::Vec3;
use geom::sphere::INERTIA;
use laws::contact::{MoveFlags, MoveInputs};
use laws::simd::Row;
use laws::space::sphere::inverse_inertia;
use std::ops::Range;

/// Moves the particles of a tile that are awake, and checks the sleepers: all of them where `still` has just been found, later only those
/// that may be disturbed.
pub fn advance_awake(
    model: &Model,
    mut columns: ParticleSlices,
    still: Option<&RestingTile>,
    stirred: Option<Stirred>,
) -> MoveFlags {
    let (mut moved, width) = (MoveFlags::default(), model.width);
    let drive = &model.move_inputs();
    let (Some(mut sleeper_slices), Some(stirred)) = (columns.sleeper_slices.take(), stirred) else {
        return advance(width, columns, drive);
    };
    let first = columns.first;
    let sleeps = &sleeper_slices.asleep[first..first + columns.rows.len()];
    let mut wake = |run: Range<usize>, columns: &mut ParticleSlices, sleeper_slices: &mut SleeperSlices| {
        moved = moved.and(advance(width, columns.range(run.clone()), drive));
        run.for_each(|k| sleeper_slices.check_sleep(k, columns, drive, stirred));
    };
    if let Some(still) = still.filter(|s| s.unchanged) {
        still.awake.iter().for_each(|run| wake(run.clone(), &mut columns, &mut sleeper_slices));
        let disturbed = still.disturbed.iter().map(|&k| k as usize);
        disturbed.for_each(|k| sleeper_slices.check_wake(k, &mut columns, drive, stirred));
        return moved;
    }
    for run in runs(sleeps) {
        if sleeps[run.start] {
            run.for_each(|k| sleeper_slices.keep_asleep(k, &mut columns, drive, stirred));
        } else {
            wake(run, &mut columns, &mut sleeper_slices);
        }
    }
    moved
}

impl SleeperSlices<'_> {
    /// Puts a particle that has just moved to sleep if it has been quiet for long enough.
    fn check_sleep(&mut self, k: usize, columns: &mut ParticleSlices, drive: &MoveInputs, stirred: Stirred) {
        let row = columns.rows[k];
        let spin = columns.spins.get(k).map_or(0.0, |w| w.vector().norm());
        let angular_acceleration = columns.angular_acceleration.get(k).map_or(0.0, |t| t.vector().norm());
        let a = columns.acceleration[k];
        let here = columns.first + k;
        let still = row.velocity().norm() + row.radius() * spin < self.speed
            && a.vector().norm() < self.wake
            && angular_acceleration * row.radius() < self.wake
            && self.prescribed.get(here) != Some(&true);
        self.quiet[k] = if still { self.quiet[k] + 1 } else { 0 };
        if self.quiet[k] >= self.steps && stirred.touches(here) {
            self.quiet[k] = 0;
        }
        self.next[k] = self.quiet[k] >= self.steps;
        if !self.next[k] {
            return;
        }
        let (force, moment) = columns.sums.as_ref().on(here, row.radius());
        let lost = lost(k, columns, drive);
        self.held[k] = Row([force[0], force[1], force[2], moment[0], moment[1], moment[2], lost, 0.0]);
        rest(k, columns);
    }

    /// Keeps a sleeper asleep unless it is disturbed.
    fn keep_asleep(&mut self, k: usize, columns: &mut ParticleSlices, drive: &MoveInputs, stirred: Stirred) {
        self.quiet[k] = self.steps.saturating_add(1);
        self.next[k] = true;
        if stirred.lists.disturbed(columns.first + k, self.asleep) {
            self.check_wake(k, columns, drive, stirred);
        }
    }

    /// Wakes a sleeper if the force or the moment on it has changed enough, or something that moves touches it.
    fn check_wake(&mut self, k: usize, columns: &mut ParticleSlices, drive: &MoveInputs, stirred: Stirred) {
        let here = columns.first + k;
        let row = columns.rows[k];
        let (force, moment) = columns.sums.as_ref().on(here, row.radius());
        let held = self.held[k];
        let push = (force - Vec3::new(held[0], held[1], held[2])).norm() * row.inverse_mass();
        let twist =
            (moment - Vec3::new(held[3], held[4], held[5])).norm() * row.inverse_mass() / row.radius();
        if push > self.wake || twist > self.wake || push.is_nan() || stirred.touches(here) {
            (self.quiet[k], self.next[k]) = (0, false);
            let inverse_inertia = inverse_inertia(row.radius(), row.inverse_mass());
            for a in 0..3 {
                columns.acceleration[k][a] = force[a] * row.inverse_mass() + drive.gravity[a];
                if let Some(angular_acceleration) = columns.angular_acceleration.get_mut(k) {
                    angular_acceleration[a] = moment[a] * inverse_inertia;
                }
            }
        }
    }
}

/// What a particle that has just moved loses when it rests there [J]: its kinetic energy half a step ago, and what contacts did
/// not add and its weight will not ([`crate::passes::ledger`] leaves its last step out).
fn lost(k: usize, columns: &ParticleSlices, drive: &MoveInputs) -> f64 {
    let (row, a, dt) = (columns.rows[k], columns.acceleration[k], drive.dt);
    let mut lost = 0.0;
    for axis in 0..3 {
        let (ahead, g) = (row[4 + axis], drive.gravity[axis]);
        let (now, middle) = (ahead - a[axis] * dt, ahead - 0.5 * a[axis] * dt);
        lost +=
            (0.5 * middle * middle + 0.5 * g * middle * dt - (a[axis] - g) * now * dt) / row.inverse_mass();
        if let (Some(w), Some(t)) = (columns.spins.get(k), columns.angular_acceleration.get(k)) {
            let inertia = INERTIA * row.radius() * row.radius() / row.inverse_mass();
            let (now, middle) = (w[axis] - t[axis] * dt, w[axis] - 0.5 * t[axis] * dt);
            lost += inertia * (0.5 * middle * middle - t[axis] * now * dt);
        }
    }
    lost
}

/// Sets velocity and spin of a particle to 0.
fn rest(k: usize, columns: &mut ParticleSlices) {
    columns.rows[k][4..7].fill(0.0);
    if let Some(spin) = columns.spins.get_mut(k) {
        spin[..3].fill(0.0);
    }
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
