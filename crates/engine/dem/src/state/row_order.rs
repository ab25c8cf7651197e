//! Particles in a new order: each column that has a row for each of them follows.
//!
//! Every part of the state takes itself to pieces here or in its own `reorder`, so that a field that is added does not compile until it
//! is decided what a new order does to it. `Particles::push` and `reserve`, and the columns of a device (`gpu/src/tables/columns.rs`,
//! `permute`), are not checked so: a column goes there, too.

use crate::state::{SpareColumns, State};

/// What a new order does to rows.
pub struct RowOrder<'a> {
    /// The old row of each particle that stays.
    pub order: &'a [u32],
    /// The new row of each particle; [`RowOrder::LEFT`] of one that does not stay.
    pub new: Vec<u32>,
}

impl<'a> RowOrder<'a> {
    /// The new row of a particle that does not stay.
    pub const LEFT: u32 = u32::MAX;

    /// The order of so many particles in which those of the old rows `order` stay.
    pub fn of(order: &'a [u32], particles: usize) -> RowOrder<'a> {
        let mut new = vec![RowOrder::LEFT; particles];
        (0..).zip(order).for_each(|(now, &was)| new[was as usize] = now);
        RowOrder { order, new }
    }
}

impl State {
    /// Puts particles in the order of their old rows `order`; those that are not in it leave.
    pub fn reorder(&mut self, order: &[u32], spare: &mut SpareColumns) {
        let rows = RowOrder::of(order, self.particles.len());
        let State {
            particles,
            zones,
            clumps,
            bonds,
            sleepers,
            starting,
            // Of no particle, or by its id.
            dt: _,
            steps: _,
            listing: _,
            forces: _,
            clusters: _,
            strained: _,
            servos: _,
            mounts: _,
            ledger: _,
            wall_sums: _,
            ended: _,
            // The lists carry them over (`neighbours/history.rs`).
            contacts: _,
        } = self;
        particles.reorder(&rows, spare);
        zones.reorder(&rows);
        clumps.reorder(&rows);
        bonds.reorder(&rows, &particles.id);
        if let Some(sleepers) = sleepers {
            sleepers.reorder(&rows);
        }
        starting.iter_mut().for_each(|k| *k = rows.new[*k as usize]);
        starting.retain(|&k| k != RowOrder::LEFT);
        starting.sort_unstable();
    }
}
