//! Rigid clumps: several spheres that move as one body.
//!
//! Every sphere of a clump (a member) is an ordinary row of the particles, with the mass of the whole body, the velocity of its own centre and the
//! spin of the body, so that contacts, walls, images and lists know nothing of clumps. After each move, which treated members as
//! if they were free, this pass takes the force on each from its acceleration, moves the body, and writes the members' rows:
//!
//! ```text
//! F = Σ F_k,   τ = Σ (r_k × F_k + M_k)              in the order of the members
//! v_n = v* + (a_n − a_{n−1}) Δt/2,   L_n = L* + (τ_n − τ_{n−1}) Δt/2        as in [`crate::advance`]
//! x ← x + v_n Δt + a_n Δt²/2,   v* ← v_n + a_n Δt
//! R ← free turn of L_n + τ_n Δt/2 over Δt ([`turn`]),   L* ← L_n + τ_n Δt
//! ```
//!
//! L is kept in space: without torque it never changes. Kick, turn, kick: Dullweber, Leimkuhler & McLachlan (1997), J. Chem. Phys.
//! 107, doi:10.1063/1.474310. Members of one body never form a contact: such pairs are left out of the lists.

mod check;
mod shape;
mod turn;

pub(crate) use check::check;
pub use shape::ClumpShape;

use crate::advance::{Loads, Moved};
use crate::lane::{Row, Row4};
use crate::particles::Particles;
use crate::setup::{Body, Clumps, Material, Particle, Setup};
use geom::Vec3;
use nalgebra::{Quaternion, UnitQuaternion};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Who belongs to no body.
const FREE: u32 = u32::MAX;
/// Bodies, or rows, of one task.
const CHUNK: usize = 256;

/// One body: its state at the step, velocities predicted for it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Flight {
    /// Centre of mass [m].
    place: Vec3,
    /// Predicted velocity [m/s].
    velocity: Vec3,
    /// Acceleration of the step before [m/s²].
    acceleration: Vec3,
    /// Principal axes to space: i, j, k, w.
    turn: [f64; 4],
    /// Predicted angular momentum in space [kg·m²/s].
    momentum: Vec3,
    /// Torque of the step before [N·m].
    torque: Vec3,
    /// Angular velocity of the predicted momentum [rad/s].
    spin: Vec3,
    /// Where it was before the last move.
    place_before: Vec3,
    turn_before: [f64; 4],
    /// [kg].
    mass: f64,
    /// Along the principal axes [1/(kg·m²)].
    inverse_inertia: [f64; 3],
    scale: f64,
    id: u32,
    shape: u32,
    /// First member among all.
    first: u32,
    count: u32,
    /// Whether the acceleration of the step before is unknown.
    fresh: bool,
    /// Whether it moves by a prescribed motion.
    travels: bool,
}

fn quaternion(q: &[f64; 4]) -> UnitQuaternion<f64> {
    UnitQuaternion::new_unchecked(Quaternion::from(*q))
}

/// A body at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyState {
    /// Id of its first member; the others follow.
    pub id: u32,
    /// Index of its shape.
    pub shape: u32,
    /// Number of its members.
    pub members: u32,
    /// Size over that of the shape [–].
    pub scale: f64,
    /// [kg].
    pub mass: f64,
    /// Centre of mass [m].
    pub position: Vec3,
    /// From the frame that the shape was given in to space.
    pub orientation: UnitQuaternion<f64>,
    /// Of the centre of mass [m/s].
    pub velocity: Vec3,
    /// [rad/s].
    pub spin: Vec3,
    /// R I Rᵀ ω about the centre of mass [kg·m²/s].
    pub angular_momentum: Vec3,
}

/// All bodies of a simulation, and who their members are.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Bodies {
    flights: Vec<Flight>,
    /// Rows of the members, body after body.
    members: Vec<u32>,
    /// The body of each row, or [`FREE`]; empty without bodies.
    of: Vec<u32>,
    /// Place of each row in its body, in the principal frame [m].
    arms: Vec<Row4>,
    /// Periods between each row and its place in the body: members lie in the periodic box, each by itself.
    images: Vec<[i8; 3]>,
}

/// Velocity and angular velocity of a body, and its angular momentum.
struct Instant {
    velocity: Vec3,
    spin: Vec3,
    momentum: Vec3,
}

impl Bodies {
    /// The bodies of a setup at t = 0; their members are added to the particles.
    pub fn new(setup: &Setup, particles: &mut Particles) -> Bodies {
        let mut bodies = Bodies::default();
        let mut sorted: Vec<&Body> = setup.clumps.bodies.iter().collect();
        sorted.sort_unstable_by_key(|b| b.id);
        for body in sorted {
            bodies.push(body, &setup.clumps.shapes[body.shape as usize], &setup.materials, particles);
        }
        bodies
    }

    /// Whether there is none.
    pub fn none(&self) -> bool {
        self.flights.is_empty()
    }

    /// Adds a body, its members at the end of the particles.
    pub fn push(
        &mut self,
        body: &Body,
        shape: &ClumpShape,
        materials: &[Material],
        particles: &mut Particles,
    ) {
        let density = materials[shape.material as usize].density;
        let (s, mass) = (body.scale, shape.mass(body.scale, density));
        let inverse_inertia = shape.inertia.map(|i| 1.0 / (i * density * s * s * s * s * s));
        let turn = body.orientation * shape.frame;
        self.of.resize(particles.len(), FREE);
        self.arms.resize(particles.len(), Row4::default());
        self.images.resize(particles.len(), [0; 3]);
        let (flight, first) = (self.flights.len() as u32, self.members.len() as u32);
        for (k, (centre, radius)) in shape.spheres.iter().enumerate() {
            let arm = centre * s;
            let out = turn * arm;
            let at = particles.len();
            particles.push(
                &Particle {
                    id: body.id.wrapping_add(k as u32),
                    material: shape.material,
                    radius: radius * s,
                    position: body.position + out,
                    velocity: body.velocity + body.spin.cross(&out),
                    spin: body.spin,
                },
                materials,
            );
            particles.rows[at][7] = 1.0 / mass;
            self.members.push(at as u32);
            self.of.push(flight);
            self.arms.push(Row4([arm.x, arm.y, arm.z, 0.0]));
            self.images.push([0; 3]);
        }
        let momentum = turn::momentum(&turn, &body.spin, &inverse_inertia);
        let turn = turn.into_inner().coords.into();
        self.flights.push(Flight {
            place: body.position,
            velocity: body.velocity,
            acceleration: Vec3::zeros(),
            turn,
            momentum,
            torque: Vec3::zeros(),
            spin: body.spin,
            place_before: body.position,
            turn_before: turn,
            mass,
            inverse_inertia,
            scale: s,
            id: body.id,
            shape: body.shape,
            first,
            count: shape.spheres.len() as u32,
            fresh: true,
            travels: false,
        });
    }

    /// Takes the pairs of one body's own members out of a list.
    pub fn drop_own<T>(&self, list: &mut Vec<T>, pair: impl Fn(&T) -> (u32, u32)) {
        if !self.none() {
            let of = |k: u32| self.of.get(k as usize).copied().unwrap_or(FREE);
            list.retain(|p| {
                let (i, j) = pair(p);
                of(i) == FREE || of(i) != of(j)
            });
        }
    }

    /// Whether a row is a member of a body.
    pub fn is_member(&self, k: usize) -> bool {
        self.of.get(k).is_some_and(|&b| b != FREE)
    }

    /// Follows the particles to their new places; `order` names the old ones of those that stay. Bodies stay or leave whole.
    pub fn reorder(&mut self, order: &[u32]) {
        if self.none() {
            return;
        }
        let mut new = vec![FREE; self.of.len().max(order.len())];
        for (n, &o) in order.iter().enumerate() {
            new[o as usize] = n as u32;
        }
        self.members.iter_mut().for_each(|m| *m = new[*m as usize]);
        let before = std::mem::take(&mut self.of);
        let old = |o: &u32| before.get(*o as usize).copied().unwrap_or(FREE);
        self.of = order.iter().map(old).collect();
        self.arms = order.iter().map(|&o| self.arms.get(o as usize).copied().unwrap_or_default()).collect();
        self.images =
            order.iter().map(|&o| self.images.get(o as usize).copied().unwrap_or_default()).collect();
    }

    /// Moves the bodies whose members have been moved as if they were free, and puts the members in their places.
    pub fn advance(&mut self, particles: &mut Particles, setup: &Setup, dt: f64) -> Moved {
        let (members, arms) = (&self.members, &self.arms);
        let seen = &*particles;
        self.flights.par_chunks_mut(CHUNK).for_each(|chunk| {
            for f in chunk.iter_mut().filter(|f| !f.travels) {
                let (a, torque) = f.gathered(members, arms, seen, &setup.gravity);
                f.advance(a, torque, dt);
            }
        });
        self.place(particles, setup, dt)
    }

    /// Bodies without a past get the acceleration and the torque of this instant as those of the step before.
    pub fn prime(&mut self, particles: &Particles, gravity: &Vec3) {
        let (members, arms) = (&self.members, &self.arms);
        for f in self.flights.iter_mut().filter(|f| f.fresh && !f.travels) {
            (f.acceleration, f.torque) = f.gathered(members, arms, particles, gravity);
            f.fresh = false;
        }
    }

    /// Writes the members' rows.
    fn place(&self, particles: &mut Particles, setup: &Setup, dt: f64) -> Moved {
        let flights = &self.flights;
        let (periods, motion_limit) = (periods(&setup.periodic), setup.guards.motion);
        let flight = |of: &u32| flights.get(*of as usize).filter(|f| !f.travels);
        let spins = (&mut particles.spins, &self.of).into_par_iter().with_min_len(CHUNK);
        spins.for_each(|(spin, of)| {
            if let Some(f) = flight(of) {
                *spin = Row4([f.spin.x, f.spin.y, f.spin.z, 0.0]);
            }
        });
        let seats = (&self.of, &self.arms, &self.images).into_par_iter();
        let columns = (&mut particles.rows, &mut particles.acceleration, &particles.home, seats);
        let moved = |(row, acceleration, h, seat): (&mut Row, &mut Row4, &Row4, Seat)| {
            let (of, out, image) = seat;
            let Some(f) = flight(of) else { return Moved::default() };
            let (place, velocity, way) = f.point(out);
            let place = place + far(image, &periods);
            row[..3].copy_from_slice(place.as_slice());
            row[4..7].copy_from_slice(velocity.as_slice());
            // What brings it back to where it was: `position_before`.
            let a = (velocity * dt - way) * (2.0 / (dt * dt));
            *acceleration = Row4([a.x, a.y, a.z, 0.0]);
            let limit = motion_limit * row[3];
            let wild = !(way.norm_squared() <= limit * limit);
            Moved { out: (place - arm(h)).norm_squared() > h[3] * h[3], wild }
        };
        columns.into_par_iter().with_min_len(CHUNK).map(moved).reduce(Moved::default, Moved::and)
    }

    /// Brings bodies, and each of their members, back into the periodic box.
    pub fn wrap(&mut self, particles: &mut Particles, periodic: &[Option<(f64, f64)>; 3]) {
        let periods = periods(periodic);
        let away =
            |p: &Vec3, a: usize| periodic[a].map_or(0.0, |(lo, hi)| -((p[a] - lo) / (hi - lo)).floor());
        let there = |p: Vec3| [0, 1, 2].map(|a| away(&p, a));
        for f in &mut self.flights {
            let shift = Vec3::from(there(f.place)).component_mul(&periods);
            f.place += shift;
            f.place_before += shift;
            for &m in &self.members[f.first as usize..(f.first + f.count) as usize] {
                let m = m as usize;
                let place = f.place + quaternion(&f.turn) * arm(&self.arms[m]);
                self.images[m] = there(place).map(|n| n as i8);
                let place = place + far(&self.images[m], &periods);
                particles.rows[m][..3].copy_from_slice(place.as_slice());
            }
        }
    }

    /// The bodies with velocities of this instant, by id.
    pub fn states(&self, particles: &Particles, loads: &Loads, setup: &Setup, dt: f64) -> Vec<BodyState> {
        let state = |f: &Flight| {
            let Instant { velocity, spin, momentum } = self.instant(f, particles, loads, &setup.gravity, dt);
            let shape = &setup.clumps.shapes[f.shape as usize];
            BodyState {
                id: f.id,
                shape: f.shape,
                members: f.count,
                scale: f.scale,
                mass: f.mass,
                position: f.place,
                orientation: quaternion(&f.turn) * shape.frame.inverse(),
                velocity,
                spin,
                angular_momentum: momentum,
            }
        };
        let mut states: Vec<BodyState> = self.flights.iter().map(state).collect();
        states.sort_by_key(|s| s.id);
        states
    }

    fn instant(&self, f: &Flight, particles: &Particles, loads: &Loads, gravity: &Vec3, dt: f64) -> Instant {
        let (mut velocity, mut momentum) = (f.velocity, f.momentum);
        let turn = quaternion(&f.turn);
        if !f.travels {
            let (mut force, mut torque) = (Vec3::zeros(), Vec3::zeros());
            for &m in &self.members[f.first as usize..(f.first + f.count) as usize] {
                let (push, moment) = loads.on(m as usize, particles.rotates());
                let push = Vec3::from(push);
                force += push;
                torque += (turn * arm(&self.arms[m as usize])).cross(&push) + Vec3::from(moment);
            }
            velocity += (force / f.mass + gravity - f.acceleration) * (0.5 * dt);
            momentum += (torque - f.torque) * (0.5 * dt);
        }
        Instant { velocity, spin: turn::spin(&turn, &momentum, &f.inverse_inertia), momentum }
    }

    /// Velocity and spin of each member at this instant: row, velocity, spin.
    pub fn member_states(
        &self,
        particles: &Particles,
        loads: &Loads,
        gravity: &Vec3,
        dt: f64,
    ) -> Vec<Option<(Vec3, Vec3)>> {
        let mut out = vec![None; particles.len()];
        for f in &self.flights {
            let Instant { velocity, spin, .. } = self.instant(f, particles, loads, gravity, dt);
            for &m in &self.members[f.first as usize..(f.first + f.count) as usize] {
                let r = quaternion(&f.turn) * arm(&self.arms[m as usize]);
                out[m as usize] = Some((velocity + spin.cross(&r), spin));
            }
        }
        out
    }

    /// Memory of one body, and of each of its members beyond a particle's [bytes].
    pub fn bytes() -> (usize, usize) {
        (size_of::<Flight>(), 2 * size_of::<u32>() + size_of::<Row4>() + size_of::<[i8; 3]>())
    }

    /// Memory of all bodies [bytes].
    pub fn all_bytes(&self) -> usize {
        let (flights, members, arms) = (&self.flights[..], &self.members[..], &self.arms[..]);
        size_of_val(flights)
            + size_of_val(members)
            + size_of_val(&self.of[..])
            + size_of_val(arms)
            + size_of_val(&self.images[..])
    }
}

/// Body, arm and image of a row.
type Seat<'a> = (&'a u32, &'a Row4, &'a [i8; 3]);

/// Periods along x, y, z [m]; 0 along an open axis.
fn periods(periodic: &[Option<(f64, f64)>; 3]) -> Vec3 {
    Vec3::from(periodic.map(|p| p.map_or(0.0, |(lo, hi)| hi - lo)))
}

fn far(image: &[i8; 3], periods: &Vec3) -> Vec3 {
    Vec3::from(image.map(f64::from)).component_mul(periods)
}

fn arm(row: &Row4) -> Vec3 {
    Vec3::new(row[0], row[1], row[2])
}

/// How easily a rigid clump gives way, for the critical step.
#[derive(Debug, Clone, PartialEq)]
pub struct Yielding {
    /// Name of the shape.
    pub name: String,
    /// Its material.
    pub material: u16,
    /// Largest radius of its members [m].
    pub radius: f64,
    /// 1/m of the sphere that yields as easily to normal forces [1/kg].
    pub normal: f64,
    /// The like for tangential forces [1/kg].
    pub tangential: f64,
}

impl BodyState {
    /// Whether a particle is one of its members.
    pub fn has(&self, particle: u32) -> bool {
        particle.wrapping_sub(self.id) < self.members
    }
}

impl Clumps {
    /// Shapes and entries, for when the bodies are in their columns.
    pub(crate) fn without_bodies(self) -> Clumps {
        Clumps { bodies: Vec::new(), ..self }
    }

    /// Radius of every member at t = 0 [m], or of every shape that inlets bring where there is none.
    pub(crate) fn member_radii(&self) -> Vec<f64> {
        let of = |(shape, scale): (u32, f64)| {
            let spheres = self.shapes.get(shape as usize).map_or(&[][..], |s| &s.spheres[..]);
            spheres.iter().map(move |s| s.1 * scale)
        };
        if self.bodies.is_empty() {
            return self.entries.iter().map(|e| (e.0, e.1)).flat_map(of).collect();
        }
        self.bodies.iter().map(|b| (b.shape, b.scale)).flat_map(of).collect()
    }

    /// Material, smallest and largest radius [m] of the members of all bodies, those that inlets bring included.
    pub(crate) fn radii(&self) -> impl Iterator<Item = (u16, f64, f64)> + '_ {
        self.scales().map(|(shape, low, high)| {
            let (least, most) = shape.radii();
            (shape.material, least * low, most * high)
        })
    }

    /// How easily bodies of each shape give way, at the smallest and the largest scale.
    pub(crate) fn yielding(&self, materials: &[Material]) -> Vec<Yielding> {
        let mut range: Vec<Option<(f64, f64)>> = vec![None; self.shapes.len()];
        let own = self.bodies.iter().map(|b| (b.shape, b.scale, b.scale));
        for (shape, low, high) in own.chain(self.entries.iter().copied()) {
            if let Some(range) = range.get_mut(shape as usize) {
                *range = Some(range.map_or((low, high), |(l, h)| (l.min(low), h.max(high))));
            }
        }
        let mut list = Vec::new();
        for (shape, (low, high)) in self.shapes.iter().zip(range).filter_map(|(s, r)| Some((s, r?))) {
            let (normal, tangential) = shape.yielding();
            let density = materials[shape.material as usize].density;
            for s in if low == high { vec![low] } else { vec![low, high] } {
                let share = 1.0 / (s * s * s * density);
                list.push(Yielding {
                    name: shape.name.clone(),
                    material: shape.material,
                    radius: shape.radii().1 * s,
                    normal: normal * share,
                    tangential: tangential * share,
                });
            }
        }
        list
    }

    /// Shape, smallest and largest scale of all bodies, those that inlets bring included.
    pub(crate) fn scales(&self) -> impl Iterator<Item = (&ClumpShape, f64, f64)> + '_ {
        let own = self.bodies.iter().map(|b| (b.shape, b.scale, b.scale));
        let all = own.chain(self.entries.iter().copied());
        all.filter_map(|(shape, low, high)| Some((self.shapes.get(shape as usize)?, low, high)))
    }
}

impl Flight {
    /// Acceleration of the centre and torque about it, from what a free move made of the members' loads:
    /// F_k = m (a_k − g), M_k = 2/5 m R_k² α_k.
    fn gathered(
        &self,
        members: &[u32],
        arms: &[Row4],
        particles: &Particles,
        gravity: &Vec3,
    ) -> (Vec3, Vec3) {
        let turn = quaternion(&self.turn);
        let (mut a, mut torque) = (Vec3::zeros(), Vec3::zeros());
        for &m in &members[self.first as usize..(self.first + self.count) as usize] {
            let m = m as usize;
            let push = arm(&particles.acceleration[m]) - gravity;
            a += push;
            torque += (turn * arm(&arms[m])).cross(&push);
            if let Some(turning) = particles.turning.get(m) {
                let radius = particles.rows[m][3];
                torque += arm(turning) * (0.4 * radius * radius);
            }
        }
        (a + gravity, torque * self.mass)
    }

    fn advance(&mut self, a: Vec3, torque: Vec3, dt: f64) {
        let half = 0.5 * dt;
        (self.place_before, self.turn_before) = (self.place, self.turn);
        let v = self.velocity + (a - self.acceleration) * half;
        self.place += v * dt + a * (half * dt);
        self.velocity = v + a * dt;
        self.acceleration = a;
        let middle = self.momentum + (torque - self.torque) * half + torque * half;
        let turn = turn::turned(&quaternion(&self.turn), &middle, &self.inverse_inertia, dt);
        self.turn = turn.into_inner().coords.into();
        self.momentum = middle + torque * half;
        self.torque = torque;
        self.spin = turn::spin(&turn, &self.momentum, &self.inverse_inertia);
    }

    /// Place and velocity of a member, and its last way.
    fn point(&self, out: &Row4) -> (Vec3, Vec3, Vec3) {
        let r = quaternion(&self.turn) * arm(out);
        let way = (self.place - self.place_before) + (r - quaternion(&self.turn_before) * arm(out));
        (self.place + r, self.velocity + self.spin.cross(&r), way)
    }
}
