//! Steps on a device, a GPU for instance, over the same State: forces and the move there, everything else here.
//!
//! ```text
//! send → lists there → steps there, until a particle leaves its margin → lists there → … → fetch, when something is due here
//! ```
//!
//! The device runs the engine's own functions ([`gpu::threads`]), so its bits are those of a processor; its lists ([`gpu::lists`])
//! are those that a processor makes, slot by slot. What it cannot compute is refused
//! before anything starts ([`refused`]). Observing, and the step after it, are done here.

mod carried;
mod contacts;
mod kinds;
mod lister;
mod local;
mod meshes;
mod refused;
mod sorter;
mod stepper;
mod tables;
#[cfg(test)]
mod tests;
mod work;

pub(crate) use carried::{Before, Course, next_entry};
pub use local::Local;
pub(crate) use refused::refused;
pub use stepper::DeviceTimes;
pub(crate) use stepper::{Found, LAUNCHED, Stepper};

use gpu::compositions::NAMES;
use gpu::lists::LIST_FUNCTIONS;
use gpu::tables::{Address, DeviceTables};

/// Functions of a step besides contacts, after the compositions: which points of triangles are contacts; which contacts have been made; what begins to move; the moves without
/// and with rotation, and these where something slows particles besides contacts; what is in zones.
const STEPS: [&str; 8] =
    ["triangles", "made", "started", "centres", "spheres", "slowed_centres", "slowed_spheres", "carried"];
/// Number of the first of them.
const TRIANGLES: usize = NAMES.len();
/// Number of the second.
const MADE: usize = TRIANGLES + 1;
/// Number of the third.
const STARTED: usize = MADE + 1;
/// Number of the move without rotation; the next is that with it.
const MOVES: usize = STARTED + 1;
/// Number of the last of them.
const CARRIED: usize = MOVES + 4;
/// Number of the first function that makes lists.
const LISTS: usize = CARRIED + 1;

/// Functions that a device must have, by number: the compositions, the others of a step, and what makes lists.
pub fn functions() -> Vec<&'static str> {
    NAMES.iter().copied().chain(STEPS).chain(LIST_FUNCTIONS.iter().copied()).collect()
}

/// Something that runs the threads of a step.
pub trait Device: Send {
    /// What it is, for people.
    fn name(&self) -> String;
    /// Takes memory: so many bytes, all 0.
    ///
    /// # Errors
    /// There is no more.
    fn allocate(&mut self, bytes: usize) -> Result<Address, DeviceError>;
    /// Sets so many bytes to 0, after everything that was launched.
    ///
    /// # Errors
    /// The device has failed.
    fn clear(&mut self, at: Address, bytes: usize) -> Result<(), DeviceError>;
    /// Gives memory back.
    ///
    /// # Errors
    /// The device has failed.
    fn release(&mut self, at: Address) -> Result<(), DeviceError>;
    /// Copies to the device.
    ///
    /// # Errors
    /// The device has failed.
    fn write(&mut self, to: Address, bytes: &[u8]) -> Result<(), DeviceError>;
    /// Copies from the device, after everything that was launched.
    ///
    /// # Errors
    /// The device has failed, now or since the last call.
    fn read(&mut self, from: Address, bytes: &mut [u8]) -> Result<(), DeviceError>;
    /// Runs so many threads of a function of [`functions`], after everything that was launched.
    ///
    /// # Errors
    /// The device has failed.
    fn launch(
        &mut self,
        function: usize,
        threads: usize,
        tables: &DeviceTables,
        step: u32,
    ) -> Result<(), DeviceError>;
}

/// Why a device failed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DeviceError {
    /// Its memory is full.
    #[error("{device}: {bytes} bytes more do not fit into its memory")]
    Memory {
        /// Its name.
        device: String,
        /// What was asked for.
        bytes: usize,
    },
    /// What its driver says.
    #[error("{device}: {what}")]
    Failed {
        /// Its name.
        device: String,
        /// What went wrong.
        what: String,
    },
}
