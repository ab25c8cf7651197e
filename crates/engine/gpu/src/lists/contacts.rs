//! Contacts in their slots: blocks, order, those of each particle, and points of walls.

use super::sort::sort;
use super::{WRITE, add, run};
use crate::tables::lists::{DeviceSegment, DeviceWall};
use crate::tables::{DeviceBlock, DeviceKind, DeviceTables, IMAGES, MESH, PARTICLES, PLANE, SPHERES};
use laws::contact::SlotEnd;
use laws::contact::wall_point::WallPose;
use laws::simd::{BLOCK, Row, Row4};
use laws::space::images::Image;
use laws::space::sphere::FAR;
use primitives::Vec3;

/// Where a whole class begins among all that were counted; the number of all after the last.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn class_starts(t: &DeviceTables, _: u32, class: usize) {
    let l = &t.lists;
    let (images, count, tile) = (l.image_classes as usize, t.particle_count as usize, t.tile as usize);
    if class > l.class_of(l.tile_count as usize, 0) {
        return;
    }
    let row = if class < images { class * count } else { images * count + (class - images) * tile };
    // SAFETY: by contract.
    unsafe { *l.class_starts.at::<u32>(class) = *l.class_cursors.at(1 + row) }
}

/// Empties a slot: it has no contact.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn clear_slots(t: &DeviceTables, _: u32, slot: usize) {
    if slot >= t.slot_count as usize {
        return;
    }
    // SAFETY: by contract.
    unsafe {
        *t.contacts.i.at(slot) = t.particle_count;
        *t.contacts.partner.at(slot) = t.particle_count + 1;
        // All may have a history that has to be cleared.
        *t.acts.at(slot) = 1_u8;
    }
}

/// What a block is, by its segment.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn blocks(t: &DeviceTables, _: u32, block: usize) {
    let l = &t.lists;
    if block >= t.slot_count as usize / BLOCK {
        return;
    }
    // SAFETY: by contract; the first segment begins with the first block.
    unsafe {
        let segment = |k: usize| &*l.segments.at::<DeviceSegment>(k);
        let (mut low, mut high) = (0, l.segment_count as usize);
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            *if segment(middle).block as usize <= block { &mut low } else { &mut high } = middle;
        }
        let own = segment(low);
        let after = block as u32 - own.block;
        *t.contacts.blocks.at(block) = DeviceBlock {
            kind: own.kind,
            history: own.history + after * own.words,
            point: own.point + after * BLOCK as u32,
        };
    }
}

/// Sorts the contacts of a particle in one class by their partners, and of one partner by its images.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn sort_class(t: &DeviceTables, _: u32, row: usize) {
    let l = &t.lists;
    let of_images = l.image_classes as usize * t.particle_count as usize;
    if row >= of_images + l.tile_count as usize * l.classes as usize * t.tile as usize {
        return;
    }
    let is_image = row < of_images;
    let class = if is_image {
        row / t.particle_count as usize
    } else {
        l.image_classes as usize + (row - of_images) / t.tile as usize
    };
    // SAFETY: by contract; these slots are this thread's.
    unsafe {
        let counted = run(l.class_cursors, row);
        let first = (counted.start as u32).wrapping_add(*l.class_slots.at(class)) as usize;
        if first as u64 + counted.len() as u64 > u64::from(t.slot_count) {
            return t.beyond(0);
        }
        let partner = |k: usize| t.contacts.partner.at::<u32>(first + k);
        if is_image {
            let image = |k: usize| l.image.at::<u8>(first + k);
            let key = |k: usize| u64::from(*partner(k)) << 8 | u64::from(*image(k));
            sort(counted.len(), key, |a, b| {
                partner(a).swap(partner(b));
                image(a).swap(image(b));
            });
        } else {
            sort(counted.len(), |k| u64::from(*partner(k)), |a, b| partner(a).swap(partner(b)));
        }
    }
}

/// Counts the contact in a slot among those of its particles, or writes it there.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn contacts_of(t: &DeviceTables, mode: u32, slot: usize) {
    if slot >= t.slot_count as usize {
        return;
    }
    // SAFETY: by contract; cursors stand after the first number of their table.
    unsafe {
        let i: u32 = *t.contacts.i.at(slot);
        if i >= t.particle_count {
            return;
        }
        let put = |particle: u32, second: bool| {
            let at = add(t.contacts.starts.at(1 + particle as usize), 1) as usize;
            if mode == WRITE {
                *t.contacts.entries.at(at) = SlotEnd::new(slot, second);
            }
        };
        put(i, false);
        if kind_at(t, slot).with <= IMAGES {
            put(*t.contacts.partner.at(slot), true);
        }
    }
}

/// The kind of contact in a slot.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
unsafe fn kind_at(t: &DeviceTables, slot: usize) -> &DeviceKind {
    // SAFETY: by contract.
    unsafe {
        let block: &DeviceBlock = &*t.contacts.blocks.at(slot / BLOCK);
        &*t.kinds.at(block.kind as usize)
    }
}

/// Sorts the contacts of a particle by their slots.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn sort_contacts_of(t: &DeviceTables, _: u32, k: usize) {
    if k >= t.particle_count as usize {
        return;
    }
    // SAFETY: by contract; these entries are this thread's.
    unsafe {
        let own = run(t.contacts.starts, k);
        let entry = |n: usize| t.contacts.entries.at::<SlotEnd>(own.start + n);
        sort(own.len(), |n| u64::from((*entry(n)).order()), |a, b| entry(a).swap(entry(b)));
    }
}

/// Counts the triangles that a particle is listed with.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn triangles_of(t: &DeviceTables, _: u32, k: usize) {
    if k > t.particle_count as usize {
        return;
    }
    let mut count = 0;
    // SAFETY: by contract.
    unsafe {
        let own = if k < t.particle_count as usize { run(t.contacts.starts, k) } else { 0..0 };
        for entry in own {
            let end: SlotEnd = *t.contacts.entries.at(entry);
            count += u32::from(!end.is_second() && kind_at(t, end.slot()).with == MESH);
        }
        *t.triangle_starts.at(k) = count;
    }
}

/// What a contact that is not between two particles needs in each step: see [`DeviceTables::points`].
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn points(t: &DeviceTables, _: u32, slot: usize) {
    let l = &t.lists;
    if slot >= t.slot_count as usize {
        return;
    }
    // SAFETY: by contract.
    unsafe {
        let block: &DeviceBlock = &*t.contacts.blocks.at(slot / BLOCK);
        let kind: &DeviceKind = &*t.kinds.at(block.kind as usize);
        if kind.with == PARTICLES {
            return;
        }
        let point: &mut Row = &mut *t.points.at(block.point as usize + slot % BLOCK);
        let (i, partner): (u32, u32) = (*t.contacts.i.at(slot), *t.contacts.partner.at(slot));
        if i >= t.particle_count {
            *point = FAR[1];
            return;
        }
        if kind.with == IMAGES {
            let shift: Row4 = *l.shifts.at(*l.image.at::<u8>(slot) as usize);
            *point = at_rest((Vec3::zeros(), 0.0), shift.vector());
            return;
        }
        let wall: &DeviceWall = &*l.walls.at(kind.wall as usize);
        let shift = Image(partner / wall.parts).shift(&wall.around.period);
        if kind.with == PLANE || kind.with == MESH {
            *point = at_rest((Vec3::zeros(), 0.0), shift);
            return;
        }
        let sphere: Row4 = *wall.spheres.at((partner % wall.parts) as usize);
        let centre = sphere.vector();
        *point = if kind.with == SPHERES {
            let row: &Row = &*t.particles.rows.at(i as usize);
            WallPose::new(wall.pose, None)
                .row(wall.pose.position(&centre), sphere[3], shift, row.position())
                .0
        } else {
            at_rest((centre, sphere[3]), shift)
        };
    }
}

/// Centre and radius of a part as at t = 0, and a shift.
#[inline(always)]
fn at_rest((centre, radius): (Vec3, f64), shift: Vec3) -> Row {
    Row([centre.x, centre.y, centre.z, radius, shift.x, shift.y, shift.z, 0.0])
}
