//! Steps on a device: what it is sent, how often it is asked, and what is fetched.

use crate::device::carried::{Carried, Course};
mod fetch;

use crate::device::lister::{Lister, Why};
use crate::device::refused::refused;
use crate::device::stepper::fetch::Fetched;
use crate::device::tables::Table;
use crate::device::work::Work;
use crate::device::{CARRIED, Device, DeviceError, MADE, MOVES, STARTED, TRIANGLES};
use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::neighbours::poses::periods_travelled;
use crate::neighbours::rebuild::adapt_skin;
use crate::state::{ListStatus, State};
use gpu::tables::{DeviceFlags, DeviceTables, HOLD};
use laws::contact::wall_point::WallPose;
use std::time::Instant;

/// Steps that are launched before the device is asked what they found: an answer takes as long as some steps of a small scene.
pub const LAUNCHED: u32 = 32;

/// A device, with tables for one simulation.
pub struct Stepper {
    device: Box<dyn Device>,
    tables: DeviceTables,
    lister: Lister,
    poses: Table,
    carried: Carried,
    flags: Table,
    /// Number of the rebuild whose lists the device has.
    listed: Option<u64>,
    /// Step whose state the device has: that of the host.
    held: Option<u64>,
    /// Whether it has put the particles into another order since their places were last known here.
    moved: bool,
    /// Which compositions there are contacts of.
    compositions: Vec<usize>,
    fetched: Fetched,
    /// Where the time went so far.
    pub times: DeviceTimes,
}

/// Where the time of a device went [s].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DeviceTimes {
    /// The state was sent, and lists made of it where they had been made here.
    pub sending: f64,
    /// Lists were made, until the last of what that needs had been asked for.
    pub listing: f64,
    /// Steps were made.
    pub stepping: f64,
    /// State and lists were fetched.
    pub fetching: f64,
}

/// What some steps found.
#[derive(Debug, Clone, Copy)]
pub struct Found {
    /// Steps done.
    pub steps: u64,
    /// Of the last of them.
    pub flags: DeviceFlags,
    /// Whether the forces after them are known, too: in a step in which particles begin to move, an overlap is too deep.
    pub held: bool,
}

impl Stepper {
    /// A device for a simulation, or what of it the device does not compute.
    pub fn new(device: Box<dyn Device>, model: &Model, state: &State) -> Result<Stepper, Vec<String>> {
        let refused = refused(model, state);
        if !refused.is_empty() {
            return Err(refused);
        }
        Ok(Stepper {
            device,
            tables: DeviceTables::default(),
            lister: Lister::default(),
            poses: Table::default(),
            carried: Carried::default(),
            flags: Table::default(),
            listed: None,
            held: None,
            moved: false,
            compositions: Vec::new(),
            fetched: Fetched::default(),
            times: DeviceTimes::default(),
        })
    }

    /// What the device is.
    pub fn name(&self) -> String {
        self.device.name()
    }

    /// Sends what the device does not have: all particles, for which it makes lists, where lists were made here; the state of this instant.
    pub fn send(&mut self, model: &Model, state: &State, lists: &NeighbourLists) -> Result<(), DeviceError> {
        let start = Instant::now();
        let makes_lists = self.listed != Some(state.listing.rebuilds);
        if makes_lists || self.held != Some(state.steps) {
            self.listed = None;
            self.send_particles(model, state)?;
            if makes_lists {
                self.send_all(model, state, lists)?;
            }
            self.send_history(state)?;
            (self.listed, self.held) = (Some(state.listing.rebuilds), Some(state.steps));
        }
        self.times.sending += start.elapsed().as_secs_f64();
        Ok(())
    }

    /// Nothing of what the device holds counts any more: it has failed.
    pub fn forget(&mut self) {
        (self.listed, self.held) = (None, None);
    }

    /// What steps change of the particles.
    fn send_particles(&mut self, model: &Model, state: &State) -> Result<(), DeviceError> {
        let Stepper { device, tables: t, lister, .. } = self;
        let (p, to, device) = (&state.particles, &mut lister.sorter.particles, device.as_mut());
        t.drive = model.move_inputs();
        (t.has_fluid, t.fluid) =
            (u32::from(model.setup.drag.is_some()), model.setup.drag.unwrap_or_default());
        t.damping = model.setup.local_damping.unwrap_or(0.0);
        t.overlap_limit = model.setup.guards.overlap;
        t.particle_count = p.len() as u32;
        (t.rotates, t.torques) = (u32::from(model.rotates), u32::from(state.torques(model)));
        t.particles.rows = to.rows.write(device, &p.rows)?;
        t.particles.spins = to.spins.write(device, &p.spins)?;
        t.particles.acceleration = to.acceleration.write(device, &p.acceleration)?;
        t.particles.angular_acceleration = to.angular_acceleration.write(device, &p.angular_acceleration)?;
        Ok(())
    }

    /// What they are, and where they were listed; lists of them.
    fn send_all(&mut self, model: &Model, state: &State, lists: &NeighbourLists) -> Result<(), DeviceError> {
        let Stepper { device, tables: t, lister, .. } = self;
        let (p, to, device) = (&state.particles, &mut lister.sorter.particles, device.as_mut());
        let material: Vec<u32> = p.material.iter().map(|&m| u32::from(m)).collect();
        t.particles.home = to.home.write(device, &p.home)?;
        t.particles.material = to.material.write(device, &material)?;
        lister.fixed.send(&mut Work { device, t }, model)?;
        self.number_places()?;
        self.list(model, state, lists, Why::Sent)
    }

    /// Notes where each particle is here.
    fn number_places(&mut self) -> Result<(), DeviceError> {
        let Stepper { device, tables: t, lister, .. } = self;
        let places: Vec<u32> = (0..t.particle_count).collect();
        t.particles.place = lister.sorter.particles.place.write(device.as_mut(), &places)?;
        self.moved = false;
        Ok(())
    }

    fn send_history(&mut self, state: &State) -> Result<(), DeviceError> {
        let Stepper { device, tables: t, lister, .. } = self;
        let (history, device) = (&state.contacts.history, device.as_mut());
        if history.len() != lister.contacts.slots.history {
            return Err(self.differs());
        }
        t.contacts.history = lister.contacts.columns.history.write(device, history)?;
        // All may have a history that has to be cleared.
        t.acts = lister.contacts.acts.write(device, &vec![1_u8; t.slot_count as usize])?;
        Ok(())
    }

    /// Lists of the device are not those that are made here.
    fn differs(&self) -> DeviceError {
        let what = "it lists other contacts than this processor".to_owned();
        DeviceError::Failed { device: self.device.name(), what }
    }

    /// What was flagged; an error where memory of the device is damaged.
    fn flags_are_sound(&mut self) -> Result<DeviceFlags, DeviceError> {
        let mut flags = [DeviceFlags::default()];
        self.flags.read(self.device.as_mut(), &mut flags)?;
        let [flags] = flags;
        if flags.beyond == 0 {
            return Ok(flags);
        }
        let what = "a contact names a particle, a point or a slot that there is not: its memory is damaged"
            .to_owned();
        Err(DeviceError::Failed { device: self.device.name(), what })
    }

    fn list(
        &mut self,
        model: &Model,
        state: &State,
        lists: &NeighbourLists,
        why: Why,
    ) -> Result<(), DeviceError> {
        let Stepper { device, tables: t, lister, flags, .. } = self;
        t.flags = flags.write(device.as_mut(), &[DeviceFlags::default()])?;
        lister.list(&mut Work { device: device.as_mut(), t }, (model, state, lists), why)?;
        self.flags_are_sound()?;
        let lister = &self.lister;
        let composition = |kind: usize| lister.fixed.kinds[kind].composition as usize;
        let mut found: Vec<usize> =
            lister.contacts.slots.segments.iter().map(|s| composition(s.kind)).collect();
        found.sort_unstable();
        found.dedup();
        self.compositions = found;
        Ok(())
    }

    /// Has lists made of the particles where they are now, as [`crate::neighbours::rebuild`] does here. The state is that of the device but for its columns.
    pub fn relist(
        &mut self,
        model: &Model,
        state: &mut State,
        lists: &mut NeighbourLists,
    ) -> Result<(), DeviceError> {
        let start = Instant::now();
        adapt_skin(model, state);
        state.listing.step = state.steps;
        let counted_back = std::mem::take(&mut lists.wall_periods);
        lists.wall_periods = periods_travelled(model, state);
        self.moved = true;
        self.list(model, state, lists, Why::Due(&counted_back))?;
        state.listing.status = ListStatus::Valid;
        state.listing.rebuilds += 1;
        self.listed = Some(state.listing.rebuilds);
        self.times.listing += start.elapsed().as_secs_f64();
        Ok(())
    }

    /// Makes so many steps with walls in their `poses` in each of them, or fewer where lists have to be rebuilt or a guard has to be asked. The state must have been sent; it has to be fetched. `course`: of
    /// particles on their way in, for that many steps.
    pub fn run(
        &mut self,
        most: u64,
        course: Option<&Course>,
        poses: impl Fn(u64) -> Vec<WallPose>,
        mut goes_on: impl FnMut(u64) -> bool,
    ) -> Result<Found, DeviceError> {
        let slowed = self.tables.has_fluid != 0 || self.tables.damping > 0.0;
        let moves = MOVES + self.tables.rotates as usize + 2 * usize::from(slowed);
        // Contacts that last beyond touching are looked at before any of them changes.
        let made = self.lister.fixed.lasts().then_some(MADE);
        let functions: Vec<usize> = made.into_iter().chain(self.compositions.iter().copied()).collect();
        let (mut done, start, meshes) = (0, Instant::now(), self.lister.fixed.meshes.any);
        // From here on the device is ahead.
        self.held = None;
        if let Some(course) = course {
            course
                .send(&mut Work { device: self.device.as_mut(), t: &mut self.tables }, &mut self.carried)?;
        }
        let (starts, carried) =
            (|step| course.is_some_and(|c| c.starts_in(step)), course.map_or(0, Course::len));
        loop {
            let Stepper { device, tables: t, .. } = self;
            let device = device.as_mut();
            t.flags = self.flags.write(device, &[DeviceFlags::default()])?;
            let steps = LAUNCHED.min(u32::try_from(most - done).unwrap_or(u32::MAX));
            let all: Vec<WallPose> = (0..u64::from(steps)).flat_map(|step| poses(done + step)).collect();
            t.poses = self.poses.write(device, &all)?;
            for step in 0..steps {
                if meshes {
                    device.launch(TRIANGLES, t.particle_count as usize, t, step)?;
                }
                for &function in &functions {
                    device.launch(function, t.slot_count as usize, t, step)?;
                }
                let holds = starts(step);
                let given = if holds { step | HOLD } else { step };
                if holds {
                    device.launch(STARTED, carried, t, given)?;
                }
                device.launch(moves, t.particle_count as usize, t, given)?;
                device.launch(CARRIED, carried, t, given)?;
            }
            let flags = self.flags_are_sound()?;
            done += u64::from(if flags.stopped > 0 { flags.stopped } else { steps });
            if flags.deep != 0 && flags.stopped > 0 && starts(flags.stopped - 1) {
                self.times.stepping += start.elapsed().as_secs_f64();
                return Ok(Found { steps: done - 1, flags, held: true });
            }
            // Asked in any case: lists that hold for a few steps end the loop before it would be.
            let wanted = goes_on(done);
            if flags.stopped > 0 || done >= most || !wanted {
                self.times.stepping += start.elapsed().as_secs_f64();
                return Ok(Found { steps: done, flags, held: false });
            }
        }
    }
}

#[cfg(test)]
impl Stepper {
    /// Where the contacts of each particle begin, and these.
    pub fn contacts_of(&mut self) -> [Vec<u32>; 2] {
        let Stepper { device, lister, .. } = self;
        lister.contacts.of_particles(device.as_mut()).expect("a device that works")
    }
}
