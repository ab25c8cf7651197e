//! The pass after each move.

use crate::model::Model;
use crate::passes::integrate::MoveFlags;
use crate::setup::Setup;
use crate::simd::{Row, Row4};
use crate::space::sphere::periods;
use crate::state::State;
use crate::state::clump::{ClumpMotion, arm};
use crate::state::clumps::{FREE, RigidClumps, far};
use crate::state::particles::Particles;
use geom::Vec3;
use rayon::prelude::*;

/// Bodies, or rows, of one task; fewer are not worth another thread.
const CHUNK: usize = 512;

impl RigidClumps {
    /// Moves the bodies whose members have been moved as if they were free, and puts the members in their places.
    pub fn advance(&mut self, particles: &mut Particles, setup: &Setup, dt: f64) -> MoveFlags {
        let (members, arms) = (&self.members, &self.arms);
        let seen = &*particles;
        let advance = |chunk: &mut [ClumpMotion]| {
            for f in chunk.iter_mut().filter(|f| !f.travels) {
                let (a, torque) = f.gathered(members, arms, seen, &setup.gravity);
                f.advance(a + f.fluid(setup), torque, dt);
            }
        };
        match self.flights.len() > CHUNK {
            true => self.flights.par_chunks_mut(CHUNK).for_each(advance),
            false => advance(&mut self.flights),
        }
        self.place(particles, setup, dt)
    }

    /// Bodies without a past get the acceleration and the torque of this instant as those of the step before.
    pub fn prime(&mut self, particles: &Particles, setup: &Setup) {
        let (members, arms) = (&self.members, &self.arms);
        for f in self.flights.iter_mut().filter(|f| f.starting && !f.travels) {
            let (a, torque) = f.gathered(members, arms, particles, &setup.gravity);
            (f.acceleration, f.torque) = (a + f.fluid(setup), torque);
            f.starting = false;
        }
    }

    /// Writes the members' rows.
    fn place(&self, particles: &mut Particles, setup: &Setup, dt: f64) -> MoveFlags {
        let count = self.of.len();
        let spins = &mut particles.spins[..];
        let write = Write {
            flights: &self.flights,
            periods: periods(&setup.periodic),
            motion_limit: setup.guards.motion,
            dt,
        };
        let seats = |from: usize, n: usize| {
            let range = from..(from + n).min(count);
            Seats {
                of: &self.of[range.clone()],
                arms: &self.arms[range.clone()],
                images: &self.images[range],
            }
        };
        let turning = if spins.is_empty() { 0 } else { count };
        let (rows, spins) = (&mut particles.rows[..count], &mut spins[..turning]);
        let (accelerations, home) = (&mut particles.acceleration[..count], &particles.home[..count]);
        if count <= CHUNK {
            return write.rows(&seats(0, count), rows, spins, accelerations, home);
        }
        // Without rotation there are no spins, and an empty part for each chunk.
        let mut spins: Vec<&mut [Row4]> = spins.chunks_mut(CHUNK).collect();
        spins.resize_with(count.div_ceil(CHUNK), Default::default);
        let parts = rows.par_chunks_mut(CHUNK).zip(accelerations.par_chunks_mut(CHUNK));
        let parts = parts.zip(home.par_chunks(CHUNK)).zip(spins.into_par_iter()).enumerate();
        let moved = parts.map(|(c, (((rows, accelerations), home), spins))| {
            write.rows(&seats(c * CHUNK, CHUNK), rows, spins, accelerations, home)
        });
        moved.reduce(MoveFlags::default, MoveFlags::and)
    }
}

/// Body, arm and image of some rows.
struct Seats<'a> {
    of: &'a [u32],
    arms: &'a [Row4],
    images: &'a [[i8; 3]],
}

/// What writing needs of the bodies.
struct Write<'a> {
    flights: &'a [ClumpMotion],
    periods: Vec3,
    motion_limit: f64,
    dt: f64,
}

impl Write<'_> {
    fn rows(
        &self,
        seats: &Seats,
        rows: &mut [Row],
        spins: &mut [Row4],
        accelerations: &mut [Row4],
        home: &[Row4],
    ) -> MoveFlags {
        let mut moved = MoveFlags::default();
        for (k, &of) in seats.of.iter().enumerate().filter(|(_, of)| **of != FREE) {
            let f = &self.flights[of as usize];
            if f.travels {
                continue;
            }
            let (place, velocity, way) = f.point(&seats.arms[k]);
            let place = place + far(&seats.images[k], &self.periods);
            let row = &mut rows[k];
            row[..3].copy_from_slice(place.as_slice());
            row[4..7].copy_from_slice(velocity.as_slice());
            if let Some(spin) = spins.get_mut(k) {
                *spin = Row4([f.spin.x, f.spin.y, f.spin.z, 0.0]);
            }
            // What brings it back to where it was: `position_before`.
            let a = (velocity * self.dt - way) * (2.0 / (self.dt * self.dt));
            accelerations[k] = Row4([a.x, a.y, a.z, 0.0]);
            let limit = self.motion_limit * row[3];
            moved.too_fast |= !(way.norm_squared() <= limit * limit);
            moved.left_margin |= (place - arm(&home[k])).norm_squared() > home[k][3] * home[k][3];
        }
        moved
    }
}

/// After a move: rigid clumps take the forces of their members and put them in their positions.
pub fn advance(model: &Model, state: &mut State, moved: MoveFlags) -> MoveFlags {
    if state.bodies.none() {
        return moved;
    }
    if model.setup.ledger {
        state.ledger.drag += state.bodies.drag_power(&model.setup) * model.dt;
    }
    moved.and(state.bodies.advance(&mut state.particles, &model.setup, model.dt))
}
