//! Neighbour lists: all contacts that may come to act before the next rebuild.
//!
//! `rebuild` makes them from Model and State alone, so that a resumed run has the same lists, and carries contact history over. `slots`
//! is their layout: tiles of particles, segments of one kind of contact, blocks of slots. Uses model, state, space, walls, laws.

pub mod contact_records;
pub mod history;
pub mod list;
pub mod poses;
pub mod rebuild;
pub mod slices;
pub mod slots;

pub use history::OldContacts;
pub use list::List;
pub use rebuild::LISTED_FEW;
pub use slices::{Computed, RestingTile, SlotRun, StepColumns, TileSlice};
pub use slots::{Disturber, Segment, Slots};

use crate::state::SpareColumns;
use laws::simd::{Row, Row4};
use laws::space::images::Periods;

/// Neighbour lists.
#[derive(Default)]
pub struct NeighbourLists {
    /// Contacts by tile.
    pub slots: Slots,
    /// What is computed of them in each step.
    pub step: StepColumns,
    /// Whole periods that walls had travelled when neighbours were listed; empty where nothing is periodic.
    pub wall_periods: Vec<Periods>,
    /// Particles as they were before the move; only where a fluid or local damping acts on them.
    pub before: Vec<Row>,
    /// Their spins then; only with local damping.
    pub spins_before: Vec<Row4>,
    /// For the next rebuild.
    pub spare: SpareColumns,
}
