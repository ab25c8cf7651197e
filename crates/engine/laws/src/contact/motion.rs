//! The move of a particle by the sum of its forces: velocity Verlet with predicted velocities.
//!
//! ```text
//! v_n     = v*_n + (a_n − a_{n−1}) Δt/2          a_n from forces at (x_n, v*_n)
//! x_{n+1} = x_n + v_n Δt + a_n Δt²/2
//! v*_{n+1} = v_n + a_n Δt                        predicted, so that forces see one instant
//! ```
//!
//! Velocity Verlet: Swope et al. (1982), J. Chem. Phys. 76; positions and velocities of one instant in the force:
//! Vyas, Ottino, Lueptow & Umbanhowar (2024), arXiv:2410.14798. Rotation in the same way, I = 2/5 m r².

use crate::contact::sums::Sum;
use crate::float::Float;
use crate::simd::{Four, Row, Row4};
use crate::space::sphere::inverse_inertia;

/// What all particles share in one move.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct MoveInputs {
    /// Δt [s].
    pub dt: f64,
    /// How far ahead in time contacts are looked for [s].
    pub ahead: f64,
    /// Acceleration of free fall [m/s²].
    pub gravity: [f64; 3],
    /// Largest motion in one step over the radius [–].
    pub motion_limit: f64,
}

/// What one move found.
#[derive(Debug, Clone, Copy, Default)]
pub struct MoveFlags {
    /// Whether a particle has left its margin.
    pub left_margin: bool,
    /// Whether a particle moved more than its limit, or is not a number.
    pub too_fast: bool,
}

impl MoveFlags {
    /// Either.
    #[inline(always)]
    pub fn and(self, o: MoveFlags) -> MoveFlags {
        MoveFlags { left_margin: self.left_margin | o.left_margin, too_fast: self.too_fast | o.too_fast }
    }
}

/// Moves particles, with the numbers that all of them share at hand.
pub struct Mover<Q> {
    inputs: MoveInputs,
    gravity: Q,
    /// 1, 1, 1, 0: rows hold radius and 1/m in the fourth place, which must not move.
    three: Q,
    dt: Q,
    /// Δt/2.
    half: Q,
    /// Δt²/2.
    square: Q,
}

impl<Q: Four> Mover<Q> {
    /// A move.
    #[inline(always)]
    pub fn new(inputs: &MoveInputs) -> Mover<Q> {
        let [gx, gy, gz] = inputs.gravity;
        Mover {
            inputs: *inputs,
            gravity: Q::read(&[gx, gy, gz, 0.0]),
            three: Q::read(&[1.0, 1.0, 1.0, 0.0]),
            dt: Q::all(inputs.dt),
            half: Q::all(0.5 * inputs.dt),
            square: Q::all(0.5 * inputs.dt * inputs.dt),
        }
    }

    /// Moves the centre of a particle that was listed at `home`.
    #[inline(always)]
    pub fn advance(&self, row: &mut Row, acceleration: &mut Row4, home: &Row4, sum: &Sum<Q>) -> MoveFlags {
        let ([position, velocity], []) = row.as_chunks_mut::<4>() else { return MoveFlags::default() };
        let (radius, inverse_mass) = (position[3], velocity[3]);
        let new = (sum.force * Q::all(inverse_mass) + self.gravity) * self.three;
        let v = Q::read(velocity) + self.half * (new - Q::read(acceleration));
        let moves = (self.dt * v + self.square * new) * self.three;
        let there = Q::read(position) + moves;
        there.write(position);
        let predicted = v + self.dt * new;
        predicted.write(velocity);
        new.write(acceleration);
        let limit = self.inputs.motion_limit * radius;
        // Written so that NaN is caught.
        let too_fast = !(length2(moves) <= limit * limit);
        let mut margin = home[3];
        if self.inputs.ahead > 0.0 {
            margin = (margin - self.inputs.ahead * length2(predicted * self.three).root()).max(0.0);
        }
        let left_margin = length2(there - Q::read(home)) > margin * margin;
        MoveFlags { left_margin, too_fast }
    }

    /// Turns it on; `row` is that of its centre, before or after its move.
    #[inline(always)]
    pub fn turn(&self, row: &Row, spin: &mut Row4, angular_acceleration: &mut Row4, sum: &Sum<Q>) {
        let (radius, inverse_mass) = (row.radius(), row.inverse_mass());
        let new = sum.moment * Q::all(inverse_inertia(radius, inverse_mass)) * self.three;
        let w = Q::read(spin) + self.half * (new - Q::read(angular_acceleration));
        (w + self.dt * new).write(spin);
        new.write(angular_acceleration);
    }
}

/// x² + y² + z².
#[inline(always)]
fn length2<Q: Four>(v: Q) -> f64 {
    let mut row = [0.0; 4];
    (v * v).write(&mut row);
    row[0] + row[1] + row[2]
}
