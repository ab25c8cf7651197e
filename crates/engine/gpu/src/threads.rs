//! What one thread of a device does: a contact, or a particle ([`crate::moves`]).
//!
//! ```text
//! contact   reads both ends, computes the wrench, keeps it in its slot
//! particle  adds the wrenches of its contacts in the order in which the processor adds them, and moves
//! ```
//!
//! Both call what the processor calls, so that both give the same bits, in whatever order threads run. A step is one
//! launch of contacts for each composition of effects, and one of particles. Tables lie in the memory of the device.
#![expect(unsafe_code, reason = "threads share tables, of which each writes its own rows only")]

use crate::tables::{DeviceBlock, DeviceKind, DeviceTables, IMAGES, MESH, MOVED_SPHERES, PLANE, SPHERES};
use core::slice;
use laws::contact::contact_loop::{act, gather};
use laws::contact::patch::{ALONE, Bodies, PATCH, Patch};
use laws::contact::touch::{PatchLaw, Touch};
use laws::contact::wall_point::WallPose;
use laws::contact::{Batch, MoveInputs, StepInputs, Sums, WrenchBuffer, WrenchSlicesMut};
use laws::effects::Effect;
use laws::simd::{BLOCK, FORCE_AND_MOMENT, Row, Row4, TORQUE};
use primitives::Vec3;

/// Numbers of history that a composition keeps at most.
const COLUMNS: usize = 16;

/// The block of a slot and its kind of contact; none where step `step` of a launch is not made, or ends here as there is no such kind.
///
/// # Safety
/// Tables are in place and hold what they say.
#[inline(always)]
unsafe fn in_slot(t: &DeviceTables, step: u32, slot: usize) -> Option<(DeviceBlock, &DeviceKind)> {
    // SAFETY: by contract.
    unsafe {
        if slot >= t.slot_count as usize || t.is_over(step) {
            return None;
        }
        let block: DeviceBlock = *t.contacts.blocks.at(slot / BLOCK);
        if block.kind >= t.lists.kind_count {
            t.beyond(step);
            return None;
        }
        Some((block, &*t.kinds.at(block.kind as usize)))
    }
}

/// The contact in a slot, if its effects are `E`, number `composition` of the compositions; in step `step` of a launch.
///
/// # Safety
/// Tables are in place and hold what they say; no other thread has this slot, and none moves particles meanwhile.
#[inline(always)]
pub unsafe fn contact<E: Effect>(t: &DeviceTables, composition: u32, step: u32, slot: usize) {
    const { assert!(E::HISTORY <= COLUMNS) };
    // SAFETY: by contract; this thread alone writes to the rows of its slot.
    unsafe {
        let Some((block, kind)) = in_slot(t, step, slot) else { return };
        let i: u32 = *t.contacts.i.at(slot);
        if kind.composition != composition || i >= t.particle_count {
            return;
        }
        let lane = slot % BLOCK;
        // 64 bits: no sum wraps.
        if u64::from(block.history) + (E::HISTORY * BLOCK) as u64 > u64::from(t.history_count) {
            return t.beyond(step);
        }
        let layout = t.layout();
        let rows: &[Row] = t.table(t.particles.rows, t.particle_count + 2);
        let spins: &[Row4] =
            t.table(t.particles.spins, if layout.rotates { t.particle_count + 2 } else { 0 });
        let mut patch = [1.0; PATCH * BLOCK];
        if kind.patch > 0 {
            let numbers = share::<true>(t, step, kind, (block.kind, i), slot);
            numbers.iter().enumerate().for_each(|(c, number)| patch[c * BLOCK] = *number);
        }
        let (other, number) = (*t.contacts.partner.at(slot), block.point as usize + lane);
        let Some((row, spin)) = partner(t, step, kind, &rows[i as usize], other, number) else {
            return t.beyond(step);
        };
        let MoveInputs { dt, ahead, .. } = t.drive;
        let inputs = StepInputs { dt, ahead, overlap_limit: t.overlap_limit, rows, spins, layout };
        let (mut history, mut active) = ([0.0; COLUMNS * BLOCK], [false]);
        let (mut forces, mut torques) = ([0.0; FORCE_AND_MOMENT], [0.0; TORQUE]);
        let torques_of = if E::TORQUES { &mut torques[..] } else { &mut [] };
        let mut batch = Batch {
            partners: (slice::from_ref(&row), slice::from_ref(&spin)),
            i: slice::from_ref(&i),
            j: &[0],
            history: &mut [],
            active: &mut active,
            sums: Sums::default(),
            both: false,
            kept: WrenchSlicesMut::default(),
            patch: if kind.patch > 0 { &patch } else { &[] },
            each: WrenchSlicesMut { forces: &mut forces, torques: torques_of },
            ledger: &mut [],
        };
        let acted = &mut *t.acts.at::<u8>(slot);
        let ends = gather::<f64, E>(&inputs, &batch, 0);
        if *acted == 0 && !ends.may_act(&inputs) {
            return;
        }
        let words = t.contacts.history.at::<f64>(block.history as usize + lane);
        for c in 0..E::HISTORY {
            history[c * BLOCK] = *words.wrapping_add(c * BLOCK);
        }
        batch.history = &mut history[..E::HISTORY * BLOCK];
        let mut numbers: &[f64] = t.table(t.numbers, kind.numbers + E::COUNT as u32);
        numbers = &numbers[kind.numbers as usize..];
        let effect = E::take(&mut numbers);
        let mut buffer = WrenchBuffer::<f64>::new();
        let (acts, deep) = act::<f64, E, f64, false>(&effect, &inputs, &mut batch, &mut buffer, (0, 0), ends);
        for c in 0..E::HISTORY {
            *words.wrapping_add(c * BLOCK) = history[c * BLOCK];
        }
        *acted = u8::from(acts);
        if acts {
            if layout.rotates {
                *t.forces.at(slot) = Row(forces);
            } else {
                let [x, y, z, pad, ..] = forces;
                *t.forces.at(slot) = Row4([x, y, z, pad]);
            }
            if t.torques != 0 {
                *t.moments.at(slot) = Row4(torques);
            }
        }
        if deep {
            t.flag(3, 1);
            t.flag(0, step + 1);
        }
    }
}

/// Notes whether the contact in a slot has been made, for those of its patch: their threads may run after its history has changed. In step `step` of a launch.
///
/// # Safety
/// Tables are in place and hold what they say; no other thread has this slot, and none computes contacts meanwhile.
#[inline(always)]
pub unsafe fn made(t: &DeviceTables, step: u32, slot: usize) {
    // SAFETY: by contract.
    unsafe {
        let Some((block, kind)) = in_slot(t, step, slot) else { return };
        if kind.gap == 0.0 {
            return;
        }
        let word = block.history as usize + slot % BLOCK;
        if word >= t.history_count as usize {
            return t.beyond(step);
        }
        // The history of a law that adheres begins with what says that contact was made.
        *t.made.at(slot) = u8::from(*t.contacts.history.at::<f64>(word) > 0.0);
    }
}

/// What part the contact in a slot, of particle `i` and a kind of this number, has in its patch of wall spheres. Not inlined, so that one copy serves all compositions; generic, or that copy would stay in the library.
///
/// # Safety
/// Tables are in place.
#[inline(never)]
unsafe fn share<const COPY: bool>(
    t: &DeviceTables,
    step: u32,
    kind: &DeviceKind,
    (number, i): (u32, u32),
    slot: usize,
) -> [f64; PATCH] {
    // SAFETY: by contract.
    unsafe {
        let block = |slot: usize| *t.contacts.blocks.at::<DeviceBlock>(slot / BLOCK);
        let same = |slot: usize| *t.contacts.i.at::<u32>(slot) == i && block(slot).kind == number;
        let (mut from, mut to) = (slot, slot + 1);
        while from > 0 && same(from - 1) {
            from -= 1;
        }
        while to < t.slot_count as usize && same(to) {
            to += 1;
        }
        let row: Row = *t.particles.rows.at(i as usize);
        let law = PatchLaw { shared: true, hertz: kind.patch > 1, gap: kind.gap };
        let touch = |k: usize| {
            let at = from + k;
            let point = block(at).point as usize + at % BLOCK;
            let other = partner(t, step, kind, &row, *t.contacts.partner.at(at), point);
            // The contact itself says that it is beyond.
            let other = other.map_or(row, |(other, _)| other);
            let held = law.gap > 0.0 && *t.made.at::<u8>(at) != 0;
            Touch::of(law, [t.drive.dt, t.drive.ahead], &row, &other, law.held(&row, &other, held))
        };
        let Some(patch) = Patch::of(law, to - from, touch) else { return ALONE };
        let bodies = Bodies { inverse_mass: row.inverse_mass(), direction: Vec3::zeros(), wall: 0.0 };
        let push = patch.push(&bodies, |k| patch.shares(k)[0]);
        patch.numbers(slot - from, &push, &bodies, patch.shares(slot - from))
    }
}

/// Row and spin of the partner of a particle in `row`; `number`: of its point, where it is no particle. None where a table has no such row.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
unsafe fn partner(
    t: &DeviceTables,
    step: u32,
    kind: &DeviceKind,
    row: &Row,
    other: u32,
    number: usize,
) -> Option<(Row, Row4)> {
    let has_point = number < t.point_count as usize;
    // SAFETY: by contract, and the numbers of rows are below those of their tables.
    unsafe {
        if kind.with == SPHERES {
            return has_point.then(|| (*t.points.at(number), Row4::default()));
        }
        if kind.with >= MOVED_SPHERES {
            if !has_point || kind.wall >= t.walls {
                return None;
            }
            let wall: &WallPose = &*t.poses.at((step * t.walls + kind.wall) as usize);
            let [x, y, z, radius, by_x, by_y, by_z, _] = **t.points.at::<Row>(number);
            let (home, shift) = (Vec3::new(x, y, z), Vec3::new(by_x, by_y, by_z));
            let centre = row.position();
            let position = match kind.with {
                PLANE => wall.on_plane(kind.plane.map(Vec3::from), centre - shift),
                // Found before.
                MESH => home,
                _ => wall.pose.position(&home),
            };
            return Some(wall.row(position, radius, shift, centre));
        }
        if other >= t.particle_count || kind.with == IMAGES && !has_point {
            return None;
        }
        let mut row: Row = *t.particles.rows.at(other as usize);
        if kind.with == IMAGES {
            let shift: &Row = &*t.points.at(number);
            for a in 0..3 {
                row[a] += shift[4 + a];
            }
        }
        Some((row, if t.rotates != 0 { *t.particles.spins.at(other as usize) } else { Row4::default() }))
    }
}
