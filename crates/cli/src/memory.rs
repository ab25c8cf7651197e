//! Large blocks of memory on huge pages.
//!
//! A cloud lies in a few blocks of megabytes that are filled once. On pages of 4 KiB the kernel hands these out one by one, which costs
//! more time than the work of a tool. So on Linux a block of 1 MiB or more begins at a multiple of 2 MiB and asks for
//! huge pages. If there are none it has small ones. Everything else is left to the system's allocator. A block that grows
//! moves its pages: nothing is copied. A freed block is kept for the next one, because the first touch of a page is
//! expensive, above all in a virtual machine. Kept blocks are released before new memory is requested, so no tool ever takes more memory.
#![expect(unsafe_code, reason = "an allocator hands out and takes back raw memory")]

use std::alloc::{GlobalAlloc, Layout, System};

/// From this size on a block has its own pages [B].
#[cfg(target_os = "linux")]
const LARGE: usize = 1 << 20;
/// Size of a huge page [B].
#[cfg(target_os = "linux")]
const PAGE: usize = 2 << 20;
/// Most that is kept of what was given back [B].
#[cfg(target_os = "linux")]
const KEPT: usize = 256 << 20;

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

// SAFETY: the layout alone decides whether a block comes from `System` or is a separate mapping, so it returns to its origin.
unsafe impl GlobalAlloc for Memory {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        match is_large(&layout) {
            true => pages::take(layout.size(), false),
            // SAFETY: the caller's promises are those that `System` wants.
            false => unsafe { System.alloc(layout) },
        }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        match is_large(&layout) {
            true => pages::take(layout.size(), true),
            // SAFETY: as above.
            false => unsafe { System.alloc_zeroed(layout) },
        }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        match is_large(&layout) {
            // SAFETY: `alloc` made it with this size, and it is no longer used.
            true => unsafe { pages::give_back(block, layout.size()) },
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
                // SAFETY: `alloc` mapped it with this size; if it moves, the old address is no longer used.
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
    use super::{KEPT, PAGE};
    use rustix::mm::{Advice, MapFlags, MremapFlags, ProtFlags};
    use rustix::mm::{madvise, mmap_anonymous, mremap, mremap_fixed, munmap};
    use std::ptr::{null_mut, with_exposed_provenance_mut};
    use std::sync::{Mutex, MutexGuard, PoisonError};

    /// Blocks that were given back, as address and size [B].
    pub(super) struct Spare {
        blocks: [(usize, usize); 32],
        count: usize,
        /// All together [B].
        bytes: usize,
    }

    static SPARE: Mutex<Spare> = Mutex::new(Spare::NONE);

    fn spare() -> MutexGuard<'static, Spare> {
        SPARE.lock().unwrap_or_else(PoisonError::into_inner)
    }

    impl Spare {
        /// Nothing is kept.
        pub const NONE: Spare = Spare { blocks: [(0, 0); 32], count: 0, bytes: 0 };

        /// So many bytes of the smallest block that has them; what is left of it stays.
        pub fn take(&mut self, size: usize) -> Option<usize> {
            let fits = (0..self.count).filter(|&k| self.blocks[k].1 >= size);
            let best = fits.min_by_key(|&k| self.blocks[k].1)?;
            let (start, whole) = self.blocks[best];
            self.bytes -= size;
            if whole > size {
                self.blocks[best] = (start + size, whole - size);
            } else {
                self.drop_entry(best);
            }
            Some(start)
        }

        /// Whether a block is kept.
        pub fn keep(&mut self, start: usize, size: usize) -> bool {
            let fits = self.count < self.blocks.len() && self.bytes + size <= KEPT;
            if fits {
                self.blocks[self.count] = (start, size);
                self.count += 1;
                self.bytes += size;
            }
            fits
        }

        /// A block to be unmapped.
        pub fn pop(&mut self) -> Option<(usize, usize)> {
            let last = *self.blocks[..self.count].last()?;
            self.bytes -= last.1;
            self.count -= 1;
            Some(last)
        }

        fn drop_entry(&mut self, k: usize) {
            self.count -= 1;
            self.blocks[k] = self.blocks[self.count];
        }
    }

    /// A block for `size` bytes, zero where that is asked for; null when there is no memory.
    pub fn take(size: usize, zero: bool) -> *mut u8 {
        let all = whole(size);
        let found = spare().take(all);
        if let Some(start) = found {
            let block = with_exposed_provenance_mut::<u8>(start);
            if zero {
                // SAFETY: the block is unused and this long.
                unsafe { block.write_bytes(0, size) };
            }
            return block;
        }
        // What is kept makes room.
        let mut freed = 0;
        while freed < all {
            let Some((start, size)) = spare().pop() else { break };
            freed += size;
            // SAFETY: this block is no longer used.
            unsafe { unmap(with_exposed_provenance_mut(start), size) };
        }
        map(size)
    }

    /// Takes a block back, for the next one or for the system.
    ///
    /// # Safety
    /// [`take`] or [`resize`] made it with this size, and it is no longer used.
    pub unsafe fn give_back(block: *mut u8, size: usize) {
        if !spare().keep(block.expose_provenance(), whole(size)) {
            // SAFETY: promised by the caller.
            unsafe { unmap(block, size) };
        }
    }

    /// Whole pages [B].
    pub fn whole(size: usize) -> usize {
        size.next_multiple_of(PAGE)
    }

    /// A block of zeros on separate pages; null when there is no memory.
    pub fn map(size: usize) -> *mut u8 {
        let size = whole(size);
        // SAFETY: a new mapping; its ends, which are cut off, are unused.
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
    /// [`map`] or this function made it with the size `old`, and the part that is cut off is no longer used.
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
    /// [`map`] made it with this size, and it is no longer used.
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
    pub unsafe fn resize(_: *mut u8, _: usize, _: usize) -> *mut u8 {
        std::ptr::null_mut()
    }
    pub fn take(_: usize, _: bool) -> *mut u8 {
        std::ptr::null_mut()
    }
    pub unsafe fn give_back(_: *mut u8, _: usize) {}
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

    /// What was given back is taken again, the smallest that fits first, and split; no more than a limit is kept.
    #[cfg(target_os = "linux")]
    #[test]
    fn blocks_that_were_given_back_are_taken_again() {
        let mut spare = pages::Spare::NONE;
        assert!(spare.keep(1000 * PAGE, 6 * PAGE) && spare.keep(2000 * PAGE, 3 * PAGE));
        assert_eq!(spare.take(7 * PAGE), None);
        assert_eq!(spare.take(2 * PAGE), Some(2000 * PAGE));
        assert_eq!(spare.take(PAGE), Some(2002 * PAGE));
        assert_eq!(spare.take(2 * PAGE), Some(1000 * PAGE));
        assert_eq!(spare.pop(), Some((1002 * PAGE, 4 * PAGE)));
        assert_eq!((spare.pop(), spare.take(PAGE)), (None, None));
        assert!(spare.keep(0, KEPT) && !spare.keep(KEPT, PAGE));
    }

    /// Zeros are zeros, also where something else was before.
    #[test]
    fn what_is_used_again_is_zero_where_that_is_asked_for() {
        for _ in 0..3 {
            let used = vec![7u8; 46 << 20];
            assert!(used.iter().all(|&byte| byte == 7));
            drop(used);
            assert!(vec![0u8; 46 << 20].iter().all(|&byte| byte == 0));
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
