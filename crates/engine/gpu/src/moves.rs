//! What the thread of a particle does: it sums the wrenches of its contacts, and moves.
#![expect(unsafe_code, reason = "threads share tables, of which each writes its own rows only")]

use crate::tables::{DeviceTables, DeviceZoneRow, HOLD, WATCHED};
use laws::contact::sums::{Sum, WrenchSums, add, add_opposite};
use laws::contact::{MoveInputs, Mover, SlotEnd, WrenchSlices};
use laws::float::Float;
use laws::simd::{Each, FORCE_AND_MOMENT, Row, Row4, TORQUE};
use laws::slowing::{Moved, Turned, has_left, slowed_at};
use laws::space::sphere::inverse_inertia;
use primitives::Vec3;

/// Sums of the wrenches on a particle.
struct Summed {
    forces: [f64; FORCE_AND_MOMENT],
    torques: [f64; TORQUE],
}

impl Summed {
    /// Those of a particle in the order in which the processor adds them; none where a table has no such row.
    ///
    /// # Safety
    /// Tables are in place and hold what they say, and none computes contacts meanwhile.
    #[inline(always)]
    unsafe fn of<const ROTATES: bool>(t: &DeviceTables, step: u32, k: usize) -> Option<Summed> {
        // SAFETY: by contract.
        unsafe {
            let (from, to): (u32, u32) = (*t.contacts.starts.at(k), *t.contacts.starts.at(k + 1));
            let (mut forces, mut torques) = ([0.0; FORCE_AND_MOMENT], [0.0; TORQUE]);
            // Those of its own tile first, then those that arrive from elsewhere, as in `Sums`.
            let own: u32 = *t.tiles.at(k / t.tile as usize);
            let mut arrivals = 0;
            while from + arrivals < to
                && (*t.contacts.entries.at::<SlotEnd>((from + arrivals) as usize)).slot() < own as usize
            {
                arrivals += 1;
            }
            for entry in (from + arrivals..to).chain(from..from + arrivals) {
                let end: SlotEnd = *t.contacts.entries.at(entry as usize);
                let slot = end.slot();
                if slot >= t.slot_count as usize {
                    t.beyond(step);
                    return None;
                }
                if *t.acts.at::<u8>(slot) == 0 {
                    continue;
                }
                // Copied whole: a device reads rows in wide words.
                if ROTATES {
                    let row: Row = *t.forces.at(slot);
                    accumulate(&mut forces, &row, end);
                } else {
                    let row: Row4 = *t.forces.at(slot);
                    accumulate(&mut forces, &row, end);
                }
                if t.torques != 0 {
                    let row: Row4 = *t.moments.at(slot);
                    accumulate(&mut torques, &row, end);
                }
            }
            Some(Summed { forces, torques })
        }
    }

    /// As the processor keeps them.
    #[inline(always)]
    fn sums(&self, t: &DeviceTables) -> WrenchSums<'_> {
        let torques = if t.torques != 0 { &self.torques[..] } else { &[] };
        let sums = WrenchSlices { forces: &self.forces, torques };
        WrenchSums { first: 0, layout: t.layout(), sums }
    }
}

/// The step of a launch that a thread is given, and whether its move waits where an overlap is too deep.
#[inline(always)]
fn step_of(given: u32) -> (u32, bool) {
    (given & !HOLD, given & HOLD != 0)
}

/// Sums the wrenches on a particle, and moves it; a fluid and local damping slow it where `SLOWED`. In step `given` of a launch, or that with [`HOLD`].
///
/// # Safety
/// Tables are in place and hold what they say; no other thread has this particle, and none computes contacts meanwhile.
#[inline(always)]
pub unsafe fn particle<const ROTATES: bool, const SLOWED: bool>(t: &DeviceTables, given: u32, k: usize) {
    // SAFETY: by contract; this thread alone writes to the rows of its particle.
    unsafe {
        let (step, holds) = step_of(given);
        if k >= t.particle_count as usize || t.is_over(step) || holds && t.is_too_deep(step) {
            return;
        }
        let Some(summed) = Summed::of::<ROTATES>(t, step, k) else { return };
        let row: &mut Row = &mut *t.particles.rows.at(k);
        let sum: Sum<Each> = summed.sums(t).sum::<f64, Each, ROTATES>(0, row.radius());
        let mover = Mover::<Each>::new(&t.drive);
        let (acceleration, home): (&mut Row4, &Row4) =
            (&mut *t.particles.acceleration.at(k), &*t.particles.home.at(k));
        let was = *row;
        let mut found = mover.advance(row, acceleration, home, &sum);
        let mut turned = None;
        if ROTATES {
            let (spin, acceleration): (&mut Row4, &mut Row4) =
                (&mut *t.particles.spins.at(k), &mut *t.particles.angular_acceleration.at(k));
            let was = *spin;
            mover.turn(row, spin, acceleration, &sum);
            turned = Some((spin, acceleration, was));
        }
        if SLOWED && is_free(t, step, k) {
            let MoveInputs { dt, ahead, gravity, .. } = t.drive;
            let mut moved = Moved { row, acceleration, was: &was };
            if t.has_fluid != 0 {
                moved.drag(&t.fluid, &gravity.into(), dt);
                found.left_margin |= has_left(moved.row, home, ahead);
            }
            if t.damping > 0.0 {
                let turned =
                    turned.as_mut().map(|(spin, acceleration, was)| Turned { spin, acceleration, was });
                moved.damp(t.damping, &Vec3::zeros(), turned, dt);
                found.left_margin |= has_left(moved.row, home, ahead);
            }
        }
        for (place, found) in [(1, found.left_margin), (2, found.too_fast)] {
            if found {
                t.flag(place, 1);
                t.flag(0, step + 1);
            }
        }
    }
}

/// Whether a particle moves freely in step `step` of a launch: what is in a zone meets no fluid.
///
/// # Safety
/// Tables are in place, and there is such a particle.
#[inline(always)]
unsafe fn is_free(t: &DeviceTables, step: u32, k: usize) -> bool {
    // SAFETY: by contract.
    unsafe {
        if t.zones.count == 0 {
            return true;
        }
        let place: u32 = *t.particles.place.at(k);
        place < t.particle_count && *t.zones.free_from.at::<u32>(place as usize) <= step
    }
}

/// Gives a particle that begins to move the acceleration of this instant as that of the step before, which velocity Verlet needs: entry `n` of those in zones, in step `given` of a launch, with [`HOLD`].
///
/// # Safety
/// As [`particle`] says.
#[inline(always)]
pub unsafe fn started(t: &DeviceTables, given: u32, n: usize) {
    // SAFETY: by contract; no two entries that start have one particle.
    unsafe {
        let (step, _) = step_of(given);
        let starts = n < t.zones.count as usize && *t.zones.starts.at::<u32>(n) == step;
        if !starts || t.is_over(step) || t.is_too_deep(step) {
            return;
        }
        let Some(k) = zone_particle(t, step, n) else { return };
        let summed =
            if t.rotates != 0 { Summed::of::<true>(t, step, k) } else { Summed::of::<false>(t, step, k) };
        let Some(summed) = summed else { return };
        let row: &Row = &*t.particles.rows.at(k);
        let (force, moment) = summed.sums(t).on(0, row.radius());
        let gravity = Vec3::from(t.drive.gravity);
        let body = if t.has_fluid != 0 { gravity + t.fluid.acceleration(row, &gravity) } else { gravity };
        let slowed = |all: Vec3, velocity: Vec3| {
            if t.damping > 0.0 { slowed_at(t.damping, all, &velocity) } else { all }
        };
        let driven = slowed(force * row.inverse_mass() + body, row.velocity());
        *t.particles.acceleration.at(k) = Row4::of(driven);
        if t.rotates != 0 {
            let spin: &Row4 = &*t.particles.spins.at(k);
            let turned = slowed(moment * inverse_inertia(row.radius(), row.inverse_mass()), spin.vector());
            *t.particles.angular_acceleration.at(k) = Row4::of(turned);
        }
    }
}

/// The particle of entry `n` of those in zones; none where there is no such row.
///
/// # Safety
/// Tables are in place, and there is such an entry.
#[inline(always)]
unsafe fn zone_particle(t: &DeviceTables, step: u32, n: usize) -> Option<usize> {
    // SAFETY: by contract.
    unsafe {
        let at: u32 = *t.zones.at.at(n);
        let k = if at < t.particle_count { *t.zones.rows_now.at::<u32>(at as usize) } else { u32::MAX };
        if k >= t.particle_count {
            t.beyond(step);
            return None;
        }
        Some(k as usize)
    }
}

/// Whether any contact of a particle acts.
///
/// # Safety
/// Tables are in place and hold what they say, and none computes contacts meanwhile.
#[inline(always)]
unsafe fn touches(t: &DeviceTables, step: u32, k: usize) -> bool {
    // SAFETY: by contract.
    unsafe {
        let (from, to): (u32, u32) = (*t.contacts.starts.at(k), *t.contacts.starts.at(k + 1));
        for entry in from..to {
            let slot = (*t.contacts.entries.at::<SlotEnd>(entry as usize)).slot();
            if slot >= t.slot_count as usize {
                t.beyond(step);
                return false;
            }
            if *t.acts.at::<u8>(slot) != 0 {
                return true;
            }
        }
        false
    }
}

/// Puts a particle in a zone where that has it, at the image that is nearest to where it was listed: entry `n` of them, in step `given` of a launch, or that with [`HOLD`].
///
/// # Safety
/// As [`particle`] says, and none moves particles meanwhile.
#[inline(always)]
pub unsafe fn carried(t: &DeviceTables, given: u32, n: usize) {
    // SAFETY: by contract; no two entries have one particle.
    unsafe {
        let (step, holds) = step_of(given);
        if n >= t.zones.count as usize || t.is_over(step) || holds && t.is_too_deep(step) {
            return;
        }
        let there: &DeviceZoneRow = &*t.zones.rows.at(step as usize * t.zones.count as usize + n);
        if there.acts == 0 {
            return;
        }
        let Some(k) = zone_particle(t, step, n) else { return };
        let (mut position, home): ([f64; 3], &Row4) = (there.position, &*t.particles.home.at(k));
        let [low, high] = t.lists.periodic;
        for axis in 0..3 {
            let period = high[axis] - low[axis];
            if period > 0.0 {
                position[axis] += period * ((home[axis] - position[axis]) / period).nearest();
            }
        }
        let row: &mut Row = &mut *t.particles.rows.at(k);
        (row[0], row[1], row[2]) = (position[0], position[1], position[2]);
        (row[4], row[5], row[6]) = (there.velocity[0], there.velocity[1], there.velocity[2]);
        *t.particles.acceleration.at(k) = Row4::of(there.acceleration.into());
        if t.rotates != 0 {
            *t.particles.spins.at(k) = Row4::of(there.spin.into());
            *t.particles.angular_acceleration.at(k) = Row4::default();
        }
        if (Vec3::from(position) - home.vector()).norm_squared().root() > home[3] {
            t.flag(1, 1);
            t.flag(0, step + 1);
        }
        if there.acts == WATCHED && touches(t, step, k) {
            t.flag(5, 1);
            t.flag(0, step + 1);
        }
    }
}

/// Adds a row of `N` numbers, as the first or the second particle of its contact takes it.
#[inline(always)]
fn accumulate<const N: usize>(sum: &mut [f64], row: &[f64; N], end: SlotEnd) {
    if end.is_second() { add_opposite::<f64, N>(sum, 0, row) } else { add::<f64, N>(sum, 0, row) }
}
