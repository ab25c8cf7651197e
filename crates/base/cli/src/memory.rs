//! Too little memory ends a tool with one line and exit code 1, whichever part of it asked for more.
//!
//! The standard library aborts instead, which looks like a crash of the tool. How much an input needs is often known only when it is read: a picture of 2 MB
//! may have 900 million pixels.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::io::Write;
use std::ptr::null_mut;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
use std::time::Duration;

/// The system's allocator, whose failures end the tool.
struct EndsTheTool;

#[global_allocator]
static ALLOCATOR: EndsTheTool = EndsTheTool;

/// Whether the tool is ending, and whether this thread ends it.
static ENDING: AtomicBool = AtomicBool::new(false);
thread_local!(static MINE: Cell<bool> = const { Cell::new(false) });

/// Returns the pointer; ends the tool if the allocation of so many bytes failed.
fn given(pointer: *mut u8, bytes: usize) -> *mut u8 {
    if pointer.is_null() { end(bytes) } else { pointer }
}

/// Prints how many bytes were missing, without an allocation, and ends the process.
#[cold]
pub(crate) fn end(bytes: usize) -> *mut u8 {
    if ENDING.swap(true, SeqCst) {
        if MINE.get() {
            return null_mut();
        }
        loop {
            std::thread::sleep(Duration::from_secs(1));
        }
    }
    MINE.set(true);
    let (mut line, mib) = ([0; 256], (bytes >> 20).max(1));
    let mut left = &mut line[..];
    let tool = crate::invocation::tool();
    // A buffer on the stack that is long enough.
    let _ = writeln!(
        left,
        "{tool}: out of memory: {mib} MiB more were asked for: give it more memory (ulimit -v, the limit of the batch job), or a smaller input"
    );
    let length = 256 - left.len();
    let _ = std::io::stderr().write_all(&line[..length]);
    // The names of files are short: a small allocation succeeds where a large one failed.
    crate::signals::remove_unfinished();
    std::process::exit(i32::from(crate::exit::FAILED))
}

#[expect(unsafe_code, reason = "an allocator is unsafe by its trait")]
// SAFETY: every call is passed on to the allocator of the system as it is, and its pointer is returned as it is; `end` returns null, which is allowed, or not at all.
unsafe impl GlobalAlloc for EndsTheTool {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promises are those that the system's allocator asks for.
        given(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        given(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above.
        given(unsafe { System.realloc(pointer, layout, size) }, size)
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }
}
