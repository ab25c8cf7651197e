//! Adds up what particles do to walls, over every step; where nothing asks for it there is nothing to do.
//!
//! ```text
//! p = x_w + n R_w d/(r + R_w)       contact point; of a flat wall the nearest point x_w
//! F_w = −F,   T = (p − c) × F_w − C,   P = F_w·v(p) − C·ω
//! ```
//!
//! with the force F and the torque C on the particle, the velocity v(p) and the angular velocity ω of the surface (a belt included), and the
//! reference point c, on the axis of the first motion that turns, and carried along by the wall ([`geom::Motion::reference`]).

use crate::model::{Model, With};
use crate::neighbours::poses::pose_in_box;
use crate::neighbours::{NeighbourLists, Segment};
use crate::passes::touching::position_before;
use crate::state::contacts::SLIDING;
use crate::state::{ContactColumns, State, WallInterval, WallSums};
use geom::Vec3;
use laws::contact::{LEDGER, WrenchSlices, WrenchSums};
use laws::simd::BLOCK;
use laws::space::images::Image;
use laws::space::sphere::inverse_inertia;

/// After the forces of a step and its move: what they did to walls.
pub fn add(model: &Model, state: &mut State, lists: &NeighbourLists) {
    if state.wall_sums.none() {
        return;
    }
    let mut sums = std::mem::take(&mut state.wall_sums);
    let mut touched = std::mem::take(&mut state.contacts.touched);
    let first = state.steps == sums.since;
    let time = if first { 0.5 * model.dt } else { model.dt };
    let reader = Reader::new(model, state, lists, Moved::Yes);
    for segment in &lists.slots.segments {
        let With::Wall(wall) = segment.with else { continue };
        let mut onset = Onset::default();
        for block in segment.slots.clone().step_by(BLOCK) {
            let own = &mut touched[block..block + BLOCK];
            // Where nothing is active all wrenches are 0.
            if !lists.step.active[block / BLOCK] && own.iter().all(|&t| t == 0) {
                continue;
            }
            for slot in block..(block + BLOCK).min(segment.contacts().end) {
                add_slot(
                    &reader,
                    &mut sums,
                    &mut onset,
                    (segment, wall, slot),
                    (&mut own[slot - block], time),
                );
            }
        }
        onset.end(&reader, &mut sums, wall);
    }
    sums.end_instant();
    (state.wall_sums, state.contacts.touched) = (sums, touched);
}

/// What a contact with a wall did in a step.
fn add_slot(
    reader: &Reader,
    sums: &mut WallSums,
    onset: &mut Onset,
    (segment, wall, slot): (&Segment, usize, usize),
    (touched, time): (&mut u8, f64),
) {
    let sliding = reader.sliding(slot);
    let load = if reader.is_pushed(segment, slot) { reader.load(segment, wall, slot) } else { None };
    if load.is_none() && sliding == 0.0 && *touched == 0 {
        return;
    }
    onset.turn_to(reader, reader.lists.slots.i[slot], sums, wall);
    let part = reader.part(wall, slot);
    sums.whole[wall].sliding += sliding;
    if let Some(part) = sums.parts[wall].of(part).filter(|_| sliding != 0.0) {
        part.sliding += sliding;
    }
    onset.before |= *touched != 0;
    if let Some(load) = &load {
        load.add(sums, (wall, part), time);
    }
    let is_new = *touched == 0;
    *touched = u8::from(load.is_some());
    if let Some(load) = load.filter(|_| is_new) {
        onset.note(reader, slot, part, load);
    }
}

/// Takes the sums up to this instant, whose forces are known.
pub fn take(model: &Model, state: &mut State, lists: &NeighbourLists) -> WallInterval {
    let mut sums = std::mem::take(&mut state.wall_sums);
    if state.steps > sums.since {
        let reader = Reader::new(model, state, lists, Moved::No);
        for segment in &lists.slots.segments {
            let With::Wall(wall) = segment.with else { continue };
            for slot in segment.contacts() {
                if let Some(load) = reader.load(segment, wall, slot) {
                    load.add(&mut sums, (wall, reader.part(wall, slot)), 0.5 * model.dt);
                }
            }
        }
        sums.end_instant();
    }
    let taken = sums.take(state.steps, model.dt);
    state.wall_sums = sums;
    taken
}

/// Where the reference point of each wall is at this instant [m].
pub fn references(model: &Model, state: &State, lists: &NeighbourLists) -> Vec<Vec3> {
    let time = state.time();
    let of = |w: usize| model.walls[w].reference(&pose_in_box(model, state, lists, w, time));
    (0..model.walls.len()).map(of).collect()
}

/// Whether particles have been moved since forces were computed.
#[derive(Clone, Copy, PartialEq)]
enum Moved {
    Yes,
    No,
}

/// Reads contacts with walls at the instant of the forces.
struct Reader<'a> {
    model: &'a Model,
    state: &'a State,
    lists: &'a NeighbourLists,
    moved: Moved,
    period: Vec3,
    /// Reference point [m] and angular velocity [rad/s] of each wall.
    walls: Vec<(Vec3, Vec3)>,
}

/// What a contact does to a wall.
struct Load {
    force: Vec3,
    /// About the reference point [N·m].
    torque: Vec3,
    power: f64,
    normal_force: f64,
    /// From the wall to the particle.
    normal: Vec3,
    /// Contact point [m] and the velocity of the surface there [m/s].
    point: Vec3,
    surface: Vec3,
}

impl Load {
    fn add(&self, sums: &mut WallSums, (wall, part): (usize, u32), time: f64) {
        let whole = &mut sums.whole[wall];
        whole.now += self.force;
        whole.impulse += self.force * time;
        whole.moment += self.torque * time;
        whole.work += self.power * time;
        whole.normal += self.normal_force * time;
        if let Some(part) = sums.parts[wall].of(part) {
            part.normal += self.normal_force * time;
            part.largest = part.largest.max(self.normal_force);
        }
    }
}

impl<'a> Reader<'a> {
    fn new(model: &'a Model, state: &'a State, lists: &'a NeighbourLists, moved: Moved) -> Reader<'a> {
        let time = state.time();
        let of = |w: usize| {
            let wall = &model.walls[w];
            if !wall.moves() {
                return (wall.motion.reference(), Vec3::zeros());
            }
            let pose = pose_in_box(model, state, lists, w, time);
            (wall.reference(&pose), pose.turn)
        };
        let walls = (0..model.walls.len()).map(of).collect();
        Reader { model, state, lists, moved, period: model.cell().lengths(), walls }
    }

    /// Number of the sphere or triangle, in the order in which its wall was given.
    fn part(&self, wall: usize, slot: usize) -> u32 {
        let body = &self.model.walls[wall];
        body.given(self.lists.slots.partner[slot] % body.parts())
    }

    /// Sliding work of a contact in the step [J]; 0 without the ledger.
    fn sliding(&self, slot: usize) -> f64 {
        self.state.contacts.ledger.get(slot * LEDGER + SLIDING).copied().unwrap_or(0.0)
    }

    /// Where the wrench of a contact is kept.
    #[inline]
    fn row_of(&self, segment: &Segment, slot: usize) -> (WrenchSlices<'_>, usize) {
        let ContactColumns { wrenches, keeps, .. } = &self.state.contacts;
        match keeps {
            true => (wrenches.slices(), slot),
            false => (self.lists.step.wall_wrenches.slices(), segment.rows + segment.rank(slot)),
        }
    }

    /// Whether any word of a force is not 0: most listed contacts do not touch, and are passed over at once.
    #[inline]
    fn is_pushed(&self, segment: &Segment, slot: usize) -> bool {
        let (sums, row) = self.row_of(segment, slot);
        let words = self.state.contacts.layout.force();
        sums.forces[row * words..(row + 1) * words].iter().any(|&word| word != 0.0)
    }

    /// Force on the particle of a contact, and torque besides; `None` where there is none.
    #[inline]
    fn wrench(&self, segment: &Segment, slot: usize) -> Option<(Vec3, Vec3)> {
        let layout = &self.state.contacts.layout;
        let (sums, row) = self.row_of(segment, slot);
        let force = layout.force_at(sums.forces, row);
        if force == Vec3::zeros() {
            return None;
        }
        let torque = match sums.torques.is_empty() {
            true => Vec3::zeros(),
            false => WrenchSums { first: 0, layout: *layout, sums }.on(row, 0.0).1,
        };
        Some((force, torque))
    }

    #[inline]
    fn load(&self, segment: &Segment, wall: usize, slot: usize) -> Option<Load> {
        let (force, torque) = self.wrench(segment, slot)?;
        let zones = &self.state.zones;
        let idle = |k: u32| zones.is_gone(k as usize) || zones.is_idle((k, None));
        if !zones.none() && idle(self.lists.slots.i[slot]) {
            return None;
        }
        Some(self.load_of(segment, (wall, slot), (force, torque)))
    }

    fn load_of(
        &self,
        segment: &Segment,
        (wall, slot): (usize, usize),
        (force, torque): (Vec3, Vec3),
    ) -> Load {
        let k = self.lists.slots.i[slot] as usize;
        let row = segment.rows + segment.rank(slot);
        let (at, radius) = (self.lists.step.rows[row].position(), self.lists.step.rows[row].radius());
        let apart = self.position(k) - at;
        let distance = apart.norm();
        let normal = apart.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        let point = at + normal * (radius * distance / (self.state.particles.rows[k].radius() + radius));
        let (reference, turn) = self.walls[wall];
        let spin = self.lists.step.spins.get(row).map_or(turn, |spin| spin.vector());
        let surface = self.lists.step.rows[row].velocity() + spin.cross(&(point - at));
        let image = Image(self.lists.slots.partner[slot] / self.model.walls[wall].parts());
        let lever = point - image.shift(&self.period) - reference;
        Load {
            force: -force,
            torque: -lever.cross(&force) - torque,
            power: -force.dot(&surface) - torque.dot(&spin),
            normal_force: force.dot(&normal).abs(),
            normal,
            point,
            surface,
        }
    }

    /// Whether particle `k` was moved after its forces were computed.
    fn was_moved(&self, k: usize) -> bool {
        self.moved == Moved::Yes && !self.state.sleepers.as_ref().is_some_and(|s| s.sleeps(k))
    }

    /// Where particle `k` was when forces were computed [m].
    fn position(&self, k: usize) -> Vec3 {
        if self.was_moved(k) {
            position_before(self.model, self.state, k)
        } else {
            self.state.particles.position(k)
        }
    }

    /// Energy of the approach of a particle to a wall along the normal and along the surface [J]. `kick`: what the contacts that have just begun have
    /// done to it; half a step of that is in its velocity by now.
    fn impact(&self, slot: usize, load: &Load, kick: &Kick) -> [f64; 2] {
        let (k, p) = (self.lists.slots.i[slot] as usize, &self.state.particles);
        let since = if self.was_moved(k) { self.model.dt } else { 0.0 };
        let (spin, angular_acceleration) = p.rotation(k);
        let mut velocity = p.rows[k].velocity() - p.acceleration[k].vector() * since;
        let mut spin = spin - angular_acceleration * since;
        let inverse_mass = p.rows[k].inverse_mass();
        // Clumps move by the forces on all their members; what begins to move has no half step behind it.
        if !self.state.clumps.is_member(k) && self.state.steps > 0 {
            velocity -= kick.force * (0.5 * since * inverse_mass);
            spin -= kick.moment * (0.5 * since * inverse_inertia(p.rows[k].radius(), inverse_mass));
        }
        let slip = velocity + spin.cross(&(load.point - self.position(k))) - load.surface;
        let along = slip.dot(&load.normal);
        let mass = 1.0 / inverse_mass;
        [0.5 * mass * along * along, 0.5 * mass * (slip - load.normal * along).norm_squared()]
    }
}

/// Force on a particle and its moment about the centre.
#[derive(Default)]
struct Kick {
    force: Vec3,
    moment: Vec3,
}

/// Whether a particle comes to touch a wall: its contacts with one wall follow each other.
#[derive(Default)]
struct Onset {
    particle: Option<u32>,
    /// Whether it touched the wall a step before.
    before: bool,
    /// The new contact that is pressed most: its slot, its part of the wall, and its load.
    strongest: Option<(usize, u32, Load)>,
    /// What all new contacts do.
    kick: Kick,
}

impl Onset {
    /// Goes on with a contact of particle `i`.
    fn turn_to(&mut self, reader: &Reader, i: u32, sums: &mut WallSums, wall: usize) {
        if self.particle != Some(i) {
            self.end(reader, sums, wall);
            self.particle = Some(i);
        }
    }

    fn note(&mut self, reader: &Reader, slot: usize, part: u32, load: Load) {
        let arm = load.point - reader.position(reader.lists.slots.i[slot] as usize);
        self.kick.force -= load.force;
        self.kick.moment -= arm.cross(&load.force);
        if self.strongest.as_ref().is_none_or(|(.., most)| load.normal_force > most.normal_force) {
            self.strongest = Some((slot, part, load));
        }
    }

    /// Counts the impact of the particle, if it was one, and begins with the next particle.
    fn end(&mut self, reader: &Reader, sums: &mut WallSums, wall: usize) {
        let Onset { before, strongest, kick, .. } = std::mem::take(self);
        let Some((slot, part, load)) = strongest.filter(|_| !before) else { return };
        let energy = reader.impact(slot, &load, &kick);
        let whole = &mut sums.whole[wall];
        whole.impacts += 1;
        (0..2).for_each(|k| whole.impact_energy[k] += energy[k]);
        if let Some(part) = sums.parts[wall].of(part) {
            part.impacts += 1;
            (0..2).for_each(|k| part.impact_energy[k] += energy[k]);
        }
    }
}
