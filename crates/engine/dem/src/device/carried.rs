//! Particles on their way in, as a device moves them: their motion is known ahead, so what it is in each step of a launch is sent before.
//!
//! ```text
//! host    plan: where each is after each step, when it is free       →  rows, steps
//! device  … contacts, started, move, carried …                       what begins to move gets its acceleration after the contacts of its first step
//! host    done: those that were freed in the steps that were made
//! ```

use crate::device::DeviceError;
use crate::device::tables::Table;
use crate::device::work::Work;
use crate::model::Model;
use crate::passes::zones::room;
use crate::state::{Direction, ReturnCounts, State, ZoneParticle};
use geom::Vec3;
use gpu::tables::{DeviceZoneRow, WATCHED};

/// Their tables.
#[derive(Default)]
pub struct Carried {
    at: Table,
    starts: Table,
    rows: Table,
    rows_now: Table,
    free_from: Table,
}

/// What particles on their way in do in the steps of one launch.
#[derive(Default)]
pub struct Course {
    /// How many steps.
    pub steps: u64,
    /// Row of each here: first of those on their way, then of those that have left a zone and begin to move.
    at: Vec<u32>,
    /// In which step each begins to move.
    starts: Vec<u32>,
    /// After each step.
    rows: Vec<DeviceZoneRow>,
    /// After which step each of those on their way is free, if it is.
    frees: Vec<Option<u64>>,
}

/// The step in which one begins to move that does not in this launch.
const NEVER: u32 = u32::MAX;

impl Course {
    /// Of the next `most` steps, or of those before one in which contacts take histories.
    pub fn plan(model: &Model, state: &State, most: u64) -> Course {
        let zones = &state.zones;
        let mut course = Course { steps: most, ..Course::default() };
        course.frees = vec![None; zones.zone_particles.len()];
        course.at = zones.zone_particles.iter().map(|t| t.at).chain(state.starting.iter().copied()).collect();
        'steps: for step in 0..most {
            let time = (state.steps + step + 1) as f64 * state.dt;
            let first = course.rows.len();
            course.rows.resize(first + course.at.len(), DeviceZoneRow::default());
            let mut freed = Vec::new();
            for (n, t) in zones.zone_particles.iter().enumerate().filter(|(n, _)| course.frees[*n].is_none())
            {
                let flow = t.centre_flow(time, zones, &model.setup);
                let [position, centre] = [t.start.position, t.centre].map(|x| x + flow.shift);
                let of = |v: Vec3| [v.x, v.y, v.z];
                course.rows[first + n] = DeviceZoneRow {
                    position: of(position),
                    velocity: of(flow.velocity),
                    acceleration: of(flow.acceleration),
                    spin: of(flow.spin),
                    acts: if room::is_watched(state, t) { WATCHED } else { 1 },
                };
                let past = t.zone(zones).plane.signed_distance(&centre) + t.lead;
                if !(time < t.since || past < 0.0) {
                    freed.push(n);
                }
            }
            if !freed.is_empty() && !zones.histories.is_empty() {
                course.rows.truncate(first);
                course.steps = step;
                break 'steps;
            }
            freed.into_iter().for_each(|n| course.frees[n] = Some(step));
        }
        let start = |free: &Option<u64>| free.map_or(NEVER, |step| step as u32 + 1);
        course.starts = course.frees.iter().map(start).chain(state.starting.iter().map(|_| 0)).collect();
        course
    }

    /// Whether particles begin to move in a step of the launch.
    pub fn starts_in(&self, step: u32) -> bool {
        self.starts.contains(&step)
    }

    /// Sends it.
    pub fn send(&self, work: &mut Work, tables: &mut Carried) -> Result<(), DeviceError> {
        let zones = &mut work.t.zones;
        zones.count = self.at.len() as u32;
        zones.at = tables.at.write(work.device, &self.at)?;
        zones.starts = tables.starts.write(work.device, &self.starts)?;
        zones.rows = tables.rows.write(work.device, &self.rows)?;
        let count = work.t.particle_count as usize;
        zones.rows_now = tables.rows_now.room::<u32>(work.device, count)?;
        if work.t.has_fluid != 0 || work.t.damping > 0.0 {
            let mut free_from = vec![0; count];
            self.at.iter().zip(&self.starts).for_each(|(at, step)| free_from[*at as usize] = *step);
            zones.free_from = tables.free_from.write(work.device, &free_from)?;
        }
        work.launch("rows_now", count, 0)
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.at.len()
    }

    /// Frees those that `done` steps have freed; the others of these steps have begun to move. In none of these steps has one met anything that is inserted.
    pub fn done(&self, state: &mut State, done: u64) {
        for n in 0..if done > 0 { state.zones.zone_particles.len() } else { 0 } {
            // The steps of the launch have been counted by now.
            let t = &state.zones.zone_particles[n];
            if room::has_come_in(state, t, state.time()) {
                state.zones.zone_particles[n].clear = true;
            }
        }
        let was = std::mem::take(&mut state.starting);
        if done == 0 {
            state.starting = was;
            return;
        }
        let freed = |n: usize| self.frees[n].filter(|step| *step < done);
        let mut order: Vec<(u64, usize)> =
            (0..self.frees.len()).filter_map(|n| freed(n).map(|step| (step, n))).collect();
        order.sort_unstable();
        for (step, n) in order {
            let t = &state.zones.zone_particles[n];
            let (k, direction) = (t.at as usize, t.direction);
            state.zones.prescribed[k] = false;
            if let Direction::In(inlet) = direction {
                state.zones.lost.freed(k, inlet);
            }
            if step + 1 == done {
                state.starting.push(k as u32);
            }
        }
        let mut n = 0;
        state.zones.zone_particles.retain(|_| {
            n += 1;
            freed(n - 1).is_none()
        });
    }

    /// Whether the next step has to be made here.
    pub fn is_here(model: &Model, state: &State) -> bool {
        !state.zones.histories.is_empty() && Course::plan(model, state, 1).steps == 0
    }
}

/// What steps on a device change of zones, as it was before them.
pub struct Before {
    zone_particles: Vec<ZoneParticle>,
    prescribed: Vec<bool>,
    lost: ReturnCounts,
    starting: Vec<u32>,
}

impl Before {
    /// Of this state.
    pub fn of(State { zones, starting, .. }: &State) -> Before {
        let (zone_particles, prescribed) = (zones.zone_particles.clone(), zones.prescribed.clone());
        Before { zone_particles, prescribed, lost: zones.lost.clone(), starting: starting.clone() }
    }

    /// Puts it back.
    pub fn restore(self, State { zones, starting, .. }: &mut State) {
        (zones.zone_particles, zones.prescribed) = (self.zone_particles, self.prescribed);
        (zones.lost, *starting) = (self.lost, self.starting);
    }
}

/// The step at whose begin the next particle comes in, or what waits for room is looked at.
pub fn next_entry(state: &State) -> Option<u64> {
    let again = (!state.zones.waiting.is_empty()).then_some(state.zones.look_again);
    next_due(state).into_iter().chain(again).min()
}

/// The step at whose begin the next particle is due.
fn next_due(state: &State) -> Option<u64> {
    let time = state.zones.pending.front()?.time;
    // Rounded in one direction or the other.
    let mut step = (time / state.dt).max(0.0) as u64;
    while step as f64 * state.dt < time {
        step += 1;
    }
    while step > 0 && (step - 1) as f64 * state.dt >= time {
        step -= 1;
    }
    Some(step)
}

impl State {
    /// Takes the particles in the order that a device has put them into: what stands in columns that it has not.
    pub fn follow_device(&mut self, order: &[u32]) {
        let rows = crate::state::row_order::RowOrder::of(order, order.len());
        self.particles.take_names(order);
        self.zones.reorder(&rows);
        self.starting.iter_mut().for_each(|k| *k = rows.new[*k as usize]);
    }
}
