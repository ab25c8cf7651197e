//! Bodies that pass planes: what zones ask of them, and how they are moved there.
//!
//! In a zone a clump keeps its angular velocity: R(τ) = turn(ω τ) R₀. That is no free turn unless ω lies along a principal axis; it is a
//! prescribed motion as the constant velocity is, in closed form, and back in time it leads to where it began.

use crate::setup::{EntryClump, Particle, Setup};
use crate::space::rotation;
use crate::state::clump::quaternion;
use crate::state::{ClumpMotion, FREE, Kinematics, RigidClumps};
use geom::Vec3;
use nalgebra::UnitQuaternion;

/// ½ m v² + ½ ω·L − m g·x [J], g the `weight` over the mass [m/s²].
fn energy(mass: f64, position: &Vec3, velocity: &Vec3, [spin, momentum]: [&Vec3; 2], weight: &Vec3) -> f64 {
    mass * (0.5 * velocity.norm_squared() - weight.dot(position)) + 0.5 * spin.dot(momentum)
}

impl RigidClumps {
    /// Whether row `k` is the first member of its clump.
    pub(crate) fn is_first(&self, f: &ClumpMotion, k: usize) -> bool {
        self.members.get(f.first as usize) == Some(&(k as u32))
    }

    /// State of the clump of row `k` a time `back` [s] before the end of the step, that took `dt` [s].
    pub fn state_back(&self, k: usize, back: f64, dt: f64, setup: &Setup) -> Option<(Particle, EntryClump)> {
        let f = self.body_of(k)?;
        let shape = &setup.clumps.shapes[f.shape as usize];
        let turn = f.turn_back(back / dt);
        let spin = rotation::spin(&turn, &(f.momentum - f.torque * back), &f.inverse_inertia);
        let particle = Particle {
            id: f.id,
            material: shape.material,
            radius: shape.reach() * f.scale,
            position: f.position - f.velocity * back + f.acceleration * (0.5 * back * back),
            velocity: f.velocity - f.acceleration * back,
            spin,
        };
        let orientation = turn * shape.frame.inverse();
        Some((particle, EntryClump { shape: f.shape, scale: f.scale, orientation }))
    }

    /// Energy of the clump as it is now.
    pub fn energy_at(&self, k: usize, setup: &Setup) -> Option<f64> {
        let f = self.body_of(k)?;
        let now = || energy(f.mass, &f.position, &f.velocity, [&f.spin, &f.momentum], &f.weight(setup));
        Some(if self.is_first(f, k) { now() } else { 0.0 })
    }

    /// Energy of the clump in the middle of the last step.
    pub fn energy_before_half(&self, k: usize, setup: &Setup, dt: f64) -> Option<f64> {
        let f = self.body_of(k)?;
        let (velocity, momentum) =
            (f.velocity - f.acceleration * (0.5 * dt), f.momentum - f.torque * (0.5 * dt));
        let spin = rotation::spin(&f.turn_back(0.5), &momentum, &f.inverse_inertia);
        let middle = (f.position + f.place_before) * 0.5;
        Some(energy(f.mass, &middle, &velocity, [&spin, &momentum], &f.weight(setup)))
    }

    /// The clump of row `k` moves by a prescribed motion from now on.
    pub fn take(&mut self, k: usize) {
        if let Some(f) = self.body_at(k) {
            f.is_prescribed = true;
        }
    }

    /// Where the clump of row `k` is, in a zone: its centre, how that moves, its principal axes.
    pub fn carry(&mut self, k: usize, centre: Vec3, flow: &Kinematics, turned: UnitQuaternion<f64>) {
        let Kinematics { velocity, spin, .. } = *flow;
        let first = self.body_of(k).is_some_and(|f| self.is_first(f, k));
        if let Some(f) = self.body_at(k).filter(|_| first) {
            (f.position, f.place_before, f.velocity) = (centre, centre, velocity);
            f.turn = turned.into_inner().coords.into();
            (f.turn_before, f.spin) = (f.turn, spin);
            f.momentum = rotation::momentum(&turned, &spin, &f.inverse_inertia);
        }
    }

    /// The clump of row `k` is free from now on, and was so for a time `since` [s] of this step, in which its angular momentum stayed.
    pub fn release(&mut self, k: usize, since: f64) {
        let first = self.body_of(k).is_some_and(|f| self.is_first(f, k));
        if let Some(f) = self.body_at(k).filter(|_| first) {
            (f.is_prescribed, f.starting) = (false, true);
            let (now, spin) = (quaternion(&f.turn), f.spin);
            let then = rotation::spun(&(spin * -since)) * now;
            f.momentum = rotation::momentum(&then, &spin, &f.inverse_inertia);
            f.spin = rotation::spin(&now, &f.momentum, &f.inverse_inertia);
        }
    }

    fn body_at(&mut self, k: usize) -> Option<&mut ClumpMotion> {
        self.of.get(k).and_then(|&b| self.flights.get_mut(b as usize))
    }

    /// Drops clumps whose members have left; `new` is the new number of each row, or none. Clumps stay or leave whole.
    pub(crate) fn keep(&mut self, new: &[u32]) {
        let stays = |f: &ClumpMotion| self.members[f.range()].iter().all(|&m| new[m as usize] != FREE);
        if self.flights.iter().all(stays) {
            return;
        }
        let (mut flights, mut members) = (Vec::new(), Vec::new());
        let mut number = vec![FREE; self.flights.len()];
        for (b, f) in self.flights.iter().enumerate().filter(|(_, f)| stays(f)) {
            number[b] = flights.len() as u32;
            let first = members.len() as u32;
            members.extend_from_slice(&self.members[f.range()]);
            flights.push(ClumpMotion { first, ..*f });
        }
        for of in self.of.iter_mut().filter(|of| **of != FREE) {
            *of = number[*of as usize];
        }
        (self.flights, self.members) = (flights, members);
    }
}

impl ClumpMotion {
    /// Its axes this share of the last step before its end. Of two turns so near to each other a mean is a turn about the same axis,
    /// off by no more than the cube of the angle between them.
    fn turn_back(&self, share: f64) -> UnitQuaternion<f64> {
        let (now, before) = (quaternion(&self.turn), quaternion(&self.turn_before));
        if share <= 0.0 { now } else { now.nlerp(&before, share) }
    }
}
