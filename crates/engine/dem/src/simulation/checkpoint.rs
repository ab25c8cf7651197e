//! Checkpoints: State, with the columns of contacts that cannot be computed again, so that a resumed run gives the same bits.

use super::Simulation;
use crate::forces::sweep;
use crate::model::{SetupError, StateMismatch};
use crate::neighbours::rebuild;
use crate::setup::{Setup, Step};
use crate::state::{Forces, LOOK_AHEAD, SavedColumns, State};
use laws::simd::Width;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// What a setup does not give: borrowed from a simulation when it is written, owned when it is read.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Checkpoint<'a> {
    state: Cow<'a, State>,
    contacts: SavedColumns<'a>,
}

impl Checkpoint<'_> {
    /// A copy that outlives the simulation.
    pub fn to_static(&self) -> Checkpoint<'static> {
        Checkpoint {
            state: Cow::Owned(self.state.without_contacts()),
            contacts: self.contacts.clone().into_owned(),
        }
    }

    /// Steps done.
    pub fn steps(&self) -> u64 {
        self.state.steps
    }

    /// Δt [s].
    pub fn dt(&self) -> f64 {
        self.state.dt
    }

    /// Steps × Δt [s].
    pub fn time(&self) -> f64 {
        self.state.time()
    }

    /// Entries due until [`Checkpoint::time`] + this [s] had been given.
    pub fn look_ahead(&self) -> f64 {
        self.state.dt * LOOK_AHEAD as f64
    }

    /// Refuses a checkpoint of another setup.
    fn fits(&self, begun: &State, setup: &Setup) -> Result<(), SetupError> {
        let State { dt, sleepers, particles, bonds, servos, strained, mounts, .. } = &*self.state;
        let asked = if let Step::Fixed(asked) = setup.step { asked } else { *dt };
        let differs = |differs: bool, what| if differs { other(what) } else { Ok(()) };
        differs(asked != *dt, StateMismatch::Step { asked, saved: *dt })?;
        differs(begun.sleepers.is_some() != sleepers.is_some(), StateMismatch::Sleep)?;
        differs(begun.particles.rotates() != particles.rotates(), StateMismatch::Rotation)?;
        let bonded = begun.bonds.none() != bonds.none() || begun.bonds.count()[0] > bonds.count()[0];
        differs(bonded, StateMismatch::Bonds)?;
        differs(begun.servos.len() != servos.len(), StateMismatch::Servos)?;
        differs(begun.strained.is_some() != strained.is_some(), StateMismatch::Strain)?;
        differs(begun.mounts.len() != mounts.len(), StateMismatch::Mounts)?;
        self.state.check(begun, setup).map_err(SetupError::OtherState)
    }
}

fn other(mismatch: StateMismatch) -> Result<(), SetupError> {
    Err(SetupError::OtherState(mismatch))
}

impl Simulation {
    /// A checkpoint of this instant.
    pub fn checkpoint(&self) -> Checkpoint<'_> {
        let state = &self.state;
        let contacts =
            SavedColumns::of(&state.contacts, state.forces == Forces::Known, state.sleepers.is_some());
        Checkpoint { state: Cow::Borrowed(state), contacts }
    }

    /// Resumes from a checkpoint of the same setup.
    ///
    /// # Errors
    /// A setup that cannot run, or a checkpoint of another one.
    pub fn resume(setup: Setup, saved: Checkpoint) -> Result<Simulation, SetupError> {
        let dt = saved.state.dt;
        if !(dt > 0.0 && dt.is_finite()) {
            other(StateMismatch::InvalidStep(dt))?;
        }
        // The step stays, also where a guard that enters the critical step has changed.
        let mut sim = Simulation::build(setup, Width::best(), Some(dt))?;
        saved.fits(&sim.state, &sim.model.setup)?;
        let Checkpoint { state, contacts: saved } = saved;
        let begun = std::mem::replace(&mut sim.state, state.into_owned());
        // What becomes of particles without room may be another thing from now on.
        let zones = sim.state.zones.inlets.iter_mut().zip(&begun.zones.inlets);
        zones.for_each(|(zone, now)| zone.when_blocked = now.when_blocked);
        let Simulation { model, state, lists, .. } = &mut sim;
        state.bonds.index(&state.particles.id);
        if state.listing.rebuilds > 0 {
            rebuild::restore_lists(model, state, lists);
            if !saved.restore_history(&mut state.contacts) {
                other(StateMismatch::Contacts)?;
            }
        }
        if state.forces == Forces::Known || saved.has_wrenches() {
            // Where nothing touches, wrenches that are kept are empty, too.
            let keeps = !saved.has_sums();
            state.contacts.keep_wrenches(keeps, lists.slots.i.len());
            // A crossing in this step asks where walls were touched, and so do sleepers on walls at rest.
            sweep::find_contact_points(model, state, lists);
            if !saved.restore_wrenches(&mut state.contacts) {
                other(StateMismatch::Wrenches)?;
            }
            lists.slots.new = state.steps == state.listing.step;
            if keeps {
                sweep::sum_kept(model, state, lists);
            }
        }
        Ok(sim)
    }
}
