//! Running sums: each number becomes the sum of those before it.
//!
//! The sum of each part, then the running sums of these (by the same functions), then those within each part: Blelloch (1990), CMU-CS-90-190.

use crate::tables::DeviceTables;
use crate::tables::lists::SUMMED;

/// Numbers that are read at once: as many as divide a part.
const AT_ONCE: usize = 8;
const _: () = assert!(SUMMED.is_multiple_of(AT_ONCE));

/// Sum of a part.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn scan_sums(t: &DeviceTables, _: u32, part: usize) {
    let l = &t.lists;
    let (from, end) = (part * SUMMED, l.summed_count as usize);
    if from >= end {
        return;
    }
    // SAFETY: by contract.
    unsafe {
        let mut sum = 0_u32;
        for k in from..end.min(from + SUMMED) {
            sum += *l.summed.at::<u32>(k);
        }
        *l.sums.at(part) = sum;
    }
}

/// Running sums in a part, from the running sum of its part on; from 0 where there is one part.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn scan_down(t: &DeviceTables, _: u32, part: usize) {
    let l = &t.lists;
    let (from, end) = (part * SUMMED, l.summed_count as usize);
    if from >= end {
        return;
    }
    // SAFETY: by contract.
    unsafe {
        let mut sum: u32 = if end > SUMMED { *l.sums.at(part) } else { 0 };
        for first in (from..end.min(from + SUMMED)).step_by(AT_ONCE) {
            // Some are read before any of them is written, so that no read waits for a write.
            let mut numbers = [0_u32; AT_ONCE];
            for (k, number) in numbers.iter_mut().enumerate() {
                if first + k < end {
                    *number = *l.summed.at(first + k);
                }
            }
            for (k, number) in numbers.into_iter().enumerate() {
                if first + k < end {
                    *l.summed.at(first + k) = sum;
                }
                sum += number;
            }
        }
    }
}
