//! The end of an insertion after a number or a mass.

use crate::keys::Insert;

/// The number and the mass that an insertion has to insert, and what it has inserted so far.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::plan) struct Total {
    count: Option<u64>,
    /// [kg].
    mass: Option<f64>,
    inserted: (u64, f64),
}

impl Total {
    /// The total of a scene entry; without `count` and `mass` the insertion has no end.
    pub(in crate::plan) fn new(entry: &Insert) -> Total {
        Total { count: entry.count, mass: entry.mass, inserted: (0, 0.0) }
    }

    /// Whether one more is inserted, whose mass `next` returns [kg]: the insertion ends as near to its mass as it can, as `[[fill]]` does.
    pub(in crate::plan) fn has_room(&self, next: impl FnOnce() -> f64) -> bool {
        let (count, mass) = self.inserted;
        self.count.is_none_or(|most| count < most) && self.mass.is_none_or(|most| mass + next() / 2.0 <= most)
    }

    /// Whether the insertion ends after a mass, not after a number.
    pub(in crate::plan) fn is_mass(&self) -> bool {
        self.mass.is_some()
    }

    /// Sets what has been inserted to zero, for the next period of an insertion that repeats.
    pub(in crate::plan) fn begin(&mut self) {
        self.inserted = (0, 0.0);
    }

    /// Counts one that was inserted, of `mass` [kg].
    pub(in crate::plan) fn add(&mut self, mass: f64) {
        self.inserted = (self.inserted.0 + 1, self.inserted.1 + mass);
    }

    /// The largest number to expect if each has the `mean` mass [kg]; ∞ without an end.
    pub(in crate::plan) fn expected(&self, mean: f64) -> f64 {
        let count = self.count.map_or(f64::INFINITY, |count| count as f64);
        count.min(self.mass.map_or(f64::INFINITY, |mass| mass / mean))
    }
}
