//! Large blocks of memory on huge pages.
//!
//! A cloud lies in a few blocks of megabytes that are filled once. On pages of 4 KiB the kernel hands these out one by one, and that costs
//! more time than a tool's own work. On Linux a block of 1 MiB and more therefore begins at a multiple of 2 MiB and asks for
//! huge pages; where there are none it has small ones, and everything else is as the system's allocator does it. A block that grows
//! takes its pages along: nothing is copied.
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
            (true, true) => {
                // SAFETY: `alloc` mapped it with this size; where it moves, nobody uses the old place any more.
                let resized = unsafe { pages::resize(block, layout.size(), size) };
                if !resized.is_null() {
                    return resized;
                }
            }
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
    use rustix::mm::{Advice, MapFlags, MremapFlags, ProtFlags};
    use rustix::mm::{madvise, mmap_anonymous, mremap, mremap_fixed, munmap};
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

    /// The block with another size, where it is or moved with its pages to another multiple of 2 MiB; null, and the block as it
    /// was, when that cannot be.
    ///
    /// # Safety
    /// [`map`] or this made it with the size `old`, and nobody uses what is no more.
    pub unsafe fn resize(block: *mut u8, old: usize, new: usize) -> *mut u8 {
        // SAFETY: the block is a mapping of the caller's alone, and so is the room it moves to.
        unsafe {
            if let Ok(same) = mremap(block.cast(), whole(old), whole(new), MremapFlags::empty()) {
                return same.cast();
            }
            let room = map(new);
            if room.is_null() {
                return room;
            }
            match mremap_fixed(block.cast(), whole(old), whole(new), MremapFlags::MAYMOVE, room.cast()) {
                Ok(moved) => moved.cast(),
                Err(_) => {
                    unmap(room, new);
                    null_mut()
                }
            }
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
    pub unsafe fn resize(_: *mut u8, _: usize, _: usize) -> *mut u8 {
        std::ptr::null_mut()
    }
    pub unsafe fn unmap(_: *mut u8, _: usize) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blocks that grow among each other, across the bound between small and large ones, and shrink again.
    #[test]
    fn what_grows_and_shrinks_keeps_its_content() {
        let numbers = |count: usize| (0..count as u64).map(|k| k.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let mut blocks = vec![Vec::new(); 3];
        for value in numbers(1_500_000) {
            blocks.iter_mut().for_each(|block| block.push(value));
        }
        for count in [1_500_000, 400_000, 200_000, 100_000, 10] {
            for block in &mut blocks {
                block.truncate(count);
                block.shrink_to_fit();
                let large = 8 * block.capacity() >= 1 << 20;
                assert!(
                    !cfg!(target_os = "linux") || !large || block.as_ptr().addr().is_multiple_of(2 << 20)
                );
                assert!(block.iter().copied().eq(numbers(count)));
            }
        }
    }

    /// A block moves with what is in it, and its new end is zero.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_block_moves_with_its_content() {
        let (old, new) = (3 << 20, 9 << 20);
        // SAFETY: the block is this test's alone, and used only within its size.
        unsafe {
            let block = pages::map(old);
            // Whatever comes next stands in the way of the one before it.
            let other = pages::map(old);
            for at in 0..old {
                block.add(at).write(at as u8);
            }
            let resized = pages::resize(block, old, new);
            assert!(!resized.is_null() && resized.addr().is_multiple_of(PAGE));
            assert!((0..old).all(|at| resized.add(at).read() == at as u8));
            assert!((pages::whole(old)..new).all(|at| resized.add(at).read() == 0));
            pages::unmap(resized, new);
            pages::unmap(other, old);
        }
    }
}
