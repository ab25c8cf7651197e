//! Contacts of a device in their slots: laid out here, as [`Slots`] lays them out, and filled there.

use crate::device::kinds::Fixed;
use crate::device::tables::Table;
use crate::device::work::{RunningSums, Work};
use crate::device::{Device, DeviceError};
use crate::model::{Model, With};
use crate::neighbours::{Segment, Slots};
use gpu::lists::{COUNT, WRITE};
use gpu::tables::lists::DeviceSegment;
use gpu::tables::{Address, IMAGES, PARTICLES};
use laws::simd::{BLOCK, Row, TORQUE};
use laws::space::cell::ImageOf;
use std::mem::swap;

/// Columns of contacts.
#[derive(Default)]
pub struct ContactColumns {
    i: Table,
    partner: Table,
    pub history: Table,
    blocks: Table,
    starts: Table,
    entries: Table,
}

/// Contacts, as they are and as they were, and what they are made with.
#[derive(Default)]
pub struct Contacts {
    pub columns: ContactColumns,
    old: ContactColumns,
    pub acts: Table,
    made: Table,
    /// Segments of the lists that the device has; it has their contacts.
    pub slots: Slots,
    cursors: Table,
    class_starts: Table,
    class_slots: Table,
    image: Table,
    segments: Table,
    pub forces: Table,
    pub moments: Table,
    points: Table,
    tiles: Table,
    sums: RunningSums,
}

impl Contacts {
    /// Counts contacts by particle and class, and lays their slots out.
    pub fn count(&mut self, work: &mut Work, model: &Model, fixed: &Fixed) -> Result<(), DeviceError> {
        let count = work.count();
        let rows = rows_of_classes(work);
        if u32::try_from(rows + 2).is_err() {
            let what =
                format!("{rows} pairs of a grain and a class of contacts are more than its tables number");
            return Err(DeviceError::Failed { device: work.device.name(), what });
        }
        work.t.lists.class_cursors = self.cursors.zeros::<u32>(work.device, rows + 2)?;
        seek(work, COUNT)?;
        self.sums.make(work, after_first(work.t.lists.class_cursors), rows + 1)?;
        let classes = work.t.lists.class_of(work.t.lists.tile_count as usize, 0);
        work.t.lists.class_starts = self.class_starts.room::<u32>(work.device, classes + 1)?;
        work.launch("class_starts", classes + 1, 0)?;
        let mut starts = vec![0_u32; classes + 1];
        self.class_starts.read(work.device, &mut starts)?;
        let groups = groups(fixed);
        let len = |[from, to]: [usize; 2]| (starts[to] - starts[from]) as usize;
        let images: Vec<usize> = groups.images.iter().map(|&group| len(group)).collect();
        let tiles = (0..work.t.lists.tile_count as usize).map(|tile| {
            let of = |both: &[[u32; 2]; 2]| {
                both.map(|ends| len(ends.map(|class| work.t.lists.class_of(tile, class))))
            };
            groups.of_tile.iter().map(of).collect()
        });
        self.slots = Slots::laid_out(&model.kinds, &images, tiles, count, model.layout());
        // Of each class that has any, in their order.
        let mut class_slots = vec![0_u32; classes];
        let mut segments = self.slots.segments.iter();
        let mut place = |[from, to]: [usize; 2]| {
            if starts[to] > starts[from]
                && let Some(segment) = segments.next()
            {
                class_slots[from..to].fill((segment.slots.start as u32).wrapping_sub(starts[from]));
            }
        };
        groups.images.iter().for_each(|&group| place(group));
        for tile in 0..work.t.lists.tile_count as usize {
            for ends in groups.of_tile.iter().flatten() {
                place(ends.map(|class| work.t.lists.class_of(tile, class)));
            }
        }
        work.t.lists.class_slots = self.class_slots.write(work.device, &class_slots)?;
        Ok(())
    }

    /// Writes contacts into their slots, and finds those of each particle.
    pub fn make(&mut self, work: &mut Work, model: &Model, fixed: &mut Fixed) -> Result<(), DeviceError> {
        let (count, slots) = (work.count(), self.slots.end());
        if u32::try_from(self.slots.history.max(2 * slots)).is_err() {
            let what = format!("{} contacts are more than its tables number", self.slots.len());
            return Err(DeviceError::Failed { device: work.device.name(), what });
        }
        work.t.slot_count = slots as u32;
        (work.t.history_count, work.t.point_count) =
            (self.slots.history as u32, u32::try_from(self.slots.rows()).unwrap_or(u32::MAX));
        swap(&mut self.columns, &mut self.old);
        work.t.lists.old = work.t.contacts;
        let c = &mut self.columns;
        work.t.contacts.i = c.i.room::<u32>(work.device, slots)?;
        work.t.contacts.partner = c.partner.room::<u32>(work.device, slots)?;
        work.t.contacts.history = c.history.zeros::<f64>(work.device, self.slots.history)?;
        work.t.contacts.blocks = c.blocks.room::<[u32; 3]>(work.device, slots / BLOCK)?;
        work.t.contacts.starts = c.starts.zeros::<u32>(work.device, count + 2)?;
        work.t.contacts.entries = c.entries.room::<u32>(work.device, 2 * slots)?;
        work.t.acts = self.acts.room::<u8>(work.device, slots)?;
        work.t.made = self.made.room::<u8>(work.device, if fixed.lasts() { slots } else { 0 })?;
        work.t.lists.image = self.image.room::<u8>(work.device, self.slots.with_images())?;
        work.t.points = self.points.room::<Row>(work.device, self.slots.rows())?;
        work.t.forces = self.forces.room::<f64>(work.device, slots * model.layout().force())?;
        work.t.moments =
            self.moments.room::<f64>(work.device, if work.t.torques != 0 { slots * TORQUE } else { 0 })?;
        work.t.tiles = self.tiles.write(work.device, &first_slots(&self.slots))?;
        let segment = |s: &Segment| DeviceSegment {
            block: (s.slots.start / BLOCK) as u32,
            kind: s.kind as u32,
            history: s.history as u32,
            words: BLOCK as u32 * fixed.kinds[s.kind].columns,
            point: s.rows as u32,
        };
        let segments: Vec<DeviceSegment> = self.slots.segments.iter().map(segment).collect();
        work.t.lists.segments = self.segments.write(work.device, &segments)?;
        work.t.lists.segment_count = segments.len() as u32;
        work.launch("clear_slots", slots, 0)?;
        work.launch("blocks", slots / BLOCK, 0)?;
        seek(work, WRITE)?;
        work.launch("sort_class", rows_of_classes(work), 0)?;
        work.launch("contacts_of", slots, COUNT)?;
        self.sums.make(work, after_first(work.t.contacts.starts), count + 1)?;
        work.launch("contacts_of", slots, WRITE)?;
        work.launch("sort_contacts_of", count, 0)?;
        fixed.meshes.make_room(work)
    }

    /// The lists that the device has; images are those of [`laws::space::cell::Cell::half_of_images`].
    pub fn fetch(&self, device: &mut dyn Device, images: &[ImageOf]) -> Result<Slots, DeviceError> {
        let (slots, with_images) = (self.slots.end(), self.slots.with_images());
        let (mut i, mut partner, mut numbers) =
            (vec![0_u32; slots], vec![0_u32; slots], vec![0_u8; with_images]);
        self.columns.i.read(device, &mut i)?;
        self.columns.partner.read(device, &mut partner)?;
        self.image.read(device, &mut numbers)?;
        let mut image = vec![[0; 3]; with_images];
        let of_images = self.slots.segments.iter().filter(|s| s.with == With::Images);
        for slot in of_images.flat_map(Segment::contacts) {
            image[slot] = images.get(usize::from(numbers[slot])).copied().unwrap_or_default();
        }
        let mut all = self.slots.clone();
        all.fill(i, partner, image);
        Ok(all)
    }
}

#[cfg(test)]
impl Contacts {
    /// Where the contacts of each particle begin, and these.
    pub fn of_particles(&self, device: &mut dyn Device) -> Result<[Vec<u32>; 2], DeviceError> {
        let mut starts = vec![0; self.slots.particles + 1];
        self.columns.starts.read(device, &mut starts)?;
        let mut entries = vec![0; starts.last().map_or(0, |end| *end as usize)];
        self.columns.entries.read(device, &mut entries)?;
        Ok([starts, entries])
    }
}

/// Finds everything that may touch.
fn seek(work: &mut Work, mode: u32) -> Result<(), DeviceError> {
    let count = work.count();
    work.launch("common_pairs", count, mode)?;
    work.launch("wide_pairs", count, mode)?;
    if work.t.lists.images > 0 {
        work.launch("image_pairs", count, mode)?;
    }
    work.launch("wall_parts", if work.t.walls > 0 { count } else { 0 }, mode)
}

/// How many pairs of a particle and a class there are.
fn rows_of_classes(work: &Work) -> usize {
    let l = &work.t.lists;
    l.image_classes as usize * work.count()
        + l.tile_count as usize * l.classes as usize * work.t.tile as usize
}

/// The table after its first number.
fn after_first(table: Address) -> Address {
    Address(table.0 + size_of::<u32>() as u64)
}

/// Which classes follow each other in a segment: the first, and the one after the last.
struct Groups {
    /// Of images.
    images: Vec<[usize; 2]>,
    /// Of each kind in a tile: with particles of the tile, and of later ones.
    of_tile: Vec<[[u32; 2]; 2]>,
}

fn groups(fixed: &Fixed) -> Groups {
    let mut of = Groups { images: Vec::new(), of_tile: Vec::new() };
    for kind in &fixed.kinds {
        let first = kind.class;
        let (image, both) = match kind.with {
            PARTICLES => ([0; 2], [[first, first + 2], [first + 2, first + 4]]),
            IMAGES => ([first as usize, first as usize + 1], [[0; 2]; 2]),
            _ => ([0; 2], [[first, first + 1], [first + 1; 2]]),
        };
        of.images.push(image);
        of.of_tile.push(both);
    }
    of
}

/// First slot of each tile.
fn first_slots(slots: &Slots) -> Vec<u32> {
    let end = slots.end();
    let first = |&segment: &usize| slots.segments.get(segment).map_or(end, |s| s.slots.start) as u32;
    slots.tiles.iter().map(first).collect()
}
