//! Clumps at one instant, for observers.

use crate::kernel::sums::WrenchSums;
use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::setup::Setup;
use crate::space::rotation;
use crate::state::State;
use crate::state::clump::{ClumpMotion, arm, quaternion};
use crate::state::clumps::RigidClumps;
use crate::state::ledger::DrivenBody;
use crate::state::particles::Particles;
use geom::Vec3;
use nalgebra::UnitQuaternion;

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

impl BodyState {
    /// Whether a particle is one of its members.
    pub fn has(&self, particle: u32) -> bool {
        particle.wrapping_sub(self.id) < self.members
    }
}

/// Velocity and angular velocity of a body, its angular momentum, and what contacts do to it.
#[derive(Default)]
struct Instant {
    velocity: Vec3,
    spin: Vec3,
    momentum: Vec3,
    force: Vec3,
    torque: Vec3,
}

impl RigidClumps {
    /// The bodies in the calculation with velocities of this instant, by id.
    pub fn states(&self, model: &Model, state: &State, lists: &NeighbourLists) -> Vec<BodyState> {
        let (loads, hidden) = (lists.contacts.sums(), state.zones.hidden(state.time()));
        let of = |f: &ClumpMotion| {
            let Instant { velocity, spin, momentum, .. } =
                self.instant(f, &state.particles, &loads, &model.setup, model.dt);
            let shape = &model.setup.clumps.shapes[f.shape as usize];
            BodyState {
                id: f.id,
                shape: f.shape,
                members: f.count,
                scale: f.scale,
                mass: f.mass,
                position: model.wrapped(f.place),
                orientation: quaternion(&f.turn) * shape.frame.inverse(),
                velocity,
                spin,
                angular_momentum: momentum,
            }
        };
        let seen = |f: &&ClumpMotion| !hidden(self.members[f.first as usize] as usize);
        let mut states: Vec<BodyState> = self.flights.iter().filter(seen).map(of).collect();
        states.sort_by_key(|s| s.id);
        states
    }

    fn instant(
        &self,
        f: &ClumpMotion,
        particles: &Particles,
        loads: &WrenchSums,
        setup: &Setup,
        dt: f64,
    ) -> Instant {
        let (mut velocity, mut momentum) = (f.velocity, f.momentum);
        let turn = quaternion(&f.turn);
        let (mut force, mut torque) = (Vec3::zeros(), Vec3::zeros());
        if !f.travels {
            for &m in &self.members[f.range()] {
                let radius = particles.rows[m as usize][3];
                let (push, moment) = loads.on(m as usize, radius);
                let push = Vec3::from(push);
                force += push;
                torque += (turn * arm(&self.arms[m as usize])).cross(&push) + Vec3::from(moment);
            }
            let a = force / f.mass + setup.gravity + f.fluid(setup);
            velocity += (a - f.acceleration) * (0.5 * dt);
            momentum += (torque - f.torque) * (0.5 * dt);
        }
        Instant {
            velocity,
            spin: rotation::spin(&turn, &momentum, &f.inverse_inertia),
            momentum,
            force,
            torque,
        }
    }

    /// What drives each body that is free, at this instant, and the row of its first member.
    pub fn driven_now<'a>(
        &'a self,
        model: &'a Model,
        state: &'a State,
        loads: &'a WrenchSums,
    ) -> impl Iterator<Item = (u32, DrivenBody)> + 'a {
        self.flights.iter().filter(|f| !f.travels).map(move |f| {
            let now = self.instant(f, &state.particles, loads, &model.setup, model.dt);
            let force = now.force + f.drag(&model.setup);
            let driven = f.driven([force, now.torque], (now.velocity, now.spin), &model.setup);
            (self.members[f.first as usize], driven)
        })
    }

    /// What drove each body that is free in the last move.
    pub fn last_driven<'a>(&'a self, setup: &'a Setup, dt: f64) -> impl Iterator<Item = DrivenBody> + 'a {
        self.flights.iter().filter(|f| !f.travels).map(move |f| {
            let momentum = f.momentum - f.torque * dt;
            let spin = rotation::spin(&quaternion(&f.turn_before), &momentum, &f.inverse_inertia);
            let force = (f.acceleration - f.weight(setup)) * f.mass;
            f.driven([force, f.torque], (f.velocity - f.acceleration * dt, spin), setup)
        })
    }

    /// What a fluid takes from those that are free, at the velocities predicted for them [W].
    pub fn drag_power(&self, setup: &Setup) -> f64 {
        let free = self.flights.iter().filter(|f| setup.drag.is_some() && !f.travels);
        free.map(|f| -f.drag(setup).dot(&f.velocity)).sum()
    }

    /// Velocity and spin of each member at this instant, by particle; empty without clumps.
    pub fn member_states(
        &self,
        particles: &Particles,
        loads: &WrenchSums,
        setup: &Setup,
        dt: f64,
    ) -> Vec<Option<(Vec3, Vec3)>> {
        if self.flights.is_empty() {
            return Vec::new();
        }
        let mut out = vec![None; particles.len()];
        for f in &self.flights {
            let Instant { velocity, spin, .. } = self.instant(f, particles, loads, setup, dt);
            for &m in &self.members[f.range()] {
                let r = quaternion(&f.turn) * arm(&self.arms[m as usize]);
                out[m as usize] = Some((velocity + spin.cross(&r), spin));
            }
        }
        out
    }
}
