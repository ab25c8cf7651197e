//! Neighbour lists as threads of a device make them: the lists of `dem::neighbours`, slot by slot.
//!
//! ```text
//! particles  wrapped, with their margins → their box → keys of their cells → sorted by key → all columns in that order
//! pairs      counted by particle and class → where those of each class begin → written → sorted
//! contacts   blocks, the contacts of each particle, their histories from the lists before, points of walls
//! ```
//!
//! A class is what a tile lists one after the other: a kind of contact, between particles by where the second is and whether they touch.
//! Where threads add to one counter, which of them comes first is undone by sorting, so that no bit depends on it.
#![expect(unsafe_code, reason = "threads share tables, of which each writes its own rows only, or counters")]

mod carry;
mod contacts;
mod near;
mod pairs;
mod particles;
mod scan;
mod sort;

pub use carry::*;
pub use contacts::*;
pub use pairs::*;
pub use particles::*;
pub use scan::*;

use crate::tables::Address;
use core::sync::atomic::{AtomicU32, Ordering};

/// The functions that make lists, by name: given to the macro that is named.
#[macro_export]
macro_rules! lists {
    ($then:ident) => {
        $then! {
            margins boxes fold count_reach near_reach keys digits spread permute cell_starts spots
            scan_sums scan_down common_pairs wide_pairs image_pairs wall_parts class_starts
            clear_slots blocks sort_class contacts_of sort_contacts_of triangles_of rows_now carry points
        }
    };
}

macro_rules! names {
    ($($name:ident)*) => {
        /// Their names.
        pub const LIST_FUNCTIONS: &[&str] = &[$(stringify!($name)),*];
    };
}
lists!(names);

/// Counts: what the launch of a function that both counts and writes is to do.
pub const COUNT: u32 = 0;
/// Writes what was counted.
pub const WRITE: u32 = 1;

/// Adds to a counter that other threads add to as well; what it was.
///
/// # Safety
/// It is there, and only added to meanwhile.
#[inline(always)]
unsafe fn add(counter: *mut u32, by: u32) -> u32 {
    // SAFETY: by contract.
    unsafe { AtomicU32::from_ptr(counter).fetch_add(by, Ordering::Relaxed) }
}

/// The run of row `k` in a table of where runs begin.
///
/// # Safety
/// The table has that row and one more.
#[inline(always)]
pub(crate) unsafe fn run(starts: Address, k: usize) -> core::ops::Range<usize> {
    // SAFETY: by contract.
    unsafe { *starts.at::<u32>(k) as usize..*starts.at::<u32>(k + 1) as usize }
}
