//! A GPU by the CUDA driver, which is loaded when it is asked for: nothing of CUDA is needed to build.
//!
//! `kernels.ptx` holds what it runs: the engine's own functions ([`gpu::threads`]), compiled for GPUs by `make -C crates/engine/cuda/kernels`. Its
//! arithmetic rounds as IEEE 754 says, and no multiply-add is fused, so its bits are those of a processor.
#![expect(unsafe_code, reason = "the driver is a C library")]

mod staged;

use cudarc::driver::result::{self, DriverError};
use cudarc::driver::sys::{self, CUcontext, CUdevice, CUfunction, CUmodule};
use dem::device::{Device, DeviceError, functions};
use gpu::tables::{Address, DeviceTables};
use staged::Staged;
use std::ffi::{CString, c_void};
use std::ptr::null_mut;

/// What a GPU runs.
pub const PTX: &str = include_str!("../kernels.ptx");

/// Threads of a block: few enough that registers are left for many blocks.
const BLOCK: usize = 64;

/// Why there is no GPU to compute with.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CudaError {
    /// The driver is not installed.
    #[error("there is no CUDA driver here (libcuda)")]
    NoDriver,
    /// No GPU of this number.
    #[error("there is no GPU {0} here: they are numbered from 0, and there are {1}")]
    NoGpu(usize, usize),
    /// What the driver says.
    #[error("GPU {0}: {1}")]
    Driver(usize, String),
}

pub struct Gpu {
    device: CUdevice,
    context: CUcontext,
    module: CUmodule,
    functions: Vec<CUfunction>,
    staged: Option<Staged>,
    name: String,
}

// SAFETY: its handles belong to the process; each call makes the context that of its thread.
unsafe impl Send for Gpu {}

fn text(error: DriverError) -> String {
    // SAFETY: the driver has been loaded: it made the error.
    let known = error.error_string().ok().map(|text| text.to_string_lossy().into_owned());
    known.unwrap_or_else(|| format!("error {}", error.0 as u32))
}

impl Gpu {
    /// GPU number `number`, ready to compute.
    ///
    /// # Errors
    /// No driver, no such GPU, or one that does not take the program.
    pub fn new(number: usize) -> Result<Gpu, CudaError> {
        // SAFETY: it asks whether a library can be loaded.
        if !unsafe { sys::is_culib_present() } {
            return Err(CudaError::NoDriver);
        }
        let failed = |error| CudaError::Driver(number, text(error));
        result::init().map_err(failed)?;
        let count = usize::try_from(result::device::get_count().map_err(failed)?).unwrap_or(0);
        if number >= count {
            return Err(CudaError::NoGpu(number, count));
        }
        let device = result::device::get(i32::try_from(number).unwrap_or(i32::MAX)).map_err(failed)?;
        let name = result::device::get_name(device).map_err(failed)?;
        // SAFETY: the device is there; its context is released when this is dropped.
        let context = unsafe { result::primary_ctx::retain(device) }.map_err(failed)?;
        let mut gpu = Gpu { device, context, module: null_mut(), functions: Vec::new(), staged: None, name };
        gpu.load().map_err(failed)?;
        Ok(gpu)
    }

    /// Compiles the program for this GPU.
    fn load(&mut self) -> Result<(), DriverError> {
        self.current()?;
        self.staged = Some(Staged::new()?);
        let text = CString::new(PTX).unwrap_or_default();
        // SAFETY: the text ends with a zero.
        self.module = unsafe { result::module::load_data(text.as_ptr().cast()) }?;
        for name in functions() {
            let name = CString::new(name).unwrap_or_default();
            // SAFETY: the module has just been loaded.
            self.functions.push(unsafe { result::module::get_function(self.module, name) }?);
        }
        Ok(())
    }

    /// Makes its context that of this thread.
    fn current(&self) -> Result<(), DriverError> {
        // SAFETY: the context is retained.
        unsafe { result::ctx::set_current(self.context) }
    }

    fn failed(&self, error: DriverError) -> DeviceError {
        DeviceError::Failed { device: self.name.clone(), what: text(error) }
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        // What fails here has failed before.
        let _ = self.current();
        self.staged = None;
        // SAFETY: both were made by `new`, and nothing uses them any more.
        unsafe {
            if !self.module.is_null() {
                let _ = result::module::unload(self.module);
            }
            let _ = result::primary_ctx::release(self.device);
        }
    }
}

impl Device for Gpu {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn allocate(&mut self, bytes: usize) -> Result<Address, DeviceError> {
        self.current().map_err(|e| self.failed(e))?;
        let full = |error: DriverError| match error.0 {
            sys::CUresult::CUDA_ERROR_OUT_OF_MEMORY => {
                DeviceError::Memory { device: self.name.clone(), bytes }
            }
            _ => self.failed(error),
        };
        // SAFETY: memory that is new, of the size that is cleared.
        let at = unsafe {
            let at = result::malloc_sync(bytes.max(1)).map_err(full)?;
            result::memset_d8_sync(at, 0, bytes.max(1)).map_err(|e| self.failed(e))?;
            at
        };
        Ok(Address(at))
    }

    fn clear(&mut self, at: Address, bytes: usize) -> Result<(), DeviceError> {
        self.current().map_err(|e| self.failed(e))?;
        // SAFETY: the caller has allocated as much.
        unsafe { result::memset_d8_async(at.0, 0, bytes, null_mut()) }.map_err(|e| self.failed(e))
    }

    fn release(&mut self, at: Address) -> Result<(), DeviceError> {
        self.current().map_err(|e| self.failed(e))?;
        // SAFETY: the caller got it from `allocate`, and gives it back once.
        unsafe { result::free_sync(at.0) }.map_err(|e| self.failed(e))
    }

    fn write(&mut self, to: Address, bytes: &[u8]) -> Result<(), DeviceError> {
        self.current().map_err(|e| self.failed(e))?;
        // SAFETY: the caller has allocated as much.
        let copied = self.staged.as_mut().map_or(Ok(()), |staged| unsafe { staged.write(to.0, bytes) });
        copied.map_err(|e| self.failed(e))
    }

    fn read(&mut self, from: Address, bytes: &mut [u8]) -> Result<(), DeviceError> {
        self.current().map_err(|e| self.failed(e))?;
        // SAFETY: the caller has allocated as much.
        let copied = self.staged.as_mut().map_or(Ok(()), |staged| unsafe { staged.read(from.0, bytes) });
        copied.map_err(|e| self.failed(e))
    }

    fn launch(
        &mut self,
        function: usize,
        threads: usize,
        tables: &DeviceTables,
        step: u32,
    ) -> Result<(), DeviceError> {
        if threads == 0 {
            return Ok(());
        }
        let (mut tables, mut step) = (*tables, step);
        let mut arguments: [*mut c_void; 2] = [(&raw mut tables).cast(), (&raw mut step).cast()];
        let blocks = u32::try_from(threads.div_ceil(BLOCK)).unwrap_or(u32::MAX);
        let Some(&function) = self.functions.get(function) else {
            let what = format!("it has no function {function}");
            return Err(DeviceError::Failed { device: self.name.clone(), what });
        };
        // SAFETY: arguments are those of the functions, and copied by the call; tables are in the memory of this GPU.
        unsafe {
            let size = (BLOCK as u32, 1, 1);
            result::launch_kernel(function, (blocks, 1, 1), size, 0, null_mut(), &mut arguments)
        }
        .map_err(|e| self.failed(e))
    }
}

#[cfg(test)]
mod tests;
