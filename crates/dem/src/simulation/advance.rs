//! Many steps at once, where a device makes them.

use super::Simulation;
use crate::device::{Device, DeviceError, DeviceTimes, Stepper};
use crate::forces::sweep;
use crate::model::{Halt, Model};
use crate::neighbours::poses::pose_in_box;
use crate::neighbours::{NeighbourLists, rebuild};
use crate::observe::guards;
use crate::passes::touching::position_before;
use crate::simulation::step::{check_overlap, refresh_lists};
use crate::state::{Forces, ListStatus, State};
use geom::Vec3;
use std::time::{Duration, Instant};

/// How long a device computes before the state is fetched: what stops a run is asked in between. No result depends on it.
const PATIENCE: Duration = Duration::from_secs(1);

impl Simulation {
    /// Has the steps made by a device from now on, with the same bits.
    ///
    /// # Errors
    /// What of the simulation the device does not compute, in words.
    pub fn use_device(&mut self, device: Box<dyn Device>) -> Result<(), Vec<String>> {
        self.device = Some(Stepper::new(device, &self.model, &self.state)?);
        Ok(())
    }

    /// What makes the steps, where that is not this processor.
    pub fn device(&self) -> Option<String> {
        self.device.as_ref().map(Stepper::name)
    }

    /// Where the time of the device went so far; `None` without one.
    pub fn device_times(&self) -> Option<DeviceTimes> {
        self.device.as_ref().map(|stepper| stepper.times)
    }

    /// Makes steps: one here; on a device as many as it makes in about a second, until step `last` at most.
    ///
    /// # Errors
    /// As [`Simulation::step`]; a device that fails, with the state from before.
    pub fn advance(&mut self, last: u64) -> Result<(), Halt> {
        let Some(mut stepper) = self.device.take() else { return self.step() };
        let outcome = self.advance_on(&mut stepper, last);
        self.device = Some(stepper);
        outcome
    }

    fn advance_on(&mut self, stepper: &mut Stepper, last: u64) -> Result<(), Halt> {
        let start = Instant::now();
        loop {
            refresh_lists(&self.model, &mut self.state, &mut self.lists)?;
            if self.state.forces == Forces::Known || !self.state.starting.is_empty() {
                self.step()?;
            } else {
                self.steps_on(stepper, last, start)?;
            }
            if self.state.steps >= last || start.elapsed() >= PATIENCE {
                return Ok(());
            }
        }
    }

    /// Steps on the device until it needs this processor.
    fn steps_on(&mut self, stepper: &mut Stepper, last: u64, start: Instant) -> Result<(), Halt> {
        let Simulation { model, state, lists, .. } = self;
        let time = state.time();
        let failed = |error: DeviceError| Halt::Device { time, what: error.to_string() };
        if lists.slots.new {
            sweep::find_contact_points(model, state, lists);
        }
        stepper.send(model, state, lists).map_err(failed)?;
        let most = rebuild::steps_of_walls(model, state, last.saturating_sub(state.steps).max(1));
        let poses = |step: u64| {
            let time = (state.steps + step) as f64 * state.dt;
            let pose = |w: usize| model.walls[w].pose(&pose_in_box(model, state, lists, w, time));
            (0..model.walls.len()).map(pose).collect()
        };
        let found = stepper.run(most, poses, || start.elapsed() < PATIENCE).map_err(failed)?;
        let steps = state.steps + found.steps;
        stepper.fetch(state, steps).map_err(failed)?;
        (state.steps, state.forces, lists.slots.new) = (steps, Forces::Due, false);
        // The device does not say which blocks act.
        lists.step.active.fill(true);
        if found.flags.left_margin != 0 {
            state.listing.outdate(ListStatus::MarginLeft);
        }
        if found.flags.deep != 0 {
            find_points_before(model, state, lists);
            let all = 0..lists.slots.segments.len();
            check_overlap(model, state, lists, &[all], true)?;
        }
        if found.flags.too_fast != 0 {
            guards::check_motion(model, state)?;
        }
        Ok(())
    }
}

/// Contact points of images and walls as they were when the forces of the last step were computed, before its move: the device has had them.
fn find_points_before(model: &Model, state: &mut State, lists: &mut NeighbourLists) {
    let before: Vec<Vec3> = (0..state.particles.len()).map(|k| position_before(model, state, k)).collect();
    let now = state.particles.rows.clone();
    state.particles.rows.iter_mut().zip(&before).for_each(|(row, x)| row[..3].copy_from_slice(x.as_slice()));
    state.steps -= 1;
    lists.slots.new = true;
    sweep::find_contact_points(model, state, lists);
    lists.slots.new = false;
    state.steps += 1;
    state.particles.rows = now;
}
