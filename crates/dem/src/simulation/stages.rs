//! What a stage of a plant does to a simulation: particles come in with their contacts and bonds, and crossings and paths go out.

use super::Simulation;
use crate::model::error::SetupError;
use crate::model::halt::Halt;
use crate::passes::bonds::zones as bonds;
use crate::passes::zones::{enter, memory, paths, returned};
use crate::setup::{Crossing, Entry, Guide, Link, Memory, PathSample};
use crate::state::returned::Returned;

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

    /// Takes news of a particle on its way in along a recorded path.
    ///
    /// # Errors
    /// News of a particle that is not on its way, or out of order.
    pub fn guide(&mut self, id: u32, guide: Guide) -> Result<(), SetupError> {
        paths::guide(&self.model, &mut self.state, id, guide)
    }

    /// Says what a contact of two that come in keeps: before the first of them is free, or it has no effect.
    pub fn remember(&mut self, history: Memory) {
        memory::remember(&self.model, &mut self.state, history);
    }

    /// Bonds two that come in.
    pub fn link(&mut self, link: Link) {
        bonds::link(&mut self.state, link);
    }

    /// Crossings of storage planes since the last call, in time order.
    pub fn take_crossings(&mut self) -> Vec<Crossing> {
        self.state.zones.take_crossings()
    }

    /// States of the particles near a storage plane of recorded paths, now.
    pub fn sample_paths(&mut self) -> Vec<PathSample> {
        paths::sample_paths(&self.model, &mut self.state)
    }

    /// Looks for particles that zones have lost: one that came in by a cut and has gone back through the whole zone, and one that
    /// comes in too fast for the step. Those behind a calculation plane again are counted. At no cost without inlets.
    ///
    /// # Errors
    /// Such a particle.
    pub fn look_back(&mut self) -> Result<(), Halt> {
        returned::look_back(&self.model, &mut self.state)
    }

    /// How many particles went back through planes so far.
    pub fn returned(&self) -> &Returned {
        &self.state.zones.lost.returned
    }
}
