//! Tables in the memory of a device.
#![expect(unsafe_code, reason = "rows are copied as bytes")]

use crate::device::{Device, DeviceError};
use crate::kernel::SlotEnd;
use crate::kernel::device_tables::{Address, DeviceBlock, DeviceFlags, DeviceKind};
use crate::kernel::lists::tables::{DeviceSegment, DeviceWall, LeastRow};
use crate::kernel::wall_point::WallPose;
use crate::simd::{Row, Row4};
use crate::space::images::Periods;

/// Rows that may be copied as bytes: they have no gaps, and every pattern of bits is one.
///
/// # Safety
/// That is so.
pub unsafe trait Plain: Copy {}

macro_rules! plain {
    ($($row:ty),*) => { $(
        // SAFETY: numbers without gaps between them.
        unsafe impl Plain for $row {}
    )* };
}
plain!(
    u8,
    u32,
    u64,
    f64,
    [u32; 3],
    Periods,
    LeastRow,
    DeviceSegment,
    DeviceWall,
    Row,
    Row4,
    SlotEnd,
    DeviceBlock,
    DeviceKind,
    DeviceFlags,
    WallPose
);

/// A table, as long as it was at most.
#[derive(Debug, Default)]
pub struct Table {
    at: Option<Address>,
    bytes: usize,
}

impl Table {
    /// Makes room for so many rows, and says where: what was there is lost where it was too small.
    pub fn room<T: Plain>(&mut self, device: &mut dyn Device, rows: usize) -> Result<Address, DeviceError> {
        let bytes = rows * size_of::<T>();
        match self.at {
            Some(at) if bytes <= self.bytes => Ok(at),
            old => {
                self.at = None;
                old.map_or(Ok(()), |at| device.release(at))?;
                // Lists differ a little from one rebuild to the next.
                self.bytes = bytes + bytes / 8;
                let at = device.allocate(self.bytes)?;
                self.at = Some(at);
                Ok(at)
            }
        }
    }

    /// Makes room for so many rows of zeros, and says where.
    pub fn zeros<T: Plain>(&mut self, device: &mut dyn Device, rows: usize) -> Result<Address, DeviceError> {
        let at = self.room::<T>(device, rows)?;
        device.clear(at, rows * size_of::<T>())?;
        Ok(at)
    }

    /// Copies rows there, and says where.
    pub fn write<T: Plain>(&mut self, device: &mut dyn Device, rows: &[T]) -> Result<Address, DeviceError> {
        let at = self.room::<T>(device, rows.len())?;
        // SAFETY: rows are plain, and these are all their bytes.
        let bytes = unsafe { std::slice::from_raw_parts(rows.as_ptr().cast(), size_of_val(rows)) };
        device.write(at, bytes)?;
        Ok(at)
    }

    /// Copies rows from there; nothing where the table has never been written.
    pub fn read<T: Plain>(&self, device: &mut dyn Device, rows: &mut [T]) -> Result<(), DeviceError> {
        let Some(at) = self.at else { return Ok(()) };
        let len = size_of_val(rows).min(self.bytes);
        // SAFETY: rows are plain: any bytes will do for them.
        let bytes = unsafe { std::slice::from_raw_parts_mut(rows.as_mut_ptr().cast(), len) };
        device.read(at, bytes)
    }
}
