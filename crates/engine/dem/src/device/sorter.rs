//! Particles of a device in the order of their cells: [`crate::space::search::Search`] as it makes them.

use crate::device::DeviceError;
use crate::device::tables::Table;
use crate::device::work::{RunningSums, Work};
use crate::space::search::{cell_width, common_place, shortest_first};
use geom::Vec3;
use geom::grid::lattice_over;
use gpu::tables::Address;
use gpu::tables::lists::{CHUNK, DIGIT, DIGITS, INTERVALS, LeastRow, PART};
use laws::simd::{Row, Row4};
use laws::space::images::Periods;
use std::mem::swap;

/// Columns of particles.
#[derive(Default)]
pub struct ParticleColumns {
    pub rows: Table,
    pub spins: Table,
    pub acceleration: Table,
    pub angular_acceleration: Table,
    pub home: Table,
    pub material: Table,
    pub place: Table,
}

/// Particles, and what they are sorted with.
#[derive(Default)]
pub struct Sorter {
    pub particles: ParticleColumns,
    next: ParticleColumns,
    wraps: Table,
    spots: Table,
    keys: [Table; 2],
    order: [Table; 2],
    cell_starts: Table,
    counters: Table,
    boxes: [Table; 2],
    reach_counts: Table,
    reaches: Table,
    sums: RunningSums,
}

impl Sorter {
    /// Finds margins, cells and their order; particles keep their places where they have just been sent: they are in order.
    pub fn sort(&mut self, work: &mut Work, moved: bool) -> Result<(), DeviceError> {
        let count = work.count();
        work.t.lists.wraps = self.wraps.room::<Periods>(work.device, count)?;
        if moved {
            work.launch("margins", count, 0)?;
        }
        let least = self.least(work)?;
        let (low, high) = (Vec3::from(least.low), -Vec3::from(least.opposite_high));
        let axes = shortest_first((low, high));
        work.t.lists.axes = [axes[0] as u32, axes[1] as u32, axes[2] as u32, 0];
        let bounds = [work.t.lists.along(&low), work.t.lists.along(&high)];
        work.t.lists.bounds = bounds.map(Into::into);
        let common = self.common_reach(work, &least)?;
        let [low, high] = bounds;
        work.t.lists.lattice =
            lattice_over((low, high), cell_width(common), count, Some(work.t.tile as usize));
        let [keys, next_keys] = &mut self.keys;
        work.t.lists.keys = keys.room::<u64>(work.device, count)?;
        work.t.lists.next_keys = next_keys.room::<u64>(work.device, count)?;
        let [order, next_order] = &mut self.order;
        work.t.lists.order = order.room::<u32>(work.device, count)?;
        work.t.lists.next_order = next_order.room::<u32>(work.device, count)?;
        work.launch("keys", count, 0)?;
        if moved {
            self.sort_keys(work)?;
            self.permute(work)?;
        }
        self.find_cells(work)?;
        work.t.lists.spots = self.spots.room::<Row4>(work.device, count)?;
        work.launch("spots", count, 0)
    }

    /// The box of all particles, and their least and largest reach.
    fn least(&mut self, work: &mut Work) -> Result<LeastRow, DeviceError> {
        /// So few boxes are read.
        const FEW: usize = 1024;
        let [boxes, folded] = &mut self.boxes;
        let mut rows = work.count().div_ceil(PART);
        work.t.lists.boxes = boxes.room::<LeastRow>(work.device, rows)?;
        work.launch("boxes", rows, 0)?;
        while rows > FEW {
            work.t.lists.box_count = rows as u32;
            rows = rows.div_ceil(PART);
            work.t.lists.next_boxes = folded.room::<LeastRow>(work.device, rows)?;
            work.launch("fold", rows, 0)?;
            swap(boxes, folded);
            work.t.lists.boxes = work.t.lists.next_boxes;
        }
        let mut all = vec![LeastRow::default(); rows];
        boxes.read(work.device, &mut all)?;
        Ok(all.into_iter().fold(LeastRow::NONE, LeastRow::and))
    }

    /// The reach that few particles surpass: counted by intervals, and sorted in the one that it is in.
    fn common_reach(&mut self, work: &mut Work, least: &LeastRow) -> Result<f64, DeviceError> {
        let (count, largest) = (work.count(), -least.opposite_reach);
        if count == 0 || largest <= least.reach {
            return Ok(if count == 0 { 1.0 } else { largest });
        }
        (work.t.lists.least_reach, work.t.lists.per_metre) =
            (least.reach, INTERVALS as f64 / (largest - least.reach));
        work.t.lists.reach_counts = self.reach_counts.zeros::<u32>(work.device, INTERVALS)?;
        work.launch("count_reach", count, 0)?;
        let mut counts = vec![0_u32; INTERVALS];
        self.reach_counts.read(work.device, &mut counts)?;
        let (place, mut before, mut interval) = (common_place(count), 0, 0);
        while before + counts[interval] as usize <= place {
            before += counts[interval] as usize;
            interval += 1;
        }
        work.t.lists.interval = interval as u32;
        work.t.lists.reaches = self.reaches.room::<f64>(work.device, counts[interval] as usize)?;
        work.t.lists.reach_counts = self.reach_counts.zeros::<u32>(work.device, INTERVALS)?;
        work.launch("near_reach", count, 0)?;
        let mut near = vec![0.0; counts[interval] as usize];
        self.reaches.read(work.device, &mut near)?;
        Ok(*near.select_nth_unstable_by(place - before, f64::total_cmp).1)
    }

    fn sort_keys(&mut self, work: &mut Work) -> Result<(), DeviceError> {
        let chunks = work.count().div_ceil(CHUNK);
        let largest = work.t.lists.lattice.keys() as u64;
        let bits = u64::BITS - largest.leading_zeros();
        for digit in 0..bits.div_ceil(DIGIT) {
            work.t.lists.counters = self.counters.zeros::<u32>(work.device, DIGITS * chunks)?;
            work.launch("digits", chunks, digit)?;
            self.sums.make(work, work.t.lists.counters, DIGITS * chunks)?;
            work.launch("spread", chunks, digit)?;
            self.keys.reverse();
            self.order.reverse();
            swap(&mut work.t.lists.keys, &mut work.t.lists.next_keys);
            swap(&mut work.t.lists.order, &mut work.t.lists.next_order);
        }
        Ok(())
    }

    /// Notes the first particle of each cell, unless most cells are empty.
    fn find_cells(&mut self, work: &mut Work) -> Result<(), DeviceError> {
        /// Cells for each particle, at most.
        const CELLS: f64 = 16.0;
        let cells = work.t.lists.lattice.keys();
        if cells > CELLS * f64::from(work.t.particle_count) + 1024.0 || cells >= f64::from(u32::MAX) {
            work.t.lists.cell_starts = Address::default();
            return Ok(());
        }
        work.t.lists.cells = cells as u32;
        work.t.lists.cell_starts = self.cell_starts.room::<u32>(work.device, cells as usize + 1)?;
        work.launch("cell_starts", cells as usize + 1, 0)
    }

    /// Brings the columns of the particles into order.
    fn permute(&mut self, work: &mut Work) -> Result<(), DeviceError> {
        let count = work.count();
        let next = &mut work.t.lists.next;
        let turning = if work.t.rotates != 0 { count + 2 } else { 0 };
        next.rows = self.next.rows.room::<Row>(work.device, count + 2)?;
        next.spins = self.next.spins.room::<Row4>(work.device, turning)?;
        next.acceleration = self.next.acceleration.room::<Row4>(work.device, count)?;
        next.angular_acceleration = self.next.angular_acceleration.room::<Row4>(work.device, turning)?;
        next.home = self.next.home.room::<Row4>(work.device, count)?;
        next.material = self.next.material.room::<u32>(work.device, count)?;
        next.place = self.next.place.room::<u32>(work.device, count)?;
        work.launch("permute", count + 2, 0)?;
        swap(&mut self.particles, &mut self.next);
        swap(&mut work.t.particles, &mut work.t.lists.next);
        Ok(())
    }
}
