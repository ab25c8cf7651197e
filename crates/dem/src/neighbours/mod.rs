//! Neighbour lists: all contacts that may come to act before the next rebuild, with what is computed in their slots.
//!
//! `rebuild` makes them from Model and State alone, so that a resumed run has the same lists, and carries contact history over. `contacts`
//! is their layout: tiles of particles, segments of one kind of contact, blocks of slots. Uses model, state, space, walls, kernel.

pub mod contacts;
pub mod ends;
pub mod history;
pub mod list;
pub mod poses;
pub mod rebuild;
pub mod resting;
pub mod slices;

use crate::simd::Row;
use crate::walls::images::Periods;
use contacts::Contacts;

/// Neighbour lists.
pub struct NeighbourLists {
    /// Contacts by tile.
    pub contacts: Contacts,
    /// Whole periods that walls had travelled when neighbours were listed; empty where nothing is periodic.
    pub wall_periods: Vec<Periods>,
    /// Particles as they were before the move; only where a fluid drags them.
    pub before: Vec<Row>,
    /// Whether the wrench of each contact is kept when a run is observed.
    pub records: bool,
}

impl Default for NeighbourLists {
    fn default() -> NeighbourLists {
        NeighbourLists {
            contacts: Contacts::default(),
            wall_periods: Vec::new(),
            before: Vec::new(),
            records: true,
        }
    }
}
