//! Work shared out to threads; no result depends on how.

use rayon::prelude::*;

/// Particles below which one thread is faster than several.
pub(crate) const FEW: usize = 2048;

/// Does something with all items, on all threads where there are many: one item at a time, so that all end together.
pub(crate) fn share<T: Send, R: Send>(
    many: bool,
    items: Vec<T>,
    run: impl Fn(T) -> R + Sync + Send,
) -> Vec<R> {
    if many {
        items.into_par_iter().with_max_len(1).map(run).collect()
    } else {
        items.into_iter().map(run).collect()
    }
}

/// Numbers of a column below which one thread is faster than several.
const SHORT: usize = 8192;

/// `of` of 0, 1, 2 … up to `count`, in this order.
pub(crate) fn each<R: Send>(count: usize, of: impl Fn(usize) -> R + Sync + Send) -> Vec<R> {
    let mut column = Vec::new();
    refill(&mut column, count, of);
    column
}

/// The same into a column, in the memory that it has: new memory costs more than what is computed.
pub(crate) fn refill<R: Send>(column: &mut Vec<R>, count: usize, of: impl Fn(usize) -> R + Sync + Send) {
    column.clear();
    if count < SHORT {
        column.extend((0..count).map(of));
    } else {
        (0..count).into_par_iter().with_min_len(SHORT / 4).map(of).collect_into_vec(column);
    }
}

/// Changes all entries of a column, each by itself.
pub(crate) fn change<T: Send>(column: &mut [T], by: impl Fn(usize, &mut T) + Sync + Send) {
    if column.len() < SHORT {
        return column.iter_mut().enumerate().for_each(|(k, entry)| by(k, entry));
    }
    column.par_iter_mut().with_min_len(SHORT / 4).enumerate().for_each(|(k, entry)| by(k, entry));
}

/// Sorts items of which no two are equal.
pub(crate) fn sort<T: Ord + Send>(items: &mut [T]) {
    items.par_sort_unstable();
}

/// The number at place `at` of those `numbers`, if they were sorted. All threads count how many lie in each of some intervals, and only those in the
/// interval of this place are sorted.
pub(crate) fn nth(numbers: &[f64], at: usize) -> f64 {
    let none = || (f64::INFINITY, f64::NEG_INFINITY);
    let (least, most) = numbers
        .par_iter()
        .fold(none, |(low, high), &x| (low.min(x), high.max(x)))
        .reduce(none, |a, b| (a.0.min(b.0), a.1.max(b.1)));
    let per_number = INTERVALS as f64 / (most - least);
    // As the numbers rise, so does what is rounded here; NaN counts as 0.
    let interval = |x: f64| (((x - least) * per_number) as usize).min(INTERVALS - 1);
    let counted = numbers.par_chunks(SHORT).map(|part| {
        let mut counts = [0_usize; INTERVALS];
        part.iter().for_each(|&x| counts[interval(x)] += 1);
        counts
    });
    let sum = |mut a: [usize; INTERVALS], b: [usize; INTERVALS]| {
        a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
        a
    };
    let counts = counted.reduce(|| [0; INTERVALS], sum);
    let (mut before, mut of) = (0, 0);
    while before + counts[of] <= at {
        before += counts[of];
        of += 1;
    }
    let mut near: Vec<f64> = numbers.par_iter().copied().filter(|&x| interval(x) == of).collect();
    *near.select_nth_unstable_by(at - before, f64::total_cmp).1
}

/// Intervals that [`nth`] counts in.
const INTERVALS: usize = 256;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nth_number_is_that_of_a_sorted_list() {
        let mixed: Vec<f64> =
            (0..20_000_u64).map(|k| ((k * 7919) % 1009) as f64 * 1e-5 + (k % 3) as f64).collect();
        for numbers in
            [mixed, vec![0.25; 9000], vec![3.0], (0..300).map(|k| 1e300 / f64::from(k + 1)).collect()]
        {
            let mut sorted = numbers.clone();
            sorted.sort_unstable_by(f64::total_cmp);
            for at in [0, numbers.len() / 3, (numbers.len() - 1) * 98 / 100, numbers.len() - 1] {
                assert_eq!(nth(&numbers, at), sorted[at], "{at} of {}", numbers.len());
            }
        }
    }
}
