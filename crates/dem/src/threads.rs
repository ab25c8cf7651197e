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
