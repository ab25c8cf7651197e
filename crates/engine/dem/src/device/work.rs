//! What a device is asked to do, with the tables that it is given.

use crate::device::tables::Table;
use crate::device::{Device, DeviceError, functions};
use gpu::tables::lists::SUMMED;
use gpu::tables::{Address, DeviceTables};

/// A device, and the tables of its threads.
pub struct Work<'a> {
    pub device: &'a mut dyn Device,
    pub t: &'a mut DeviceTables,
}

impl Work<'_> {
    /// So many threads of a function of those that make lists.
    pub fn launch(&mut self, name: &str, threads: usize, mode: u32) -> Result<(), DeviceError> {
        let function = functions().iter().position(|f| *f == name).unwrap_or(usize::MAX);
        self.device.launch(function, threads, self.t, mode)
    }

    /// Number of particles.
    pub fn count(&self) -> usize {
        self.t.particle_count as usize
    }
}

/// Running sums of a table: each number becomes the sum of those before it.
#[derive(Default)]
pub struct RunningSums(Vec<Table>);

impl RunningSums {
    /// Makes them of so many numbers.
    pub fn make(&mut self, work: &mut Work, from: Address, count: usize) -> Result<(), DeviceError> {
        // The sums of its parts, their sums, …
        let mut levels = vec![(from, count)];
        loop {
            let (from, count) = levels[levels.len() - 1];
            let parts = count.div_ceil(SUMMED);
            if parts <= 1 {
                break;
            }
            if self.0.len() < levels.len() {
                self.0.push(Table::default());
            }
            let sums = self.0[levels.len() - 1].room::<u32>(work.device, parts)?;
            let l = &mut work.t.lists;
            (l.summed, l.summed_count, l.sums) = (from, count as u32, sums);
            work.launch("scan_sums", parts, 0)?;
            levels.push((sums, parts));
        }
        let mut sums = Address::default();
        for (from, count) in levels.into_iter().rev() {
            let l = &mut work.t.lists;
            (l.summed, l.summed_count, l.sums) = (from, count as u32, sums);
            work.launch("scan_down", count.div_ceil(SUMMED), 0)?;
            sums = from;
        }
        Ok(())
    }
}
