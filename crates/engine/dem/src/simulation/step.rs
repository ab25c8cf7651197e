//! One time step.
//!
//! Bonds and forces at time n, the move to n + 1, then everything that acts on what has moved: clumps, servos, the fluid, zones. Observing
//! a simulation computes forces and moves nothing, so that output changes nothing.

use super::Simulation;
use crate::forces::sweep;
use crate::model::{Halt, Model};
use crate::neighbours::{NeighbourLists, rebuild};
use crate::observe::guards;
use crate::passes::{
    bonds, cell, clumps, drag, earlier_contacts, instant, ledger, local_damping, mount, servo, wall_sums,
    zones,
};
use crate::setup::KeptContact;
use crate::state::{Forces, ListStatus, State};
use std::ops::Range;

impl Simulation {
    /// One time step.
    ///
    /// # Errors
    /// A guard. The state is that of the last whole step; where only this step's forces showed an overlap, of the step itself.
    pub fn step(&mut self) -> Result<(), Halt> {
        let Simulation { model, state, lists, .. } = self;
        refresh_lists(model, state, lists)?;
        // The move needs the acceleration of the step before.
        if !state.starting.is_empty() {
            compute_forces(model, state, lists)?;
        }
        let found = sweep::forces_and_move(model, state, lists);
        ledger::add_contacts(model, state, lists);
        wall_sums::add(model, state, lists);
        zones::held_back::add(model, state, lists);
        if let Some(sleepers) = &mut state.sleepers {
            state.ledger.slept += sleepers.end_step(lists.slots.tile);
        }
        let moved = clumps::advance::advance(model, state, found.moved);
        let driven = servo::drive(model, state, lists).and(mount::drive(model, state, lists));
        let slowed = drag::apply(model, state, lists) | local_damping::apply(model, state, lists);
        if moved.left_margin | slowed {
            state.listing.outdate(ListStatus::MarginLeft);
        }
        ledger::add_moves(model, state);
        let strained = cell::drive(model, state, lists);
        state.steps += 1;
        state.forces = Forces::Due;
        state.bonds.advance(&state.particles, model.dt);
        let freed = zones::travel::move_zone_particles(model, state, lists);
        zones::cross::find_crossings(model, state, lists);
        zones::removal::remove_inside(model, state, lists);
        freed?;
        check_overlap(model, state, lists, &found.deep, true)?;
        if moved.too_fast {
            guards::check_motion(model, state)?;
        }
        driven?;
        strained?;
        if guards::checks_energy(model, state) {
            self.ready()?;
            guards::check_energy(&self.model, &mut self.state, &self.lists)?;
        }
        Ok(())
    }

    /// Lists neighbours and gives their contacts the histories of an earlier run.
    pub(super) fn restore(&mut self, kept: &[KeptContact]) {
        let Simulation { model, state, lists, .. } = self;
        rebuild::rebuild(model, state, lists);
        earlier_contacts::restore(model, state, lists, kept);
    }

    /// Brings lists and forces to this instant, as observing anything does.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn ready(&mut self) -> Result<(), Halt> {
        let Simulation { model, state, lists, .. } = self;
        refresh_lists(model, state, lists)?;
        compute_forces(model, state, lists)
    }
}

/// Inserts and bonds what is due, brings bonds to this instant, and rebuilds lists that no longer hold.
pub(super) fn refresh_lists(
    model: &Model,
    state: &mut State,
    lists: &mut NeighbourLists,
) -> Result<(), Halt> {
    if state.forces == Forces::Known {
        return Ok(());
    }
    zones::enter::insert_due(model, state, lists)?;
    bonds::zones::insert_due(model, state);
    bonds::make::make_due(model, state)?;
    bonds::act(model, state);
    if rebuild::is_due(model, state) {
        rebuild::rebuild(model, state, lists);
    }
    Ok(())
}

/// Forces of this instant, where they are not known.
fn compute_forces(model: &Model, state: &mut State, lists: &mut NeighbourLists) -> Result<(), Halt> {
    if state.forces == Forces::Known {
        return Ok(());
    }
    let found = sweep::forces(model, state, lists);
    state.forces = Forces::Known;
    let starting = instant::start(model, state);
    ledger::open(model, state, lists, &starting);
    check_overlap(model, state, lists, &found.deep, false)
}

/// Refuses overlaps that are too deep, unless the guards have the particle removed that is in the way of one that comes in.
pub(super) fn check_overlap(
    model: &Model,
    state: &mut State,
    lists: &NeighbourLists,
    segments: &[Range<usize>],
    moved: bool,
) -> Result<(), Halt> {
    while let Err(halt) = guards::check_overlap(model, state, lists, segments, moved) {
        if !zones::removed::clear_the_way(model, state, lists, &halt) {
            return Err(halt);
        }
    }
    Ok(())
}
