//! A simulation: what is fixed (Model), what changes (State), and the lists that follow from both.
//!
//! `step` is the time step, `checkpoint` saves and resumes. `observe`, `explain` and `stages` are what users call besides. Nothing else sees all three
//! parts at once as one.

mod advance;
mod checkpoint;
mod explain;
mod observe;
mod stages;
mod step;

pub use checkpoint::Checkpoint;
pub use explain::{ContactBytes, EffectCost, MatchedDamping};

use crate::device::Stepper;
use crate::model::{Model, SetupError};
use crate::neighbours::NeighbourLists;
use crate::passes::cell;
use crate::setup::Setup;
use crate::state::State;
use laws::simd::Width;

/// A running simulation.
pub struct Simulation {
    pub(crate) model: Model,
    pub(crate) state: State,
    pub(crate) lists: NeighbourLists,
    /// What makes the steps, where this processor does not.
    pub(crate) device: Option<Stepper>,
}

impl Simulation {
    /// Checks a setup and makes it ready to run.
    ///
    /// # Errors
    /// Everything that would make the run wrong or unstable: see [`SetupError`].
    pub fn new(setup: Setup) -> Result<Simulation, SetupError> {
        Simulation::with_width(setup, Width::best())
    }

    /// The same with lanes of a given width; all widths give the same bits.
    ///
    /// # Errors
    /// As for [`Simulation::new`], and a width that this machine does not have.
    pub fn with_width(setup: Setup, width: Width) -> Result<Simulation, SetupError> {
        Simulation::build(setup, width, None)
    }

    /// The same with the step `begun` [s] of a run that is resumed.
    fn build(setup: Setup, width: Width, begun: Option<f64>) -> Result<Simulation, SetupError> {
        let mut model = Model::new(setup, width, begun)?;
        let mut state = State::new(&model)?;
        cell::start(&mut state);
        // They are in their columns now.
        model.setup.particles = Vec::new();
        model.setup.clumps.placed = Vec::new();
        let kept = std::mem::take(&mut model.setup.kept);
        let mut sim = Simulation { model, state, lists: NeighbourLists::default(), device: None };
        if begun.is_none() && !kept.is_empty() {
            sim.restore(&kept);
        }
        Ok(sim)
    }

    /// Sets a time step [s] that nothing has checked: to find by trial where a run turns unstable.
    pub fn set_step_unchecked(&mut self, dt: f64) {
        (self.model.dt, self.state.dt) = (dt, dt);
    }
}
