//! Many steps at once, where a device makes them.

use super::Simulation;
use crate::device::{
    Before, Course, Device, DeviceError, DeviceTimes, Found, LAUNCHED, Stepper, next_entry, refused,
};
use crate::forces::sweep;
use crate::model::{Halt, Model};
use crate::neighbours::poses::pose_in_box;
use crate::neighbours::{NeighbourLists, rebuild};
use crate::observe::guards;
use crate::passes::instant;
use crate::passes::touching::position_before;
use crate::passes::zones::travel;
use crate::simulation::step::{check_overlap, refresh_lists};
use crate::state::{Forces, LOOK_AHEAD, ListStatus, State};
use geom::Vec3;

impl Simulation {
    /// Has the steps made by a device from now on, with the same bits.
    ///
    /// # Errors
    /// What of the simulation the device does not compute, in words.
    pub fn use_device(&mut self, device: Box<dyn Device>) -> Result<(), Vec<String>> {
        self.device = Some(Stepper::new(device, &self.model, &self.state)?);
        Ok(())
    }

    /// What of the simulation a device does not compute, in words; none: it computes all of it.
    pub fn not_on_a_device(&self) -> Vec<String> {
        refused(&self.model, &self.state)
    }

    /// What makes the steps, where that is not this processor.
    pub fn device(&self) -> Option<String> {
        self.device.as_ref().map(Stepper::name)
    }

    /// Where the time of the device went so far; `None` without one.
    pub fn device_times(&self) -> Option<DeviceTimes> {
        self.device.as_ref().map(|stepper| stepper.times)
    }

    /// Makes steps: one here; on a device all until step `last`, or until `goes_on`, which is asked with their number every few dozen of them, says no.
    ///
    /// # Errors
    /// As [`Simulation::step`]; a device that fails, with the state from before.
    pub fn advance(&mut self, last: u64, goes_on: &mut dyn FnMut(u64) -> bool) -> Result<(), Halt> {
        let Some(mut stepper) = self.device.take() else { return self.step() };
        let outcome = self.advance_on(&mut stepper, last, goes_on);
        self.device = Some(stepper);
        outcome
    }

    fn advance_on(
        &mut self,
        stepper: &mut Stepper,
        last: u64,
        goes_on: &mut dyn FnMut(u64) -> bool,
    ) -> Result<(), Halt> {
        // Entries are known no farther ahead.
        let enters = !self.state.zones.none();
        let last = if enters { last.min(self.state.steps + LOOK_AHEAD) } else { last };
        loop {
            refresh_lists(&self.model, &mut self.state, &mut self.lists)?;
            if self.is_due_here() {
                self.step()?;
            } else {
                return self.steps_on(stepper, last.max(self.state.steps + 1), goes_on);
            }
            if enters || self.state.steps >= last || !goes_on(self.state.steps) {
                return Ok(());
            }
        }
    }

    /// Whether the next step is made here: something has been observed, all begin to move, or contacts take histories that were recorded.
    fn is_due_here(&self) -> bool {
        let Simulation { model, state, .. } = self;
        let all_start = !state.starting.is_empty() && state.starting.len() == state.particles.len();
        let starts = if state.zones.none() { !state.starting.is_empty() } else { all_start };
        state.forces == Forces::Known || starts || Course::is_here(model, state)
    }

    /// Steps on the device, which makes its own lists, until something is due here.
    fn steps_on(
        &mut self,
        stepper: &mut Stepper,
        last: u64,
        goes_on: &mut dyn FnMut(u64) -> bool,
    ) -> Result<(), Halt> {
        let Simulation { model, state, lists, .. } = self;
        let failed = |time: f64, error: DeviceError| Halt::Device { time, what: error.to_string() };
        let (begun, listing, wall_periods) = (state.steps, state.listing, lists.wall_periods.clone());
        let before = (!state.zones.none()).then(|| Before::of(state));
        let outcome = stepper
            .send(model, state, lists)
            .and_then(|()| run(stepper, model, state, lists, last, goes_on))
            .and_then(|found| stepper.fetch(model, state, lists).map(|()| found));
        let Found { flags, held, .. } = outcome.map_err(|error| {
            // The columns are still those of then.
            stepper.forget();
            (state.steps, state.listing, lists.wall_periods) = (begun, listing, wall_periods);
            if let Some(before) = before {
                before.restore(state);
            }
            failed(state.time(), error)
        })?;
        if held {
            stepper.fetch_wrenches(state, lists).map_err(|error| failed(state.time(), error))?;
            sweep::find_contact_points(model, state, lists);
            sweep::sum_kept(model, state, lists);
            state.forces = Forces::Known;
            instant::start(model, state);
            let all = 0..lists.slots.segments.len();
            return check_overlap(model, state, lists, &[all], false);
        }
        if flags.met != 0 {
            find_points_before(model, state, lists);
            travel::move_zone_particles(model, state, lists)?;
        }
        if flags.deep != 0 {
            find_points_before(model, state, lists);
            let all = 0..lists.slots.segments.len();
            check_overlap(model, state, lists, &[all], true)?;
        }
        if flags.too_fast != 0 {
            guards::check_motion(model, state)?;
        }
        Ok(())
    }
}

/// Steps and lists of a device; what the last step found. Of the state it brings everything up to date but the columns.
fn run(
    stepper: &mut Stepper,
    model: &Model,
    state: &mut State,
    lists: &mut NeighbourLists,
    last: u64,
    goes_on: &mut dyn FnMut(u64) -> bool,
) -> Result<Found, DeviceError> {
    let last = next_entry(state).map_or(last, |entry| last.min(entry));
    loop {
        let before = state.steps;
        let most = rebuild::steps_of_walls(model, state, last - before);
        let course = (!state.zones.none()).then(|| Course::plan(model, state, most.min(u64::from(LAUNCHED))));
        let most = course.as_ref().map_or(most, |course| course.steps);
        let poses = |step: u64| {
            let time = (before + step) as f64 * state.dt;
            let pose = |w: usize| model.walls[w].pose(&pose_in_box(model, state, lists, w, time));
            (0..model.walls.len()).map(pose).collect()
        };
        let mut wanted = true;
        let found = stepper.run(most, course.as_ref(), poses, |done| {
            wanted = goes_on(before + done);
            wanted
        })?;
        // Where an inserted particle has met something, what the last step does in zones is done here.
        let here = u64::from(found.flags.met != 0 && !found.held);
        state.steps += found.steps - here;
        if let Some(course) = &course {
            course.done(state, found.steps - here);
        }
        if here > 0 {
            state.steps += here;
            state.starting.clear();
        }
        if found.flags.left_margin != 0 {
            state.listing.outdate(ListStatus::MarginLeft);
        }
        let guarded = found.flags.deep != 0 || found.flags.too_fast != 0 || here > 0;
        if guarded || state.steps >= last || !wanted || Course::is_here(model, state) {
            return Ok(found);
        }
        if rebuild::is_due(model, state) {
            stepper.relist(model, state, lists)?;
        }
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
