//! What slows a particle besides its contacts, behind the move: a fluid, and local damping.
//!
//! ```text
//! v* ← v* + 3/2 a Δt,  x ← x + a Δt²,  a_n ← a_n + a          what an acceleration a adds to the move of [`crate::contact::motion`]
//! ```
//!
//! A pass behind the move, so that a scene without them runs the same code as ever.

pub mod fluid;
pub mod local_damping;

use crate::float::Float;
use crate::simd::{Row, Row4};
use crate::space::sphere::inverse_inertia;
use fluid::Drag;
use local_damping::against;
use primitives::Vec3;

/// Adds an acceleration `a` [m/s²] of the instant before a move of `dt` [s] to a particle that has moved without it: to its position, its
/// predicted velocity and its acceleration.
#[inline(always)]
pub fn accelerate(row: &mut Row, acceleration: &mut Row4, a: &Vec3, dt: f64) {
    for axis in 0..3 {
        row[axis] += dt * dt * a[axis];
        row[4 + axis] += 1.5 * dt * a[axis];
        acceleration[axis] += a[axis];
    }
}

/// Whether a particle has left its margin, or will within `ahead` [s], before contacts are looked for.
#[inline(always)]
pub fn has_left(row: &Row, home: &Row4, ahead: f64) -> bool {
    let margin = (home[3] - ahead * row.velocity().norm_squared().root()).max(0.0);
    (row.position() - home.vector()).norm_squared() > margin * margin
}

/// What local damping leaves of an acceleration [m/s² or rad/s²], of a particle that moves like this apart from the flow.
#[inline(always)]
pub fn slowed_at(factor: f64, all: Vec3, velocity: &Vec3) -> Vec3 {
    all + against(factor, &all, velocity)
}

/// A particle that has moved.
pub struct Moved<'a> {
    /// Its row.
    pub row: &'a mut Row,
    /// Acceleration of the step [m/s²].
    pub acceleration: &'a mut Row4,
    /// Its row before.
    pub was: &'a Row,
}

/// How it turns: predicted spin [rad/s], angular acceleration of the step [rad/s²], and the spin before.
pub struct Turned<'a> {
    /// Predicted spin.
    pub spin: &'a mut Row4,
    /// Angular acceleration.
    pub acceleration: &'a mut Row4,
    /// Spin before.
    pub was: &'a Row4,
}

impl Moved<'_> {
    /// Adds what a fluid does in a step of `dt` [s]; what it takes [J].
    #[inline(always)]
    pub fn drag(&mut self, fluid: &Drag, gravity: &Vec3, dt: f64) -> f64 {
        accelerate(self.row, self.acceleration, &fluid.acceleration(self.was, gravity), dt);
        -fluid.slowing(self.was).dot(&self.was.velocity()) * dt / self.was.inverse_mass()
    }

    /// Adds local damping of a step of `dt` [s], against the motion apart from that of the flow [m/s]; what it takes [J].
    #[inline(always)]
    pub fn damp(&mut self, factor: f64, flow: &Vec3, turned: Option<Turned>, dt: f64) -> f64 {
        let was = self.was;
        let a = against(factor, &self.acceleration.vector(), &(was.velocity() - flow));
        accelerate(self.row, self.acceleration, &a, dt);
        let mut taken = -a.dot(&was.velocity()) * dt / was.inverse_mass();
        if let Some(Turned { spin, acceleration, was: spin_was }) = turned {
            let a = against(factor, &acceleration.vector(), &spin_was.vector());
            for axis in 0..3 {
                spin[axis] += 1.5 * dt * a[axis];
                acceleration[axis] += a[axis];
            }
            taken -= a.dot(&spin_was.vector()) * dt / inverse_inertia(was.radius(), was.inverse_mass());
        }
        taken
    }
}
