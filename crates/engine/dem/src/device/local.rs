//! A device that is this processor: one thread after the other, in an order that is not theirs. Tests compare its bits.
#![expect(unsafe_code, reason = "it calls what a device runs, with tables that lie in its own memory")]

use crate::device::{CARRIED, Device, DeviceError, LISTS, MADE, MOVES, STARTED, TRIANGLES};
use gpu::compositions::NAMES;
use gpu::lists;
use gpu::moves::{carried, particle, started};
use gpu::tables::{Address, DeviceTables};
use gpu::threads::made;
use gpu::triangles::triangles;
use std::collections::BTreeMap;

/// A device in the memory of this process.
#[derive(Debug, Default)]
pub struct Local {
    memory: BTreeMap<u64, Vec<Line>>,
    launched: u64,
}

/// Tables begin at whole cache lines.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
struct Line([u8; 64]);

impl Local {
    /// What lies there, from the beginning of a table on or from within.
    fn bytes(&mut self, at: Address, len: usize) -> Result<&mut [u8], DeviceError> {
        let failed =
            || DeviceError::Failed { device: "this processor".to_owned(), what: "no such memory".to_owned() };
        let (begin, lines) = self.memory.range_mut(..=at.0).next_back().ok_or_else(failed)?;
        let first = (at.0 - begin) as usize;
        // SAFETY: lines are bytes, and these are all of them.
        let bytes: &mut [u8] =
            unsafe { std::slice::from_raw_parts_mut(lines.as_mut_ptr().cast(), lines.len() * 64) };
        bytes.get_mut(first..).and_then(|bytes| bytes.get_mut(..len)).ok_or_else(failed)
    }
}

/// The thread of a contact.
type Contacts = unsafe fn(&DeviceTables, u32, u32, usize);

macro_rules! functions {
    ($($name:tt $effects:ty;)*) => {
        /// Those of the compositions.
        const COMPOSITIONS: [Contacts; NAMES.len()] = [$(gpu::threads::contact::<$effects>),*];

        /// The thread of a function by its number, in [`crate::device::functions`].
        ///
        /// # Safety
        /// As [`gpu::threads::contact`] and [`particle`] say.
        unsafe fn thread(function: usize, tables: &DeviceTables, step: u32, thread: usize) {
            // SAFETY: by contract.
            unsafe {
                match COMPOSITIONS.get(function) {
                    Some(contacts) => contacts(tables, function as u32, step, thread),
                    _ if function == TRIANGLES => triangles(tables, step, thread),
                    _ if function == MADE => made(tables, step, thread),
                    _ if function == STARTED => started(tables, step, thread),
                    _ if function == CARRIED => carried(tables, step, thread),
                    _ if function == MOVES => particle::<false, false>(tables, step, thread),
                    _ if function == MOVES + 1 => particle::<true, false>(tables, step, thread),
                    _ if function == MOVES + 2 => particle::<false, true>(tables, step, thread),
                    _ if function == MOVES + 3 => particle::<true, true>(tables, step, thread),
                    _ => list_thread(function - LISTS, tables, step, thread),
                }
            }
        }
    };
}
laws::compositions!(functions);

macro_rules! list_functions {
    ($($name:ident)*) => {
        /// The thread of a function that makes lists.
        ///
        /// # Safety
        /// As each of them says.
        unsafe fn list_thread(function: usize, tables: &DeviceTables, mode: u32, thread: usize) {
            let name = lists::LIST_FUNCTIONS.get(function).copied();
            // SAFETY: by contract.
            unsafe {
                match name {
                    $(Some(stringify!($name)) => lists::$name(tables, mode, thread),)*
                    _ => {}
                }
            }
        }
    };
}
gpu::lists!(list_functions);

impl Device for Local {
    fn name(&self) -> String {
        "this processor, one thread after the other".to_owned()
    }

    fn allocate(&mut self, bytes: usize) -> Result<Address, DeviceError> {
        let lines = vec![Line([0; 64]); bytes.div_ceil(64).max(1)];
        let at = Address(lines.as_ptr() as u64);
        self.memory.insert(at.0, lines);
        Ok(at)
    }

    fn clear(&mut self, at: Address, bytes: usize) -> Result<(), DeviceError> {
        self.bytes(at, bytes)?.fill(0);
        Ok(())
    }

    fn release(&mut self, at: Address) -> Result<(), DeviceError> {
        self.memory.remove(&at.0);
        Ok(())
    }

    fn write(&mut self, to: Address, bytes: &[u8]) -> Result<(), DeviceError> {
        self.bytes(to, bytes.len())?.copy_from_slice(bytes);
        Ok(())
    }

    fn read(&mut self, from: Address, bytes: &mut [u8]) -> Result<(), DeviceError> {
        bytes.copy_from_slice(self.bytes(from, bytes.len())?);
        Ok(())
    }

    fn launch(
        &mut self,
        function: usize,
        threads: usize,
        tables: &DeviceTables,
        step: u32,
    ) -> Result<(), DeviceError> {
        // In strides that are prime to the number of threads, from another one on in each launch.
        self.launched += 1;
        let stride = [7919, 104_729, 15_485_863][(self.launched % 3) as usize];
        let stride = if threads.is_multiple_of(stride) { 1 } else { stride };
        for k in 0..threads {
            let k = (k * stride + self.launched as usize) % threads;
            // SAFETY: the tables are those of a stepper, in memory that it has allocated here; threads run one after the other.
            unsafe { thread(function, tables, step, k) }
        }
        Ok(())
    }
}
