//! Histories, carried over from the lists before: as [`crate::neighbours`] carries them.

use super::run;
use crate::tables::lists::DeviceWall;
use crate::tables::{DeviceBlock, DeviceKind, DeviceTables, SPHERES};
use laws::contact::SlotEnd;
use laws::simd::BLOCK;
use laws::space::images::{Image, Periods};

/// Gives the contact in a slot the history that it had.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn carry(t: &DeviceTables, _: u32, slot: usize) {
    let (l, old) = (&t.lists, &t.lists.old);
    if slot >= t.slot_count as usize {
        return;
    }
    // SAFETY: by contract; the history of this slot is this thread's.
    unsafe {
        let i: u32 = *t.contacts.i.at(slot);
        let block: &DeviceBlock = &*t.contacts.blocks.at(slot / BLOCK);
        let kind: &DeviceKind = &*t.kinds.at(block.kind as usize);
        let columns = kind.columns as usize;
        if i >= t.particle_count || columns == 0 {
            return;
        }
        let was = *l.order.at::<u32>(i as usize);
        let partner: u32 = *t.contacts.partner.at(slot);
        let (is_wall, partner) = if kind.with >= SPHERES {
            (true, element_before(t, kind, was, partner))
        } else {
            (false, *l.order.at::<u32>(partner as usize))
        };
        for entry in run(old.starts, was as usize) {
            let end: SlotEnd = *old.entries.at(entry);
            let other: u32 =
                if end.is_second() { *old.i.at(end.slot()) } else { *old.partner.at(end.slot()) };
            if other != partner {
                continue;
            }
            let from: &DeviceBlock = &*old.blocks.at(end.slot() / BLOCK);
            let of: &DeviceKind = &*t.kinds.at(from.kind as usize);
            // A pair may have become a pair across a periodic face, or stopped being one.
            if if is_wall { from.kind != block.kind } else { of.with >= SPHERES } {
                continue;
            }
            let words = old.history.at::<f64>(from.history as usize + end.slot() % BLOCK);
            let holds = (0..columns).any(|c| *words.wrapping_add(c * BLOCK) != 0.0);
            if !holds {
                continue;
            }
            let to = t.contacts.history.at::<f64>(block.history as usize + slot % BLOCK);
            for c in 0..columns {
                let number = *words.wrapping_add(c * BLOCK);
                // Its particles may have been exchanged.
                let flips = end.is_second() && kind.flips >> c & 1 == 1;
                *to.wrapping_add(c * BLOCK) = if flips { -number } else { number };
            }
            return;
        }
    }
}

/// Part and image of a wall, as they were before a particle (by its old position) and the wall were moved by whole periods.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
unsafe fn element_before(t: &DeviceTables, kind: &DeviceKind, particle: u32, partner: u32) -> u32 {
    if t.lists.wraps_any == 0 {
        return partner;
    }
    // SAFETY: by contract.
    unsafe {
        let wall: &DeviceWall = &*t.lists.walls.at(kind.wall as usize);
        let wrap: Periods = *t.lists.wraps.at(particle as usize);
        let [x, y, z, _] = wall.back;
        let before = wall.around.before(Image(partner / wall.parts), wrap, [x, y, z]);
        before.0 * wall.parts + partner % wall.parts
    }
}
