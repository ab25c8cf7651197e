//! Several replays of one record, and superposed copies of it.
//!
//! Copy k = 0 … n−1 is displaced by k s and delayed by k T; replay m = 0 … r−1 is delayed by m P. All of them together get new ids, in
//! the order in which they enter. Superposed copies scale a rate, not the flow: where they were recorded there was one of them, and
//! where they come in they must not overlap.

use crate::outlet::crossing::CrossingRow;
use geom::Vec3;

/// Superposed copies of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Copies {
    /// How many, the record itself included.
    pub count: u32,
    /// s [m].
    pub shift: Vec3,
    /// T [s].
    pub delay: f64,
}

impl Default for Copies {
    fn default() -> Copies {
        Copies { count: 1, shift: Vec3::zeros(), delay: 0.0 }
    }
}

impl Copies {
    /// The copies of a row, with the number of each.
    pub fn of(&self, row: CrossingRow) -> impl Iterator<Item = (u32, CrossingRow)> + use<> {
        let Copies { count, shift, delay } = *self;
        (0..count).map(move |k| {
            let mut row = row;
            row.particle.position += shift * f64::from(k);
            row.time += delay * f64::from(k);
            (k, row)
        })
    }
}
