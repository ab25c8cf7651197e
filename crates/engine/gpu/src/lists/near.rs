//! The search for what is near: points that are sorted by the keys of their cells.

use crate::tables::Address;
use primitives::{Lattice, Vec3};

/// Points in sorted order.
#[derive(Clone, Copy)]
pub struct Sorted<'a> {
    /// Their cells.
    pub lattice: &'a Lattice,
    /// Key of the cell of each, 8 bytes.
    pub keys: Address,
    /// First point of each cell, and one more; 0 where most cells are empty: it is found by bisection.
    pub starts: Address,
    /// How many cells have a first point.
    pub cells: usize,
    /// How many.
    pub count: usize,
}

impl Sorted<'_> {
    /// # Safety
    /// The table is there, and has that row.
    #[inline(always)]
    unsafe fn key(&self, k: usize) -> u64 {
        // SAFETY: by contract.
        unsafe { *self.keys.at(k) }
    }

    /// The first point whose key is no less.
    ///
    /// # Safety
    /// The table is in place, and there is such a cell, or one less.
    #[inline(always)]
    unsafe fn first(&self, key: u64) -> usize {
        if self.starts == Address::default() || key > self.cells as u64 {
            // SAFETY: by contract.
            return unsafe { self.bisect(key) };
        }
        // SAFETY: by contract. No point is beyond the last, whatever the table says.
        unsafe { (*self.starts.at::<u32>(key as usize) as usize).min(self.count) }
    }

    /// The same by bisection.
    ///
    /// # Safety
    /// The table is in place.
    #[inline(always)]
    pub unsafe fn bisect(&self, key: u64) -> usize {
        let (mut low, mut high) = (0, self.count);
        while low < high {
            let middle = low + (high - low) / 2;
            // SAFETY: by contract.
            if unsafe { self.key(middle) } < key {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        low
    }

    /// Calls `each` with all points from number `from` on that may lie within `radius` [m] of a place, in sorted order where cells have no blocks. A ball
    /// over more rows of cells than there are points takes them all, as in [`primitives::Grid::runs_near`].
    ///
    /// # Safety
    /// The table is in place.
    #[inline(always)]
    pub unsafe fn near(&self, centre: &Vec3, radius: f64, from: usize, each: impl FnMut(usize)) {
        let [lo, hi] = self.lattice.around(centre, radius);
        let rows = [1, 2].map(|a| (hi[a] - lo[a] + 1).max(0) as f64);
        if rows[0] * rows[1] > self.count as f64 {
            return (from..self.count).for_each(each);
        }
        // SAFETY: by contract.
        unsafe { self.in_cells([lo, hi], from, each) }
    }

    /// Calls `each` with all points from number `from` on in the cells between a lowest and a highest one.
    ///
    /// # Safety
    /// The table is in place.
    #[inline(always)]
    pub unsafe fn in_cells(&self, [lo, hi]: [[i64; 3]; 2], from: usize, mut each: impl FnMut(usize)) {
        if from >= self.count {
            return;
        }
        // SAFETY: by contract; places stay below the count.
        unsafe {
            let least = self.key(from);
            for z in lo[2]..hi[2] + 1 {
                for y in lo[1]..hi[1] + 1 {
                    for (first, cells) in self.lattice.row(lo[0]..hi[0] + 1, y, z) {
                        if first + cells > least {
                            (self.first(first).max(from)..self.first(first + cells)).for_each(&mut each);
                        }
                    }
                }
            }
        }
    }
}
