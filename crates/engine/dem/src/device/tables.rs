//! Tables in the memory of a device.
#![expect(unsafe_code, reason = "rows are copied as bytes")]

use crate::device::{Device, DeviceError};
use geom::motion::Pose;
use geom::{Lattice, Vec3};
use gpu::tables::lists::{DeviceSegment, DeviceWall, LeastRow};
use gpu::tables::{Address, DeviceBlock, DeviceFlags, DeviceKind, DeviceMesh, DeviceZoneRow};
use laws::contact::SlotEnd;
use laws::contact::wall_point::WallPose;
use laws::simd::{Row, Row4};
use laws::space::images::WallImages;

/// Rows that may be copied as bytes: they have no gaps, and every pattern of bits is one.
///
/// # Safety
/// That is so.
pub unsafe trait Plain: Copy {}

macro_rules! numbers {
    ($($number:ty),*) => { $(
        // SAFETY: a number, of which every pattern of bits is one.
        unsafe impl Plain for $number {}
    )* };
}
numbers!(u8, u32, u64, i32, i64, f64);

// SAFETY: rows one after the other, without gaps.
unsafe impl<T: Plain, const N: usize> Plain for [T; N] {}

/// Structures that are made of one kind of number, some of them with private fields.
macro_rules! all_of {
    ($($row:ty: $of:ty;)*) => { $(
        const _: () = assert!(size_of::<$row>() == size_of::<$of>());
        // SAFETY: these numbers, which leave no room for anything else.
        unsafe impl Plain for $row {}
    )* };
}
all_of! {
    Address: u64;
    SlotEnd: u32;
    Vec3: [f64; 3];
    Pose: [f64; 21];
    Row: [f64; 8];
    Row4: [f64; 4];
}

/// Structures of several kinds of fields: a field that is missing here or has another type, one that is not plain, or a gap is an error of the compiler.
macro_rules! fields {
    ($($row:ident { $($field:ident: $of:ty),* $(,)? })*) => { $(
        const _: () = assert!(size_of::<$row>() == 0 $(+ size_of::<$of>())*);
        const _: fn($row) = |$row { $($field),* }| { $(is_plain::<$of>($field);)* };
        // SAFETY: its fields are plain, and there is nothing between them.
        unsafe impl Plain for $row {}
    )* };
}
fields! {
    LeastRow { low: [f64; 3], opposite_high: [f64; 3], reach: f64, opposite_reach: f64 }
    DeviceSegment { block: u32, kind: u32, history: u32, words: u32, point: u32 }
    Lattice { origin: Vec3, cell: f64, dims: [i64; 3], block: [i64; 3], blocks: [i64; 3] }
    WallImages { period: Vec3, lo: Vec3, hi: Vec3 }
    DeviceWall {
        pose: Pose, around: WallImages, margin: f64, largest: f64, lattice: Lattice, spheres: Address,
        keys: Address, parts: u32, pad: u32, back: [i32; 4],
    }
    DeviceBlock { kind: u32, history: u32, point: u32 }
    DeviceKind {
        composition: u32, with: u32, numbers: u32, wall: u32, between: [u32; 2], class: u32, columns: u32,
        flips: u32, patch: u32, gap: f64, plane: [[f64; 3]; 2],
    }
    DeviceMesh {
        corners: Address, doubled: Address, nodes: Address, order: Address, boxes: Address, surface: Address,
        node_count: u32, parts: u32, surface_count: u32, pad: u32, fastest: f64, reach: f64,
    }
    DeviceZoneRow {
        position: [f64; 3], velocity: [f64; 3], acceleration: [f64; 3], spin: [f64; 3], acts: u64,
    }
    DeviceFlags { stopped: u32, left_margin: u32, too_fast: u32, deep: u32, beyond: u32, met: u32 }
    WallPose { pose: Pose, belt: Pose, has_belt: u64 }
}

/// Only what is plain can be given.
const fn is_plain<T: Plain>(_: T) {}

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
