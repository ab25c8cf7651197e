//! What of a tile rests ([`crate::forces::resting`] finds it).

use std::ops::Range;

/// What of a tile rests.
#[derive(Debug, Default)]
pub struct Still {
    /// The tile itself, and those that it has contacts with.
    pub near: Vec<u32>,
    /// Steps that had been ended when it was found.
    pub found: Option<u64>,
    /// Whether it was found before this step.
    pub goes_on: bool,
    /// Segments and places of contacts that do not rest.
    pub busy: Vec<(usize, Range<usize>)>,
    /// Sums of the loads and couples of the others; none where there are no others.
    pub rest: (Vec<f64>, Vec<f64>),
    /// Particles of the tile that are awake, counted from its first.
    pub awake: Vec<Range<usize>>,
    /// Sleepers that touch or may touch somebody who is not asleep, counted likewise.
    pub stirred: Vec<u32>,
}

impl Still {
    /// Nothing yet, of a tile that has contacts with these.
    pub fn beside(near: Vec<u32>) -> Still {
        Still { near, ..Still::default() }
    }

    /// Whether what rests is what rested a step before.
    pub fn goes_on(&self) -> bool {
        self.goes_on
    }
}
