//! Steps on a device: what it is sent, how often it is asked, and what is fetched.

use crate::device::refused::refused;
use crate::device::tables::{Plain, Table};
use crate::device::{Device, DeviceError};
use crate::kernel::device_tables::{
    DeviceBlock, DeviceFlags, DeviceKind, DeviceTables, IMAGES, MOVED_SPHERES, PARTICLES, PLANE, SPHERES,
};
use crate::kernel::ported::NAMES;
use crate::kernel::wall_point::WallPose;
use crate::model::{Model, With};
use crate::neighbours::{NeighbourLists, Slots};
use crate::setup::WallShape;
use crate::simd::{BLOCK, Row, Row4, TORQUE};
use crate::state::State;
use crate::threads::change;
use crate::walls::images::Image;
use geom::Vec3;
use std::mem::swap;
use std::time::Instant;

/// Steps that are launched before the device is asked what they found: an answer takes as long as some steps of a small scene.
const LAUNCHED: u32 = 32;

/// A device, with tables for one simulation.
pub struct Stepper {
    device: Box<dyn Device>,
    tables: DeviceTables,
    columns: Columns,
    /// Number of the rebuild whose lists the device has.
    listed: Option<u64>,
    /// Step whose state the device has: that of the host.
    held: Option<u64>,
    /// Which compositions there are contacts of.
    compositions: Vec<usize>,
    fetched: Fetched,
    /// Where the time went so far.
    pub times: DeviceTimes,
}

/// Where the time of a device went [s].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DeviceTimes {
    /// Lists and state were sent.
    pub sending: f64,
    /// Steps were made.
    pub stepping: f64,
    /// The state was fetched.
    pub fetching: f64,
}

/// What is fetched, until all of it is there; the memory is kept from one time to the next.
#[derive(Default)]
struct Fetched {
    rows: Vec<Row>,
    spins: Vec<Row4>,
    acceleration: Vec<Row4>,
    angular_acceleration: Vec<Row4>,
    history: Vec<f64>,
}

/// Everything that the device holds.
#[derive(Default)]
struct Columns {
    rows: Table,
    spins: Table,
    acceleration: Table,
    angular_acceleration: Table,
    home: Table,
    i: Table,
    partner: Table,
    history: Table,
    acts: Table,
    forces: Table,
    moments: Table,
    points: Table,
    poses: Table,
    blocks: Table,
    kinds: Table,
    numbers: Table,
    tiles: Table,
    starts: Table,
    entries: Table,
    flags: Table,
}

/// What some steps found.
#[derive(Debug, Clone, Copy)]
pub struct Found {
    /// Steps done.
    pub steps: u64,
    /// Of the last of them.
    pub flags: DeviceFlags,
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
            columns: Columns::default(),
            listed: None,
            held: None,
            compositions: Vec::new(),
            fetched: Fetched::default(),
            times: DeviceTimes::default(),
        })
    }

    /// What the device is.
    pub fn name(&self) -> String {
        self.device.name()
    }

    /// Sends what the device does not have: lists that were rebuilt, and the state of this instant.
    pub fn send(
        &mut self,
        model: &Model,
        state: &State,
        lists: &mut NeighbourLists,
    ) -> Result<(), DeviceError> {
        let start = Instant::now();
        if self.listed != Some(state.listing.rebuilds) {
            self.send_lists(model, state, lists)?;
            (self.listed, self.held) = (Some(state.listing.rebuilds), None);
        }
        if self.held != Some(state.steps) {
            self.send_state(state)?;
            self.held = Some(state.steps);
        }
        self.times.sending += start.elapsed().as_secs_f64();
        Ok(())
    }

    fn send_lists(
        &mut self,
        model: &Model,
        state: &State,
        lists: &mut NeighbourLists,
    ) -> Result<(), DeviceError> {
        if lists.slots.starts.is_empty() {
            lists.slots.index();
        }
        let Stepper { device, tables: t, columns: c, .. } = self;
        let (slots, device) = (&lists.slots, device.as_mut());
        if u32::try_from(slots.history.max(2 * slots.i.len())).is_err() {
            let what = format!("{} contacts are more than its tables number", slots.len());
            return Err(DeviceError::Failed { device: device.name(), what });
        }
        let (count, torques) = (slots.i.len(), state.torques(model));
        t.drive = model.move_inputs();
        t.overlap_limit = model.setup.guards.overlap;
        (t.particles, t.slots, t.tile) = (slots.particles as u32, count as u32, slots.tile as u32);
        t.walls = model.walls.len() as u32;
        (t.rotates, t.torques) = (u32::from(model.rotates), u32::from(torques));
        let (kinds, numbers) = kinds(model);
        t.kinds = c.kinds.write(device, &kinds)?;
        t.numbers = c.numbers.write(device, &numbers)?;
        t.i = c.i.write(device, &slots.i)?;
        t.partner = c.partner.write(device, &slots.partner)?;
        t.starts = c.starts.write(device, &slots.starts)?;
        t.entries = c.entries.write(device, &slots.entries)?;
        t.tiles = c.tiles.write(device, &first_slots(slots))?;
        t.home = c.home.write(device, &state.particles.home)?;
        t.blocks = c.blocks.write(device, &blocks(slots))?;
        t.points = c.points.write(device, &points(model, state, lists))?;
        let force = model.layout().force();
        t.forces = c.forces.room::<f64>(device, count * force)?;
        t.moments = c.moments.room::<f64>(device, if torques { count * TORQUE } else { 0 })?;
        let mut found: Vec<usize> =
            slots.segments.iter().map(|s| kinds[s.kind].composition as usize).collect();
        found.sort_unstable();
        found.dedup();
        self.compositions = found;
        Ok(())
    }

    fn send_state(&mut self, state: &State) -> Result<(), DeviceError> {
        let Stepper { device, tables: t, columns: c, .. } = self;
        let (p, device) = (&state.particles, device.as_mut());
        t.rows = c.rows.write(device, &p.rows)?;
        t.spins = c.spins.write(device, &p.spins)?;
        t.acceleration = c.acceleration.write(device, &p.acceleration)?;
        t.angular_acceleration = c.angular_acceleration.write(device, &p.angular_acceleration)?;
        t.history = c.history.write(device, &state.contacts.history)?;
        // All may have a history that has to be cleared.
        t.acts = c.acts.write(device, &vec![1_u8; t.slots as usize])?;
        Ok(())
    }

    /// Makes so many steps with walls in their `poses` in each of them, or fewer where lists have to be rebuilt or a guard has to be asked. The state must have been sent; it has to be fetched.
    pub fn run(
        &mut self,
        most: u64,
        poses: impl Fn(u64) -> Vec<WallPose>,
        mut goes_on: impl FnMut() -> bool,
    ) -> Result<Found, DeviceError> {
        let (functions, moves) = (self.compositions.clone(), NAMES.len() + self.tables.rotates as usize);
        let (mut done, start) = (0, Instant::now());
        // From here on the device is ahead.
        self.held = None;
        loop {
            let Stepper { device, tables: t, columns: c, .. } = self;
            let device = device.as_mut();
            t.flags = c.flags.write(device, &[DeviceFlags::default()])?;
            let steps = LAUNCHED.min(u32::try_from(most - done).unwrap_or(u32::MAX));
            let all: Vec<WallPose> = (0..u64::from(steps)).flat_map(|step| poses(done + step)).collect();
            t.poses = c.poses.write(device, &all)?;
            for step in 0..steps {
                for &function in &functions {
                    device.launch(function, t.slots as usize, t, step)?;
                }
                device.launch(moves, t.particles as usize, t, step)?;
            }
            let mut flags = [DeviceFlags::default()];
            c.flags.read(device, &mut flags)?;
            let [flags] = flags;
            done += u64::from(if flags.stopped > 0 { flags.stopped } else { steps });
            if flags.stopped > 0 || done >= most || !goes_on() {
                self.times.stepping += start.elapsed().as_secs_f64();
                return Ok(Found { steps: done, flags });
            }
        }
    }

    /// Brings the state back, `steps` after the one that was sent.
    pub fn fetch(&mut self, state: &mut State, steps: u64) -> Result<(), DeviceError> {
        let start = Instant::now();
        let Stepper { device, columns: c, fetched: f, .. } = self;
        let (p, device) = (&mut state.particles, device.as_mut());
        // All of them or none: a device may fail in between.
        read(device, &c.rows, &mut f.rows, p.rows.len())?;
        read(device, &c.spins, &mut f.spins, p.spins.len())?;
        read(device, &c.acceleration, &mut f.acceleration, p.acceleration.len())?;
        let turned = p.angular_acceleration.len();
        read(device, &c.angular_acceleration, &mut f.angular_acceleration, turned)?;
        read(device, &c.history, &mut f.history, state.contacts.history.len())?;
        swap(&mut p.rows, &mut f.rows);
        swap(&mut p.spins, &mut f.spins);
        swap(&mut p.acceleration, &mut f.acceleration);
        swap(&mut p.angular_acceleration, &mut f.angular_acceleration);
        let history = &f.history;
        change(&mut state.contacts.history, |k, number| *number = history[k]);
        self.held = Some(steps);
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

/// Kinds of contact, and the numbers of their effects.
fn kinds(model: &Model) -> (Vec<DeviceKind>, Vec<f64>) {
    let (mut kinds, mut all) = (Vec::new(), Vec::new());
    for kind in &model.kinds {
        let (name, numbers) = kind.kernel.ported().unwrap_or_default();
        let composition = NAMES.iter().position(|n| *n == name).unwrap_or(NAMES.len()) as u32;
        let mut new =
            DeviceKind { composition, with: PARTICLES, numbers: all.len() as u32, ..DeviceKind::default() };
        match kind.with {
            With::Particles => {}
            With::Images => new.with = IMAGES,
            With::Wall(w) => {
                new.wall = w as u32;
                new.with = if model.walls[w].drives() { MOVED_SPHERES } else { SPHERES };
                if let WallShape::Plane(plane) = &model.setup.walls[w].shape {
                    (new.with, new.plane) = (PLANE, [plane.point.into(), plane.normal.into()]);
                }
            }
        }
        kinds.push(new);
        all.extend(numbers);
    }
    (kinds, all)
}

/// First slot of each tile.
fn first_slots(slots: &Slots) -> Vec<u32> {
    let first =
        |&segment: &usize| slots.segments.get(segment).map_or(slots.i.len(), |s| s.slots.start) as u32;
    slots.tiles.iter().map(first).collect()
}

/// What each block of slots is.
fn blocks(slots: &Slots) -> Vec<DeviceBlock> {
    let mut blocks = Vec::with_capacity(slots.i.len() / BLOCK);
    for (n, s) in slots.segments.iter().enumerate() {
        let end = slots.segments.get(n + 1).map_or(slots.history, |next| next.history);
        let (count, words) = (s.slots.len() / BLOCK, end - s.history);
        let block = |k: usize| DeviceBlock {
            kind: s.kind as u32,
            history: (s.history + k * words / count) as u32,
            point: (s.rows + k * BLOCK) as u32,
        };
        blocks.extend((0..count).map(block));
    }
    blocks
}

/// A row for each contact that is not between two particles: see [`DeviceTables::points`].
fn points(model: &Model, state: &State, lists: &NeighbourLists) -> Vec<Row> {
    let mut points = lists.step.rows.clone();
    let (cell, period) = (state.cell(model), model.cell().lengths());
    for s in lists.slots.segments.iter().filter(|s| s.with != With::Particles) {
        for slot in s.contacts() {
            let point = &mut points[s.rows + s.rank(slot)];
            let partner = lists.slots.partner[slot];
            *point = match s.with {
                With::Images => at_rest((Vec3::zeros(), 0.0), cell.shift(&lists.slots.image[slot])),
                With::Wall(w) => {
                    let (wall, parts) = (&model.walls[w], model.walls[w].parts());
                    let home = wall.sphere(partner % parts);
                    // Their contact points stay where they are.
                    if home.is_some() && !wall.drives() {
                        continue;
                    }
                    at_rest(home.unwrap_or_default(), Image(partner / parts).shift(&period))
                }
                With::Particles => continue,
            };
        }
    }
    points
}

/// Centre and radius of a part as at t = 0, and a shift.
fn at_rest((centre, radius): (Vec3, f64), shift: Vec3) -> Row {
    Row([centre.x, centre.y, centre.z, radius, shift.x, shift.y, shift.z, 0.0])
}
