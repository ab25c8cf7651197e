//! What a stage of a plant does to a simulation: particles come in with their contacts and bonds, and crossings and paths go out.

use super::Simulation;
use crate::model::{Halt, SetupError};
use crate::passes::zones::{enter, paths, returned};
use crate::setup::{Crossing, CrossingBond, Entry, Guide, PairHistory, PathSample};
use crate::state::{Direction, Forces, ListStatus, Returned, State, ZoneParticle};
use std::collections::BTreeSet;

impl Simulation {
    /// Queues a particle that will enter; due when time() reaches `entry.time`.
    ///
    /// # Errors
    /// An entry that comes after it was due, out of order, or outside what the setup announced.
    pub fn enter(&mut self, entry: Entry) -> Result<(), SetupError> {
        let now = self.time();
        self.state.zones.enter(entry, now, &self.model.setup)
    }

    /// Entries due until time() + this [s] must have been given before the next step.
    pub fn look_ahead(&self) -> f64 {
        enter::look_ahead(&self.model)
    }

    /// The step that is under way where it was stopped, or was made last: its forces are known, or it has moved the particles.
    pub fn last_begun(&self) -> u64 {
        let moved = self.state.forces != Forces::Known;
        self.state.steps.saturating_sub(u64::from(moved))
    }

    /// Takes news of a particle on its way in along a recorded path, whose samples must reach beyond time() + [`Simulation::look_ahead`] before
    /// the next step.
    ///
    /// # Errors
    /// News of a particle that is not on its way, or out of order.
    pub fn guide(&mut self, id: u32, guide: Guide) -> Result<(), SetupError> {
        self.state.zones.guide(id, guide, &self.model.setup)
    }

    /// Queues the history of a contact of two particles that come in: before the first of them is free, or it has no effect.
    pub fn enter_history(&mut self, history: PairHistory) {
        let PairHistory { id, partner, history } = history;
        if self.state.zones.is_entering(id, &self.model.setup) {
            self.state.zones.histories.insert((id, partner), history);
        }
    }

    /// Queues a bond of two particles that come in, before the first of them is free. No effect where the bond is known, or where the setup has
    /// no bonds.
    pub fn enter_bond(&mut self, bond: CrossingBond) {
        if self.state.bonds.on {
            self.state.bonds.waiting.push(bond);
            self.state.listing.outdate(ListStatus::Outdated);
        }
    }

    /// Crossings of storage planes since the last call, in time order.
    pub fn take_crossings(&mut self) -> Vec<Crossing> {
        std::mem::take(&mut self.state.zones.crossings)
    }

    /// States of the particles near a storage plane of recorded paths, now.
    pub fn sample_paths(&mut self) -> Vec<PathSample> {
        paths::sample_paths(&self.model, &mut self.state)
    }

    /// Looks for particles that zones have lost: one that came in by a cut and has gone back through the whole zone, and one that
    /// comes in too fast for the step. Those behind a calculation plane again are counted. At no cost without inlets.
    ///
    /// # Errors
    /// Such a particle, unless the guards have it removed.
    pub fn look_back(&mut self) -> Result<(), Halt> {
        returned::look_back(&self.model, &mut self.state, &self.lists)
    }

    /// Whether [`Simulation::look_back`] may find something before step `until`: where it cannot, nothing is lost if it is not called.
    pub fn looks_back(&self, until: u64) -> bool {
        let State { zones, dt, .. } = &self.state;
        zones.is_watched() || !zones.stay_slow([self.time(), until as f64 * dt], *dt, &self.model.setup)
    }

    /// How many entries that were given have not come in, those that wait included; a clump counts as one.
    pub fn still_to_come(&self) -> u64 {
        let (zones, now) = (&self.state.zones, self.time());
        let listed = |t: &&ZoneParticle| matches!(t.direction, Direction::In(_)) && t.since > now;
        let listed = zones.zone_particles.iter().filter(listed).map(|t| t.passing_id);
        let listed: BTreeSet<u32> = listed.collect();
        (zones.pending.len() + zones.waiting.len() + listed.len()) as u64
    }

    /// How many particles went back through planes so far.
    pub fn returned(&self) -> &Returned {
        &self.state.zones.lost.returned
    }
}
