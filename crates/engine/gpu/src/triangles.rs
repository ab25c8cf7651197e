//! What a thread does with the triangles near a particle: it finds which points of them are contacts, before any contact is computed.
#![expect(unsafe_code, reason = "threads share tables, of which each writes its own rows only")]

use crate::lists::run;
use crate::tables::{DeviceBlock, DeviceKind, DeviceMesh, DeviceTables, MESH};
use core::ops::Range;
use core::slice;
use laws::contact::SlotEnd;
use laws::contact::seams::{self, FARTHER, Member, Memory, Nearest, hand_over};
use laws::contact::wall_point::WallPose;
use laws::float::Float;
use laws::simd::{BLOCK, Row};
use laws::space::sphere::{FAR, is_away};
use primitives::Vec3;

/// Finds the points of all triangles that are contacts of a particle; in step `step` of a launch.
///
/// # Safety
/// Tables are in place and hold what they say; no other thread has this particle, and none computes contacts or moves particles meanwhile.
#[inline(always)]
pub unsafe fn triangles(t: &DeviceTables, step: u32, k: usize) {
    if k >= t.particle_count as usize {
        return;
    }
    // SAFETY: by contract; this thread alone writes to the rows of its particle, and to those of its contacts.
    unsafe {
        let rows = run(t.triangle_starts, k);
        if rows.is_empty() || t.is_over(step) {
            return;
        }
        if rows.end > t.triangle_count as usize {
            return t.beyond(step);
        }
        let near = slice::from_raw_parts_mut(t.nearest.at::<Nearest>(rows.start), rows.len());
        let members = slice::from_raw_parts_mut(t.members.at::<Member>(rows.start), rows.len());
        let (row, entries): (Row, _) = (*t.particles.rows.at(k), run(t.contacts.starts, k));
        let grain = Grain { t, step, row, entries };
        let mut entry = grain.entries.start;
        while entry < grain.entries.end {
            match grain.wall_at(entry) {
                None => entry += 1,
                Some(wall) => {
                    if grain.find(&wall, near, members).is_none() {
                        return t.beyond(step);
                    }
                    entry += wall.len;
                }
            }
        }
    }
}

/// A particle, and its entries in the lists.
struct Grain<'a> {
    t: &'a DeviceTables,
    step: u32,
    row: Row,
    entries: Range<usize>,
}

/// Its contacts with the triangles of one wall: slots that follow each other.
struct OfWall<'a> {
    kind: &'a DeviceKind,
    mesh: &'a DeviceMesh,
    pose: &'a WallPose,
    first: usize,
    len: usize,
}

impl<'a> Grain<'a> {
    /// The slot of an entry with a triangle, and the number of its kind; none of others.
    ///
    /// # Safety
    /// Tables are in place.
    #[inline(always)]
    unsafe fn slot(&self, entry: usize) -> Option<(usize, u32)> {
        let t = self.t;
        // SAFETY: by contract.
        unsafe {
            let end: SlotEnd = *t.contacts.entries.at(entry);
            if end.is_second() || end.slot() >= t.slot_count as usize {
                return None;
            }
            let block: DeviceBlock = *t.contacts.blocks.at(end.slot() / BLOCK);
            let is_mesh = block.kind < t.lists.kind_count && {
                let kind: &DeviceKind = &*t.kinds.at(block.kind as usize);
                kind.with == MESH && kind.wall < t.walls
            };
            is_mesh.then_some((end.slot(), block.kind))
        }
    }

    /// The contacts with the triangles of one wall that begin at an entry; none where it is with something else.
    ///
    /// # Safety
    /// Tables are in place.
    #[inline(always)]
    unsafe fn wall_at(&self, entry: usize) -> Option<OfWall<'a>> {
        let t = self.t;
        // SAFETY: by contract.
        unsafe {
            let (first, number) = self.slot(entry)?;
            let mut len = 1;
            while entry + len < self.entries.end && self.slot(entry + len) == Some((first + len, number)) {
                len += 1;
            }
            let kind: &DeviceKind = &*t.kinds.at(number as usize);
            let mesh: &DeviceMesh = &*t.meshes.at(kind.wall as usize);
            let pose: &WallPose = &*t.poses.at((self.step * t.walls + kind.wall) as usize);
            Some(OfWall { kind, mesh, pose, first, len })
        }
    }

    /// Finds which of the contacts with a wall there are, and puts their points; none where a table has no such row. `near` and `members` have rows for all of its triangles.
    ///
    /// # Safety
    /// Tables are in place; this thread has the particle.
    #[inline(always)]
    unsafe fn find(&self, wall: &OfWall, near: &mut [Nearest], members: &mut [Member]) -> Option<()> {
        let (t, row, mesh) = (self.t, &self.row, wall.mesh);
        // SAFETY: by contract.
        unsafe {
            for n in 0..wall.len {
                self.point(wall.first + n)?;
            }
            let near_of_wall = near.get_mut(..wall.len)?;
            if is_away(row) {
                (0..wall.len).for_each(|n| self.put(wall, n, None));
                return Some(());
            }
            let ahead = t.drive.ahead;
            let way =
                if ahead > 0.0 { ahead * (row.velocity().norm_squared().root() + mesh.fastest) } else { 0.0 };
            let (radius, reach) = (row.radius(), mesh.reach + way);
            self.take(wall, near_of_wall)?;
            let (mut first, mut count) = (0, wall.len);
            let limit = seams::limit(radius, reach);
            if mesh.surface_count == 0 {
                seams::count(&mut near[..count], members, radius, reach);
            } else if near[..count].iter().any(|n| n.is_within(limit)) {
                (first, count) = self.take_surface(wall, near, limit * FARTHER)?;
                seams::count(&mut near[..count], members, radius, reach);
            }
            let own = &near[first..first + wall.len];
            if wall.kind.columns > 0 {
                let mut histories = Histories { t, first: wall.first, columns: wall.kind.columns as usize };
                if !histories.are_there(wall.len) {
                    return None;
                }
                hand_over(own, radius, &mut histories);
            }
            for (n, point) in own.iter().enumerate() {
                self.put(wall, n, point.counts.then_some(point.way));
            }
            Some(())
        }
    }

    /// Where the point of a slot is; none where there is no such row.
    ///
    /// # Safety
    /// Tables are in place.
    #[inline(always)]
    unsafe fn point(&self, slot: usize) -> Option<*mut Row> {
        let t = self.t;
        // SAFETY: by contract.
        unsafe {
            let block: &DeviceBlock = &*t.contacts.blocks.at(slot / BLOCK);
            let number = block.point as usize + slot % BLOCK;
            (number < t.point_count as usize).then(|| t.points.at(number))
        }
    }

    /// The centre of the particle as the wall sees it from where contact `n` is, as at t = 0 [m].
    ///
    /// # Safety
    /// Tables are in place, and it has a point.
    #[inline(always)]
    unsafe fn local(&self, wall: &OfWall, n: usize) -> Vec3 {
        // SAFETY: by contract.
        let shift = unsafe {
            let block: &DeviceBlock = &*self.t.contacts.blocks.at((wall.first + n) / BLOCK);
            let point: &Row = &*self.t.points.at(block.point as usize + (wall.first + n) % BLOCK);
            Vec3::new(point[4], point[5], point[6])
        };
        wall.pose.pose.home(&(self.row.position() - shift))
    }

    /// Puts the point of contact `n`, so far from the centre of the particle; out of reach where it is no separate contact.
    ///
    /// # Safety
    /// Tables are in place, and it has a point.
    #[inline(always)]
    unsafe fn put(&self, wall: &OfWall, n: usize, way: Option<Vec3>) {
        // SAFETY: by contract.
        unsafe {
            let position = match way {
                Some(way) => wall.pose.pose.position(&(self.local(wall, n) + way)),
                None => Vec3::repeat(FAR[1][0]),
            };
            if let Some(point) = self.point(wall.first + n) {
                let point: &mut Row = &mut *point;
                (point[0], point[1], point[2]) = (position.x, position.y, position.z);
            }
        }
    }

    /// Takes the nearest points on the triangles of a wall; none where it has no such triangle.
    ///
    /// # Safety
    /// Tables are in place.
    #[inline(always)]
    unsafe fn take(&self, wall: &OfWall, near: &mut [Nearest]) -> Option<()> {
        for (n, row) in near.iter_mut().enumerate() {
            // SAFETY: by contract, and there are so many contacts.
            unsafe {
                let partner: u32 = *self.t.contacts.partner.at(wall.first + n);
                if wall.mesh.parts == 0 {
                    return None;
                }
                let corners = *wall.mesh.corners.at((partner % wall.mesh.parts) as usize);
                *row = Nearest::of(corners, self.local(wall, n));
            }
        }
        Some(())
    }

    /// The same with those within `limit` [m] on the walls that are one surface with it, in the order of the walls: where those of the wall itself begin,
    /// and how many all are.
    ///
    /// # Safety
    /// Tables are in place.
    #[inline(always)]
    unsafe fn take_surface(&self, wall: &OfWall, near: &mut [Nearest], limit: f64) -> Option<(usize, usize)> {
        let (t, mesh) = (self.t, wall.mesh);
        let (mut first, mut count) = (0, 0);
        // SAFETY: by contract.
        unsafe {
            for n in 0..mesh.surface_count as usize {
                let number: u32 = *mesh.surface.at(n);
                if number == wall.kind.wall {
                    first = count;
                    count += wall.len;
                    self.take(wall, near.get_mut(first..count)?)?;
                    continue;
                }
                let mut last = None;
                for n in 0..wall.len {
                    let image = *t.contacts.partner.at::<u32>(wall.first + n) / mesh.parts;
                    // Triangles of one image follow each other.
                    if last.replace(image) == Some(image) {
                        continue;
                    }
                    let centre = self.local(wall, n);
                    for entry in self.entries.clone() {
                        let Some((slot, kind)) = self.slot(entry) else { continue };
                        let kind: &DeviceKind = &*t.kinds.at(kind as usize);
                        if kind.wall != number {
                            continue;
                        }
                        let other: &DeviceMesh = &*t.meshes.at(number as usize);
                        let partner: u32 = *t.contacts.partner.at(slot);
                        if other.parts == 0 || partner / other.parts != image {
                            continue;
                        }
                        let corners = *other.corners.at((partner % other.parts) as usize);
                        let found = Nearest::of(corners, centre);
                        if found.way.norm_squared() < limit * limit {
                            *near.get_mut(count)? = found;
                            count += 1;
                        }
                    }
                }
            }
        }
        Some((first, count))
    }
}

/// Histories of the contacts with a wall.
struct Histories<'a> {
    t: &'a DeviceTables,
    first: usize,
    columns: usize,
}

impl Histories<'_> {
    /// Whether the table has all of the words of `count` contacts.
    ///
    /// # Safety
    /// Tables are in place.
    #[inline(always)]
    unsafe fn are_there(&self, count: usize) -> bool {
        (0..count).step_by(BLOCK).chain(count.checked_sub(1)).all(|k| {
            // SAFETY: by contract.
            let block: DeviceBlock = unsafe { *self.t.contacts.blocks.at((self.first + k) / BLOCK) };
            u64::from(block.history) + (self.columns * BLOCK) as u64 <= u64::from(self.t.history_count)
        })
    }

    /// First number of contact `k`; the next is a block further.
    #[inline(always)]
    fn words(&self, k: usize) -> *mut f64 {
        let slot = self.first + k;
        // SAFETY: tables are in place where these are made, and there is such a slot.
        let block: DeviceBlock = unsafe { *self.t.contacts.blocks.at(slot / BLOCK) };
        self.t.contacts.history.at(block.history as usize + slot % BLOCK)
    }
}

impl Memory for Histories<'_> {
    #[inline(always)]
    fn holds(&self, k: usize) -> bool {
        let words = self.words(k);
        // SAFETY: the table has all of its words.
        (0..self.columns).any(|c| unsafe { *words.wrapping_add(c * BLOCK) } != 0.0)
    }

    #[inline(always)]
    fn give(&mut self, from: usize, to: usize) {
        let (a, b) = (self.words(from), self.words(to));
        // SAFETY: the table has all of their words, which are those of this thread.
        unsafe {
            for c in 0..self.columns {
                *b.wrapping_add(c * BLOCK) = *a.wrapping_add(c * BLOCK);
                *a.wrapping_add(c * BLOCK) = 0.0;
            }
            // Or it would be passed over where it does not touch.
            *self.t.acts.at(self.first + to) = 1_u8;
        }
    }
}
