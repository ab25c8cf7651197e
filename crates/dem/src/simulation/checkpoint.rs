//! Checkpoints: State, and what lists keep in their slots, so that a resumed run gives the same bits.

use super::Simulation;
use crate::forces::sweep;
use crate::model::error::SetupError;
use crate::neighbours::rebuild;
use crate::setup::{Setup, Step};
use crate::simd::Width;
use crate::state::zones::LOOK_AHEAD;
use crate::state::{Forces, State};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Everything that a setup and the lists do not give: borrowed from a simulation when it is written, owned when it is read.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Checkpoint<'a> {
    state: Cow<'a, State>,
    /// Contact history, by slot.
    memory: Cow<'a, [f64]>,
    /// Sliding work of each contact that has not been recorded, by slot.
    work: Cow<'a, [f64]>,
    /// Wrenches, torques and ledger of each contact, when they are those of this step and kept.
    loads: [Cow<'a, [f64]>; 3],
    /// Sums of wrenches and torques by particle, when they are those of this step and each contact's are not kept.
    sums: [Cow<'a, [f64]>; 2],
}

impl Checkpoint<'_> {
    /// A copy that outlives the simulation.
    pub fn to_state(&self) -> Checkpoint<'static> {
        fn own(column: &[f64]) -> Cow<'static, [f64]> {
            Cow::Owned(column.to_vec())
        }
        Checkpoint {
            state: Cow::Owned(self.state.clone().into_owned()),
            memory: own(&self.memory),
            work: own(&self.work),
            loads: self.loads.each_ref().map(|column| own(column)),
            sums: self.sums.each_ref().map(|column| own(column)),
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
        let State { dt, sleepers, particles, bonds, servos, .. } = &*self.state;
        let asked = if let Step::Fixed(asked) = setup.step { asked } else { *dt };
        let differs = |differs: bool, what: &str| if differs { other(what) } else { Ok(()) };
        differs(asked != *dt, &format!("time step {asked} s, saved {dt} s"))?;
        differs(
            begun.sleepers.is_some() != sleepers.is_some(),
            "one has particles that sleep and the other has not",
        )?;
        differs(begun.particles.rotates() != particles.rotates(), "one has rotation and the other has not")?;
        let bonded = begun.bonds.none() != bonds.none() || begun.bonds.count()[0] > bonds.count()[0];
        differs(bonded, "another number of bonds")?;
        differs(begun.servos.len() != servos.len(), "one has walls that follow a force and the other has not")
    }
}

fn other(what: &str) -> Result<(), SetupError> {
    Err(SetupError::OtherState(what.to_owned()))
}

impl Simulation {
    /// The state of this instant.
    pub fn state(&self) -> Checkpoint<'_> {
        let (state, c, none) = (&self.state, &self.lists.contacts, &[][..]);
        let (sums, known) = (c.sums().sums, state.forces == Forces::Known);
        // Wrenches between sleepers are those of the step in which they fell asleep.
        let loads = match (known || state.sleepers.is_some(), c.keeps()) {
            (true, true) => [&c.loads[..], &c.torques, &c.ledger],
            (true, false) => [none, none, &c.ledger],
            (false, _) => [none; 3],
        };
        Checkpoint {
            state: Cow::Borrowed(state),
            memory: Cow::Borrowed(&c.memory),
            work: Cow::Borrowed(&c.work),
            loads: loads.map(Cow::Borrowed),
            sums: if known && !c.keeps() { [sums.0, sums.1] } else { [none; 2] }.map(Cow::Borrowed),
        }
    }

    /// Resumes from a checkpoint of the same setup.
    ///
    /// # Errors
    /// A setup that cannot run, or a checkpoint of another one.
    pub fn resume(setup: Setup, saved: Checkpoint) -> Result<Simulation, SetupError> {
        let dt = saved.state.dt;
        if !(dt > 0.0 && dt.is_finite()) {
            other(&format!("time step {dt} s"))?;
        }
        // The step stays, also where a guard that enters the critical step has changed.
        let mut sim = Simulation::build(setup, Width::best(), Some(dt))?;
        saved.fits(&sim.state, &sim.model.setup)?;
        let Checkpoint { state, memory, work, loads, sums } = saved;
        sim.state = state.into_owned();
        let Simulation { model, state, lists } = &mut sim;
        state.bonds.index(&state.particles.id);
        if state.listing.rebuilds > 0 {
            rebuild::list_again(model, state, lists);
            if memory.len() != lists.contacts.memory.len() {
                other("another number of contacts")?;
            }
            lists.contacts.memory.copy_from_slice(&memory);
            if work.len() == lists.contacts.work.len() {
                lists.contacts.work = work.into_owned();
            }
        }
        if state.forces == Forces::Known || !loads[0].is_empty() {
            // Where nothing touches, wrenches that are kept are empty, too.
            let kept = sums.iter().all(|column| column.is_empty());
            lists.contacts.keep_wrenches(kept);
            // A crossing in this step asks where walls were touched, and so do sleepers on walls at rest.
            sweep::find_contact_points(model, state, lists);
            if !lists.contacts.put_loads(&loads, &sums) {
                other("another number of wrenches")?;
            }
            lists.contacts.new = state.steps == state.listing.step;
            if kept {
                sweep::recall(model, state, lists);
            }
        }
        Ok(sim)
    }
}
