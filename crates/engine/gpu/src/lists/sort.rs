//! Sorting of a few numbers by one thread.

/// Numbers up to which insertion is faster.
const FEW: usize = 24;

/// Sorts `count` entries by their keys, in place: insertion, or a heap (Williams 1964, DOI 10.1145/512274.512284) where they are many. No two keys are equal.
#[inline(always)]
pub fn sort(count: usize, key: impl Fn(usize) -> u64, mut swap: impl FnMut(usize, usize)) {
    if count <= FEW {
        for k in 1..count {
            let mut at = k;
            while at > 0 && key(at - 1) > key(at) {
                swap(at - 1, at);
                at -= 1;
            }
        }
        return;
    }
    let (mut heaped, mut end) = (count / 2, count);
    while end > 1 {
        // First a heap is made of all, then the largest is taken off again and again.
        if heaped > 0 {
            heaped -= 1;
        } else {
            end -= 1;
            swap(0, end);
        }
        let mut at = heaped;
        loop {
            let mut child = 2 * at + 1;
            if child >= end {
                break;
            }
            if child + 1 < end && key(child + 1) > key(child) {
                child += 1;
            }
            if key(at) >= key(child) {
                break;
            }
            swap(at, child);
            at = child;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec::Vec;
    use core::cell::RefCell;

    #[test]
    fn it_sorts_few_and_many() {
        for count in [0, 1, 2, 3, 7, 24, 25, 26, 100, 1000] {
            let numbers: Vec<u64> = (0..count as u64).map(|k| (k * 7919) % 10_007).collect();
            let sorted = RefCell::new(numbers.clone());
            sort(count, |k| sorted.borrow()[k], |a, b| sorted.borrow_mut().swap(a, b));
            let mut expected = numbers;
            expected.sort_unstable();
            assert_eq!(sorted.into_inner(), expected, "{count}");
        }
    }
}
