//! Clumps at one instant, for observers.

use crate::model::Model;
use crate::setup::Setup;
use crate::space::rotation;
use crate::state::clump::quaternion;
use crate::state::{ClumpMotion, DrivenBody, RigidClumps, State};
use geom::Vec3;
use laws::contact::WrenchSums;
use laws::slowing::local_damping::against;
use laws::space::cell::Cell;
use nalgebra::UnitQuaternion;

/// A clump at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClumpState {
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

impl ClumpState {
    /// Whether a particle is one of its members.
    pub fn has(&self, particle: u32) -> bool {
        particle.wrapping_sub(self.id) < self.members
    }
}

/// Velocity and angular velocity of a clump, its angular momentum, and what contacts do to it.
#[derive(Default)]
struct Instant {
    velocity: Vec3,
    spin: Vec3,
    momentum: Vec3,
    force: Vec3,
    torque: Vec3,
    /// What local damping takes [W].
    damped: f64,
}

/// What moves a clump, local damping included.
pub struct Damped {
    pub acceleration: Vec3,
    pub torque: Vec3,
    /// What the damping takes [W].
    pub power: f64,
}

/// The acceleration and the torque of a clump, with local damping where the setup asks for it: against the velocity of its centre and its spin.
pub fn damped(f: &ClumpMotion, (a, torque): (Vec3, Vec3), setup: &Setup, cell: &Cell) -> Damped {
    let Some(factor) = setup.local_damping else { return Damped { acceleration: a, torque, power: 0.0 } };
    let slowed = against(factor, &a, &(f.velocity - cell.flow(&f.position)));
    let turned = against(factor, &torque, &f.spin);
    let power = -slowed.dot(&f.velocity) * f.mass - turned.dot(&f.spin);
    Damped { acceleration: a + slowed, torque: torque + turned, power }
}

impl RigidClumps {
    /// The clumps in the calculation with velocities of this instant, by id.
    pub fn states(&self, model: &Model, state: &State) -> Vec<ClumpState> {
        let (mut states, cell) = (self.states_as_listed(model, state), state.cell(model));
        for s in &mut states {
            if cell.moves() {
                s.velocity -= cell.away(&s.position).component_mul(&cell.speed);
            }
            s.position = cell.wrapped(s.position);
        }
        states
    }

    /// The same, where they are between two listings, which may be beyond a periodic face.
    pub fn states_as_listed(&self, model: &Model, state: &State) -> Vec<ClumpState> {
        let (sums, hidden) = (state.contacts.sums(), state.zones.hidden(state.time()));
        let of = |f: &ClumpMotion| {
            let Instant { velocity, spin, momentum, .. } = self.instant(f, model, state, &sums);
            let shape = &model.setup.clumps.shapes[f.shape as usize];
            ClumpState {
                id: f.id,
                shape: f.shape,
                members: f.count,
                scale: f.scale,
                mass: f.mass,
                position: f.position,
                orientation: quaternion(&f.turn) * shape.frame.inverse(),
                velocity,
                spin,
                angular_momentum: momentum,
            }
        };
        let seen = |f: &&ClumpMotion| !hidden(self.members[f.first as usize] as usize);
        let mut states: Vec<ClumpState> = self.flights.iter().filter(seen).map(of).collect();
        states.sort_by_key(|s| s.id);
        states
    }

    fn instant(&self, f: &ClumpMotion, model: &Model, state: &State, sums: &WrenchSums) -> Instant {
        let (mut velocity, mut momentum) = (f.velocity, f.momentum);
        let turn = quaternion(&f.turn);
        let (mut force, mut torque, mut taken) = (Vec3::zeros(), Vec3::zeros(), 0.0);
        if !f.is_prescribed {
            for &m in &self.members[f.range()] {
                let radius = state.particles.rows[m as usize].radius();
                let (push, moment) = sums.on(m as usize, radius);
                force += push;
                torque += (turn * self.arms[m as usize].vector()).cross(&push) + moment;
            }
            let a = force / f.mass + model.setup.gravity + f.fluid(&model.setup);
            let slowed = damped(f, (a, torque), &model.setup, &state.cell(model));
            (force, torque, taken) =
                (force + (slowed.acceleration - a) * f.mass, slowed.torque, slowed.power);
            velocity += (slowed.acceleration - f.acceleration) * (0.5 * model.dt);
            momentum += (torque - f.torque) * (0.5 * model.dt);
        }
        let spin = rotation::spin(&turn, &momentum, &f.inverse_inertia);
        Instant { velocity, spin, momentum, force, torque, damped: taken }
    }

    /// What drives each clump that is free, at this instant, and the row of its first member.
    pub fn driven_now<'a>(
        &'a self,
        model: &'a Model,
        state: &'a State,
        sums: &'a WrenchSums,
    ) -> impl Iterator<Item = (u32, DrivenBody)> + 'a {
        self.flights.iter().filter(|f| !f.is_prescribed).map(move |f| {
            let now = self.instant(f, model, state, sums);
            let Instant { velocity, spin, torque: moment, .. } = now;
            let driven = f.driven(now.force + f.drag(&model.setup), &model.setup);
            let turning = rotation::spin(&quaternion(&f.turn), &moment, &f.inverse_inertia);
            (self.members[f.first as usize], DrivenBody { moment, turning, velocity, spin, ..driven })
        })
    }

    /// What drove each clump that is free in the last move.
    pub fn last_driven<'a>(&'a self, setup: &'a Setup, dt: f64) -> impl Iterator<Item = DrivenBody> + 'a {
        self.flights.iter().filter(|f| !f.is_prescribed).map(move |f| {
            let momentum = f.momentum - f.torque * dt;
            let spin = rotation::spin(&quaternion(&f.turn_before), &momentum, &f.inverse_inertia);
            let force = (f.acceleration - f.weight(setup)) * f.mass;
            let velocity = f.velocity - f.acceleration * dt;
            DrivenBody { moment: f.torque, velocity, spin, ..f.driven(force, setup) }
        })
    }

    /// What the last move's turn of those that are free made of their energy, at a constant angular momentum [J]: 0 up to rounding where
    /// the turn is exact ([`rotation::turned`]), else of the order of the step.
    pub fn made_by_turning(&self, dt: f64) -> f64 {
        let made = |f: &ClumpMotion| {
            let momentum = f.momentum - f.torque * (0.5 * dt);
            let energy = |turn: &[f64; 4]| {
                0.5 * rotation::spin(&quaternion(turn), &momentum, &f.inverse_inertia).dot(&momentum)
            };
            energy(&f.turn) - energy(&f.turn_before)
        };
        self.flights.iter().filter(|f| !f.is_prescribed).map(made).sum()
    }

    /// What local damping takes from those that are free, at this instant [W].
    pub fn damped_power(&self, model: &Model, state: &State, sums: &WrenchSums) -> f64 {
        let free = self.flights.iter().filter(|f| model.setup.local_damping.is_some() && !f.is_prescribed);
        free.map(|f| self.instant(f, model, state, sums).damped).sum()
    }

    /// What a fluid takes from those that are free, at the velocities predicted for them [W].
    pub fn drag_power(&self, setup: &Setup) -> f64 {
        let free = self.flights.iter().filter(|f| setup.drag.is_some() && !f.is_prescribed);
        free.map(|f| -f.drag(setup).dot(&f.velocity)).sum()
    }

    /// Velocity and spin of each member at this instant, by particle; empty without clumps.
    pub fn member_states(
        &self,
        model: &Model,
        state: &State,
        sums: &WrenchSums,
    ) -> Vec<Option<(Vec3, Vec3)>> {
        if self.flights.is_empty() {
            return Vec::new();
        }
        let (cell, mut out) = (state.cell(model), vec![None; state.particles.len()]);
        for f in &self.flights {
            let Instant { velocity, spin, .. } = self.instant(f, model, state, sums);
            for &m in &self.members[f.range()] {
                let r = quaternion(&f.turn) * self.arms[m as usize].vector();
                let velocity = velocity + spin.cross(&r);
                let drift = cell.drift(&self.images[m as usize]);
                out[m as usize] = Some((if cell.moves() { velocity + drift } else { velocity }, spin));
            }
        }
        out
    }
}
