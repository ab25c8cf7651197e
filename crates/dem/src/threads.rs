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
    if count < SHORT {
        return (0..count).map(of).collect();
    }
    (0..count).into_par_iter().with_min_len(SHORT / 4).map(of).collect()
}

/// Changes all entries of a column, each by itself.
pub(crate) fn change<T: Send>(column: &mut [T], by: impl Fn(usize, &mut T) + Sync + Send) {
    if column.len() < SHORT {
        return column.iter_mut().enumerate().for_each(|(k, entry)| by(k, entry));
    }
    column.par_iter_mut().with_min_len(SHORT / 4).enumerate().for_each(|(k, entry)| by(k, entry));
}
