//! The end of an insertion after a number or a mass.

use crate::keys::Insert;

/// What an insertion is to insert in all, and what it has inserted.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::plan) struct Total {
    count: Option<u64>,
    /// [kg].
    mass: Option<f64>,
    inserted: (u64, f64),
}

impl Total {
    /// That of an entry; without `count` and `mass` it has no end.
    pub(in crate::plan) fn new(entry: &Insert) -> Total {
        Total { count: entry.count, mass: entry.mass, inserted: (0, 0.0) }
    }

    /// Whether there is room for one more of the mass that `next` tells [kg]: as many as come nearest to the mass, as in `[[fill]]`.
    pub(in crate::plan) fn has_room(&self, next: impl FnOnce() -> f64) -> bool {
        let (count, mass) = self.inserted;
        self.count.is_none_or(|most| count < most) && self.mass.is_none_or(|most| mass + next() / 2.0 <= most)
    }

    /// Whether it ends after a mass.
    pub(in crate::plan) fn is_mass(&self) -> bool {
        self.mass.is_some()
    }

    /// Begins again.
    pub(in crate::plan) fn begin(&mut self) {
        self.inserted = (0, 0.0);
    }

    /// One of a mass [kg] was inserted.
    pub(in crate::plan) fn add(&mut self, mass: f64) {
        self.inserted = (self.inserted.0 + 1, self.inserted.1 + mass);
    }

    /// The number that is expected at most, of a mean mass [kg]; ∞ without an end.
    pub(in crate::plan) fn expected(&self, mean: f64) -> f64 {
        let count = self.count.map_or(f64::INFINITY, |count| count as f64);
        count.min(self.mass.map_or(f64::INFINITY, |mass| mass / mean))
    }
}
