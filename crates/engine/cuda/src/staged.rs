//! Copies between the memory of the processor and that of a GPU, by way of two buffers that stay in place: the GPU reads or writes one of them while all
//! threads fill or empty the other. A copy from where memory may be swapped out goes through one thread of the driver, at a fraction of the speed.

use cudarc::driver::result::{self, DriverError, event};
use cudarc::driver::sys::{CUevent, CUevent_flags};
use rayon::prelude::*;
use std::ptr::null_mut;
use std::slice;

/// Bytes of a buffer.
const BUFFER: usize = 32 << 20;
/// Bytes that a thread copies at once.
const PART: usize = 1 << 20;
/// Bytes below which the driver copies.
const SMALL: usize = 4 << 20;

/// A buffer that stays in place, and when the GPU has done with it.
struct Buffer {
    start: *mut u8,
    done: CUevent,
}

/// The two buffers of a GPU, whose context is that of the thread in each call.
pub struct Staged([Buffer; 2]);

impl Buffer {
    fn new() -> Result<Buffer, DriverError> {
        let done = event::create(CUevent_flags::CU_EVENT_DISABLE_TIMING)?;
        // SAFETY: it asks for memory.
        let start = unsafe { result::malloc_host(BUFFER, 0) };
        Ok(Buffer { start: start?.cast(), done })
    }

    /// Its first bytes, when the GPU has done with them.
    fn bytes(&mut self, len: usize) -> Result<&mut [u8], DriverError> {
        // SAFETY: the event is that of the last copy, and `len` is no more than the buffer's.
        unsafe {
            event::synchronize(self.done)?;
            Ok(slice::from_raw_parts_mut(self.start, len.min(BUFFER)))
        }
    }

    /// Notes that the copy that was last asked for uses it.
    fn used(&self) -> Result<(), DriverError> {
        // SAFETY: the event is there.
        unsafe { event::record(self.done, null_mut()) }
    }
}

fn copy(to: &mut [u8], from: &[u8]) {
    to.par_chunks_mut(PART).zip(from.par_chunks(PART)).for_each(|(to, from)| to.copy_from_slice(from));
}

impl Staged {
    /// Takes the buffers.
    pub fn new() -> Result<Staged, DriverError> {
        Ok(Staged([Buffer::new()?, Buffer::new()?]))
    }

    /// Copies to the GPU.
    ///
    /// # Safety
    /// There is room for as many bytes at `to`.
    pub unsafe fn write(&mut self, to: u64, bytes: &[u8]) -> Result<(), DriverError> {
        if bytes.len() < SMALL {
            // SAFETY: by contract.
            return unsafe { result::memcpy_htod_sync(to, bytes) };
        }
        for (n, part) in bytes.chunks(BUFFER).enumerate() {
            let buffer = &mut self.0[n % 2];
            let staged = buffer.bytes(part.len())?;
            copy(staged, part);
            // SAFETY: by contract; the buffer is not touched until the event says so.
            unsafe { result::memcpy_htod_async(to + (n * BUFFER) as u64, staged, null_mut()) }?;
            buffer.used()?;
        }
        Ok(())
    }

    /// Copies from the GPU.
    ///
    /// # Safety
    /// There are as many bytes at `from`.
    pub unsafe fn read(&mut self, from: u64, bytes: &mut [u8]) -> Result<(), DriverError> {
        if bytes.len() < SMALL {
            // SAFETY: by contract.
            return unsafe { result::memcpy_dtoh_sync(bytes, from) };
        }
        let sizes: Vec<usize> = bytes.chunks(BUFFER).map(<[u8]>::len).collect();
        for (n, part) in bytes.chunks_mut(BUFFER).enumerate() {
            // Two parts are under way: this one, which was asked for one turn ago, and the next one.
            for ahead in if n == 0 { 0..2 } else { 1..2 } {
                let Some(&len) = sizes.get(n + ahead) else { continue };
                let buffer = &mut self.0[(n + ahead) % 2];
                let staged = buffer.bytes(len)?;
                // SAFETY: by contract.
                unsafe {
                    result::memcpy_dtoh_async(staged, from + ((n + ahead) * BUFFER) as u64, null_mut())
                }?;
                buffer.used()?;
            }
            copy(part, self.0[n % 2].bytes(part.len())?);
        }
        Ok(())
    }
}

impl Drop for Staged {
    fn drop(&mut self) {
        for buffer in &self.0 {
            // SAFETY: both were made by `new`; what fails here has failed before.
            unsafe {
                let _ = event::synchronize(buffer.done);
                let _ = event::destroy(buffer.done);
                let _ = result::free_host(buffer.start.cast());
            }
        }
    }
}
