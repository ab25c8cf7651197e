//! Large blocks of memory on huge pages.
//!
//! A cloud lies in a few blocks of megabytes that are filled once. On pages of 4 KiB the kernel hands these out one by one, and that costs
//! more time than a tool's own work. On Linux a block of 1 MiB and more therefore begins at a multiple of 2 MiB and asks for
//! huge pages; where there are none it has small ones, and everything else is as the system's allocator does it.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};

/// From this size on a block has its own pages [B].
#[cfg(target_os = "linux")]
const LARGE: usize = 1 << 20;
/// Size of a huge page [B].
#[cfg(target_os = "linux")]
const PAGE: usize = 2 << 20;

/// The allocator of every tool.
struct Memory;

#[global_allocator]
static MEMORY: Memory = Memory;

#[cfg(target_os = "linux")]
fn is_large(layout: &Layout) -> bool {
    layout.size() >= LARGE && layout.align() <= PAGE && layout.size() <= isize::MAX as usize - 2 * PAGE
}

#[cfg(not(target_os = "linux"))]
fn is_large(_: &Layout) -> bool {
    false
}

// SAFETY: a block comes from `System`, or is a mapping of its own, by its layout alone; so it is given back to where it came from.
unsafe impl GlobalAlloc for Memory {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        match is_large(&layout) {
            true => pages::map(layout.size()),
            // SAFETY: the caller's promises are those that `System` wants.
            false => unsafe { System.alloc(layout) },
        }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        match is_large(&layout) {
            // New pages are zero.
            true => pages::map(layout.size()),
            // SAFETY: as above.
            false => unsafe { System.alloc_zeroed(layout) },
        }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        match is_large(&layout) {
            // SAFETY: `alloc` mapped it with this size.
            true => unsafe { pages::unmap(block, layout.size()) },
            // SAFETY: as above.
            false => unsafe { System.dealloc(block, layout) },
        }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: the caller promises that the size fits the alignment.
        let new = unsafe { Layout::from_size_align_unchecked(size, layout.align()) };
        match (is_large(&layout), is_large(&new)) {
            // SAFETY: as above.
            (false, false) => return unsafe { System.realloc(block, layout, size) },
            (true, true) if pages::whole(layout.size()) == pages::whole(size) => return block,
            _ => {}
        }
        // SAFETY: the new block is another one, and both are as long as what is copied.
        unsafe {
            let moved = self.alloc(new);
            if !moved.is_null() {
                moved.copy_from_nonoverlapping(block, layout.size().min(size));
                self.dealloc(block, layout);
            }
            moved
        }
    }
}

#[cfg(target_os = "linux")]
mod pages {
    use super::PAGE;
    use rustix::mm::{Advice, MapFlags, ProtFlags, madvise, mmap_anonymous, munmap};
    use std::ptr::null_mut;

    /// Whole pages [B].
    pub fn whole(size: usize) -> usize {
        size.next_multiple_of(PAGE)
    }

    /// A block of zeros on pages of its own; null when there is no memory.
    pub fn map(size: usize) -> *mut u8 {
        let size = whole(size);
        // SAFETY: a new mapping, of which the ends that are cut off are nobody's.
        unsafe {
            let flags = (ProtFlags::READ | ProtFlags::WRITE, MapFlags::PRIVATE);
            let Ok(start) = mmap_anonymous(null_mut(), size + PAGE, flags.0, flags.1) else {
                return null_mut();
            };
            let before = (start as usize).wrapping_neg() % PAGE;
            let block = start.byte_add(before);
            if before > 0 {
                let _ = munmap(start, before);
            }
            let _ = munmap(block.byte_add(size), PAGE - before);
            // Without huge pages it works all the same.
            let _ = madvise(block, size, Advice::LinuxHugepage);
            block.cast()
        }
    }

    /// Gives a block back.
    ///
    /// # Safety
    /// [`map`] made it with this size, and nobody uses it any more.
    pub unsafe fn unmap(block: *mut u8, size: usize) {
        // SAFETY: promised by the caller.
        let _ = unsafe { munmap(block.cast(), whole(size)) };
    }
}

#[cfg(not(target_os = "linux"))]
mod pages {
    pub fn whole(size: usize) -> usize {
        size
    }
    pub fn map(_: usize) -> *mut u8 {
        std::ptr::null_mut()
    }
    pub unsafe fn unmap(_: *mut u8, _: usize) {}
}
