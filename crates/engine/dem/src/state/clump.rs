//! One clump: its state, and its step.

use crate::setup::Setup;
use crate::space::rotation;
use crate::state::ledger::heavy;
use crate::state::{DrivenBody, Particles};
use geom::Vec3;
use geom::sphere::INERTIA;
use laws::simd::{Row, Row4, fetch};
use nalgebra::{Quaternion, UnitQuaternion};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// One clump: its state at the step, velocities predicted for it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ClumpMotion {
    /// Centre of mass [m].
    pub position: Vec3,
    /// Predicted velocity [m/s].
    pub velocity: Vec3,
    /// Acceleration of the step before [m/s²].
    pub acceleration: Vec3,
    /// Principal axes to space: i, j, k, w.
    pub turn: [f64; 4],
    /// Predicted angular momentum in space [kg·m²/s].
    pub momentum: Vec3,
    /// Torque of the step before [N·m].
    pub torque: Vec3,
    /// Angular velocity of the predicted momentum [rad/s].
    pub spin: Vec3,
    /// Where it was before the last move.
    pub place_before: Vec3,
    /// Its axes then.
    pub turn_before: [f64; 4],
    /// [kg].
    pub mass: f64,
    /// Along the principal axes [1/(kg·m²)].
    pub inverse_inertia: [f64; 3],
    /// Size over that of the shape [–].
    pub scale: f64,
    /// Id of its first member.
    pub id: u32,
    /// Index of its shape.
    pub shape: u32,
    /// First member among all.
    pub first: u32,
    /// Number of members.
    pub count: u32,
    /// Whether the acceleration of the step before is unknown.
    pub starting: bool,
    /// Whether it moves by a prescribed motion.
    pub is_prescribed: bool,
}

/// Members between the one whose row is prefetched and the one that is added.
const AHEAD: usize = 16;

/// Principal axes to space.
pub fn quaternion(q: &[f64; 4]) -> UnitQuaternion<f64> {
    UnitQuaternion::new_unchecked(Quaternion::from(*q))
}

impl ClumpMotion {
    /// Driven by a force of contacts and fluid, at rest and without a moment.
    pub fn driven(&self, force: Vec3, setup: &Setup) -> DrivenBody {
        let [moment, turning, velocity, spin] = [Vec3::zeros(); 4];
        let forces = [force, force + self.weight(setup) * self.mass];
        DrivenBody { inverse_mass: 1.0 / self.mass, forces, moment, turning, velocity, spin }
    }

    /// Of what it is made of [kg/m³].
    fn density(&self, setup: &Setup) -> f64 {
        setup.materials[setup.clumps.shapes[self.shape as usize].material as usize].density
    }

    /// Free fall, less what the fluid that it displaces lifts [m/s²].
    pub fn weight(&self, setup: &Setup) -> Vec3 {
        setup.gravity * heavy(setup, self.density(setup))
    }

    /// What a fluid meets: a sphere of its volume at its centre.
    fn ball(&self, setup: &Setup) -> Row {
        let (p, v) = (self.position, self.velocity);
        let radius = libm::cbrt(0.75 / PI * self.mass / self.density(setup));
        Row([p.x, p.y, p.z, radius, v.x, v.y, v.z, 1.0 / self.mass])
    }

    /// Acceleration by the fluid [m/s²].
    pub fn fluid(&self, setup: &Setup) -> Vec3 {
        setup.drag.map_or_else(Vec3::zeros, |d| d.acceleration(&self.ball(setup), &setup.gravity))
    }

    /// Drag alone [N].
    pub fn drag(&self, setup: &Setup) -> Vec3 {
        setup.drag.map_or_else(Vec3::zeros, |d| d.slowing(&self.ball(setup)) * self.mass)
    }

    /// Its members among all.
    pub fn range(&self) -> std::ops::Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }

    /// Acceleration of the centre and torque about it, from what a free move made of the forces on the members:
    /// F_k = m (a_k − g), M_k = 2/5 m R_k² α_k.
    pub fn gathered(
        &self,
        members: &[u32],
        arms: &[Row4],
        particles: &Particles,
        gravity: &Vec3,
    ) -> (Vec3, Vec3) {
        let turn = quaternion(&self.turn);
        let (mut a, mut torque) = (Vec3::zeros(), Vec3::zeros());
        for (n, &m) in members[self.range()].iter().enumerate() {
            if let Some(&soon) = members.get(self.first as usize + n + AHEAD) {
                fetch(&particles.acceleration, soon as usize);
                fetch(&particles.angular_acceleration, soon as usize);
            }
            let m = m as usize;
            let push = particles.acceleration[m].vector() - gravity;
            let turning = particles.angular_acceleration.get(m).map_or_else(Vec3::zeros, Row4::vector);
            // Most members touch nothing; to add zeros would change no bit.
            if push == Vec3::zeros() && turning == Vec3::zeros() {
                continue;
            }
            a += push;
            torque += (turn * arms[m].vector()).cross(&push);
            let radius = particles.rows[m].radius();
            torque += turning * (INERTIA * radius * radius);
        }
        (a + gravity, torque * self.mass)
    }

    /// One step from the acceleration and the torque of this instant.
    pub fn advance(&mut self, a: Vec3, torque: Vec3, dt: f64) {
        let half = 0.5 * dt;
        (self.place_before, self.turn_before) = (self.position, self.turn);
        let v = self.velocity + (a - self.acceleration) * half;
        self.position += v * dt + a * (half * dt);
        self.velocity = v + a * dt;
        self.acceleration = a;
        let middle = self.momentum + (torque - self.torque) * half + torque * half;
        let turn = rotation::turned(&quaternion(&self.turn), &middle, &self.inverse_inertia, dt);
        self.turn = turn.into_inner().coords.into();
        self.momentum = middle + torque * half;
        self.torque = torque;
        self.spin = rotation::spin(&turn, &self.momentum, &self.inverse_inertia);
    }

    /// Makes it faster at once [m/s], between the move and the forces of a step of `dt` [s]; the energy that it gets [J].
    pub fn kick(&mut self, by: &Vec3, dt: f64) -> f64 {
        let half_way = self.velocity - self.acceleration * (0.5 * dt);
        self.velocity += by;
        (half_way + by * 0.5).dot(by) * self.mass
    }

    /// Place and velocity of a member, and its last way.
    pub fn point(&self, out: &Row4) -> (Vec3, Vec3, Vec3) {
        let r = quaternion(&self.turn) * out.vector();
        let way = (self.position - self.place_before) + (r - quaternion(&self.turn_before) * out.vector());
        (self.position + r, self.velocity + self.spin.cross(&r), way)
    }
}
