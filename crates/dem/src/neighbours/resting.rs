//! What of a tile rests ([`crate::forces::resting`] finds it).

use std::ops::Range;

/// What of a tile rests.
#[derive(Debug, Default)]
pub struct RestingTile {
    /// The tile itself, and those that it has contacts with.
    pub near: Vec<u32>,
    /// Steps that had been ended when it was found.
    pub found: Option<u64>,
    /// Whether it was found before this step.
    pub unchanged: bool,
    /// Segments and places of contacts that do not rest.
    pub busy: Vec<(usize, Range<usize>)>,
    /// Sums of the loads and couples of the others; none where there are no others.
    pub rest: (Vec<f64>, Vec<f64>),
    /// Particles of the tile that are awake, counted from its first.
    pub awake: Vec<Range<usize>>,
    /// Sleepers that touch or may touch a particle that is awake, counted likewise.
    pub disturbed: Vec<u32>,
}

impl RestingTile {
    /// Nothing yet, of a tile that has contacts with these.
    pub fn beside(near: Vec<u32>) -> RestingTile {
        RestingTile { near, ..RestingTile::default() }
    }

    /// Whether what rests is what rested a step before.
    pub fn unchanged(&self) -> bool {
        self.unchanged
    }
}
