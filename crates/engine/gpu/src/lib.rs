//! What each thread of a GPU does, and the tables that it reads and writes.
//!
//! Threads call the functions of [`laws`] that a processor calls, so that both give the same bits. `crates/engine/cuda/kernels` compiles
//! them for GPUs; `dem::device` sends the tables and says which function runs when.
//!
//! ```text
//! tables        what lies in the memory of the device
//! compositions  the compositions of effects, by number
//! threads       a contact
//! moves         a particle, in zones and free
//! triangles     which points of triangles are contacts of a particle
//! lists         neighbour lists: cells, pairs, slots
//! ```

#![deny(missing_docs)]
#![no_std]

extern crate alloc;
#[cfg(test)]
extern crate std;

pub mod compositions;
pub mod lists;
pub mod moves;
pub mod tables;
pub mod threads;
pub mod triangles;

// The macros name effects by it.
#[doc(hidden)]
pub use laws;
