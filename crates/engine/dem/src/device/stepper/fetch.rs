//! What is fetched from a device.

use super::Stepper;
use crate::device::tables::{Plain, Table};
use crate::device::{Device, DeviceError};
use crate::model::Model;
use crate::neighbours::rebuild::take_lists;
use crate::neighbours::{NeighbourLists, Slots};
use crate::state::{Forces, State};
use crate::threads::change;
use laws::simd::{Row, Row4};
use std::mem::swap;
use std::time::Instant;

/// What is fetched, until all of it is there; the memory is kept from one time to the next.
#[derive(Default)]
pub struct Fetched {
    rows: Vec<Row>,
    spins: Vec<Row4>,
    acceleration: Vec<Row4>,
    angular_acceleration: Vec<Row4>,
    home: Vec<Row4>,
    place: Vec<u32>,
    history: Vec<f64>,
}

impl Stepper {
    /// Brings the wrenches of contacts back, which are those of this instant; the state and its lists have been fetched.
    pub fn fetch_wrenches(&mut self, state: &mut State, lists: &NeighbourLists) -> Result<(), DeviceError> {
        let Stepper { device, lister, .. } = self;
        let (contacts, device, slots) = (&mut state.contacts, device.as_mut(), lists.slots.i.len());
        contacts.keep_wrenches(true, slots);
        let (layout, wrenches) = (contacts.layout, &mut contacts.wrenches);
        let mut acts = vec![0_u8; slots];
        lister.contacts.acts.read(device, &mut acts)?;
        lister.contacts.forces.read(device, &mut wrenches.forces[..])?;
        lister.contacts.moments.read(device, &mut wrenches.torques[..])?;
        for slot in (0..slots).filter(|slot| acts[*slot] == 0) {
            wrenches.forces[slot * layout.force()..][..layout.force()].fill(0.0);
            let torque = if wrenches.torques.is_empty() { 0 } else { layout.torque() };
            wrenches.torques[slot * torque..][..torque].fill(0.0);
        }
        Ok(())
    }

    /// Brings the state back, which is that of the device but for its columns, and lists.
    pub fn fetch(
        &mut self,
        model: &Model,
        state: &mut State,
        lists: &mut NeighbourLists,
    ) -> Result<(), DeviceError> {
        let start = Instant::now();
        let Stepper { device, lister, fetched: f, .. } = self;
        let (from, device, count) = (&lister.sorter.particles, device.as_mut(), state.particles.len());
        let turning = if model.rotates { count } else { 0 };
        // All of them or none: a device may fail in between.
        read(device, &from.rows, &mut f.rows, state.particles.rows.len())?;
        read(device, &from.spins, &mut f.spins, state.particles.spins.len())?;
        read(device, &from.acceleration, &mut f.acceleration, count)?;
        read(device, &from.angular_acceleration, &mut f.angular_acceleration, turning)?;
        read(device, &lister.contacts.columns.history, &mut f.history, lister.contacts.slots.history)?;
        let (moved, mut slots) = (self.moved, Slots::default());
        if moved {
            read(device, &from.home, &mut f.home, count)?;
            read(device, &from.place, &mut f.place, count)?;
            slots = lister.contacts.fetch(device, &model.cell().half_of_images())?;
            self.number_places()?;
        }
        let (p, f) = (&mut state.particles, &mut self.fetched);
        swap(&mut p.rows, &mut f.rows);
        swap(&mut p.spins, &mut f.spins);
        swap(&mut p.acceleration, &mut f.acceleration);
        swap(&mut p.angular_acceleration, &mut f.angular_acceleration);
        if moved {
            swap(&mut p.home, &mut f.home);
            state.follow_device(&f.place);
            take_lists(model, state, lists, slots);
        }
        let history = &self.fetched.history;
        change(&mut state.contacts.history, |k, number| *number = history[k]);
        // The device does not say which blocks act.
        lists.step.active.fill(true);
        state.forces = Forces::Due;
        self.held = Some(state.steps);
        self.times.fetching += start.elapsed().as_secs_f64();
        Ok(())
    }
}

/// Reads so many rows of a table.
fn read<T: Plain + Default>(
    device: &mut dyn Device,
    table: &Table,
    to: &mut Vec<T>,
    rows: usize,
) -> Result<(), DeviceError> {
    to.resize(rows, T::default());
    table.read(device, to)
}
