//! Entry points of the threads of a GPU: the engine's own functions, compiled for it.

#![no_std]
#![feature(abi_ptx, stdarch_nvptx)]

use core::arch::nvptx::{_block_dim_x, _block_idx_x, _thread_idx_x};
use gpu::tables::DeviceTables;
use gpu::lists;
use gpu::moves::{carried, particle, started};
use gpu::threads::contact;

#[inline(always)]
fn thread() -> usize {
    // SAFETY: registers that every thread has.
    let [block, size, within] = unsafe { [_block_idx_x(), _block_dim_x(), _thread_idx_x()] };
    block as usize * size as usize + within as usize
}

macro_rules! entries {
    (@ $number:expr; [$first:ident $($part:ident)*] $effects:ty; $($rest:tt)*) => {
        const _: () = {
            /// The contacts of one composition.
            ///
            /// # Safety
            /// As [`contact`] says; the processor that launches it sees to it.
            #[unsafe(export_name = concat!("contacts_", stringify!($first) $(, "_", stringify!($part))*))]
            pub unsafe extern "ptx-kernel" fn entry(tables: DeviceTables, step: u32) {
                // SAFETY: by contract.
                unsafe { contact::<$effects>(&tables, $number, step, thread()) }
            }
        };
        entries!(@ $number + 1; $($rest)*);
    };
    (@ $number:expr;) => {};
    ($($all:tt)*) => { entries!(@ 0; $($all)*); };
}
gpu::laws::compositions!(entries);

/// Which points of triangles are contacts.
///
/// # Safety
/// As [`gpu::triangles::triangles`] says.
#[unsafe(no_mangle)]
pub unsafe extern "ptx-kernel" fn triangles(tables: DeviceTables, step: u32) {
    // SAFETY: by contract.
    unsafe { gpu::triangles::triangles(&tables, step, thread()) }
}

/// Which contacts have been made.
///
/// # Safety
/// As [`gpu::threads::made`] says.
#[unsafe(no_mangle)]
pub unsafe extern "ptx-kernel" fn made(tables: DeviceTables, step: u32) {
    // SAFETY: by contract.
    unsafe { gpu::threads::made(&tables, step, thread()) }
}

macro_rules! moves {
    ($($name:ident: $rotates:literal, $slowed:literal;)*) => { $(
        /// Sums and moves, with or without rotation, and what slows particles besides contacts.
        ///
        /// # Safety
        /// As [`particle`] says.
        #[unsafe(no_mangle)]
        pub unsafe extern "ptx-kernel" fn $name(tables: DeviceTables, step: u32) {
            // SAFETY: by contract.
            unsafe { particle::<$rotates, $slowed>(&tables, step, thread()) }
        }
    )* };
}
moves! {
    centres: false, false;
    spheres: true, false;
    slowed_centres: false, true;
    slowed_spheres: true, true;
}

/// Begins to move what has left a zone.
///
/// # Safety
/// As [`started`] says.
#[unsafe(export_name = "started")]
pub unsafe extern "ptx-kernel" fn started_entry(tables: DeviceTables, step: u32) {
    // SAFETY: by contract.
    unsafe { started(&tables, step, thread()) }
}

/// Moves what is in a zone.
///
/// # Safety
/// As [`carried`] says.
#[unsafe(export_name = "carried")]
pub unsafe extern "ptx-kernel" fn carried_entry(tables: DeviceTables, step: u32) {
    // SAFETY: by contract.
    unsafe { carried(&tables, step, thread()) }
}

macro_rules! list_entries {
    ($($name:ident)*) => { $(
        /// One of the functions that make lists.
        ///
        /// # Safety
        /// As that says.
        #[unsafe(no_mangle)]
        pub unsafe extern "ptx-kernel" fn $name(tables: DeviceTables, mode: u32) {
            // SAFETY: by contract.
            unsafe { lists::$name(&tables, mode, thread()) }
        }
    )* };
}
gpu::lists!(list_entries);
