//! Contact laws, the contact loop and the move of particles: one source for every width of lanes, and for GPUs.
//!
//! SI units throughout. Signs: the unit normal n of a contact points from j to i, an overlap δ > 0 is contact, repulsion is positive.
//!
//! ```text
//! float, simd   numbers and lanes
//! space         periods and images, margins, spheres
//! effects       what a contact does: one file an effect, which describes itself
//! contact       the contact loop: gather → geometry → effects → scatter; sums in fixed order; the move
//! slowing       a fluid and local damping, behind the move
//! ```

#![deny(missing_docs)]
#![no_std]
#![cfg_attr(target_arch = "nvptx64", feature(core_intrinsics), expect(internal_features))]

extern crate alloc;
#[cfg(not(target_arch = "nvptx64"))]
extern crate std;

pub mod contact;
pub mod effects;
pub mod float;
pub mod simd;
pub mod slowing;
pub mod space;
