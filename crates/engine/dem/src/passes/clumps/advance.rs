//! The pass after each move.

use crate::model::Model;
use crate::passes::clumps::instant::damped;
use crate::passes::clumps::members::{MemberRows, Members, Write};
use crate::setup::Setup;
use crate::state::{ClumpMotion, Particles, RigidClumps, State};
use crate::threads::share;
use laws::contact::MoveFlags;
use laws::simd::compiled::{self, Registers};
use laws::space::cell::Cell;

/// Bodies, or rows, of one task; fewer are not worth another thread.
const CHUNK: usize = 512;

impl RigidClumps {
    /// Moves the clumps whose members have been moved as if they were free, and sets the rows of the members. And what local damping takes [W].
    pub fn advance(&mut self, particles: &mut Particles, cell: Cell, model: &Model) -> (MoveFlags, f64) {
        let (setup, dt) = (&model.setup, model.dt);
        let (members, arms) = (&self.members, &self.arms);
        let seen = &*particles;
        let advance = |chunk: &mut [ClumpMotion]| {
            let mut taken = 0.0;
            for f in chunk.iter_mut().filter(|f| !f.is_prescribed) {
                let (a, torque) = f.gathered(members, arms, seen, &setup.gravity);
                let damped = damped(f, (a + f.fluid(setup), torque), setup, &cell);
                taken += damped.power;
                f.advance(damped.acceleration, damped.torque, dt);
            }
            taken
        };
        let taken = share(self.flights.len() > CHUNK, self.flights.chunks_mut(CHUNK).collect(), advance);
        (self.position(particles, cell, model), taken.into_iter().sum())
    }

    /// Bodies without a past get the acceleration and the torque of this instant as those of the step before.
    pub fn prime(&mut self, particles: &Particles, setup: &Setup, cell: &Cell) {
        let (members, arms) = (&self.members, &self.arms);
        for f in self.flights.iter_mut().filter(|f| f.starting && !f.is_prescribed) {
            let (a, torque) = f.gathered(members, arms, particles, &setup.gravity);
            let damped = damped(f, (a + f.fluid(setup), torque), setup, cell);
            (f.acceleration, f.torque) = (damped.acceleration, damped.torque);
            f.starting = false;
        }
    }

    /// Writes the members' rows.
    fn position(&self, particles: &mut Particles, cell: Cell, model: &Model) -> MoveFlags {
        let (count, motion_limit) = (self.of.len(), model.setup.guards.motion);
        let members = Members { clumps: self, cell, motion_limit, dt: model.dt, ahead: model.ahead() };
        let Particles { rows, spins, acceleration, home, .. } = particles;
        let rotating = if spins.is_empty() { 0 } else { count };
        // Without rotation there are no spins, and an empty part for each chunk.
        let spins = spins[..rotating].chunks_mut(CHUNK).chain(std::iter::repeat_with(Default::default));
        let rows = rows[..count].chunks_mut(CHUNK).zip(spins);
        let rows = rows.zip(acceleration.chunks_mut(CHUNK)).zip(home.chunks(CHUNK)).enumerate();
        let moved = share(count > CHUNK, rows.collect(), |(n, (((rows, spins), acceleration), home))| {
            let to = MemberRows { first: n * CHUNK, rows, spins, acceleration, home };
            compiled::run::<Registers, _>(model.width, Write { members, to })
        });
        moved.into_iter().fold(MoveFlags::default(), MoveFlags::and)
    }
}

/// After a move: rigid clumps take the forces of their members and put them in their positions.
pub fn advance(model: &Model, state: &mut State, moved: MoveFlags) -> MoveFlags {
    if state.clumps.none() {
        return moved;
    }
    if model.setup.ledger {
        state.ledger.drag += state.clumps.drag_power(&model.setup) * model.dt;
    }
    let cell = state.cell(model);
    let (members, taken) = state.clumps.advance(&mut state.particles, cell, model);
    if model.setup.ledger {
        state.ledger.damped += taken * model.dt;
    }
    moved.and(members)
}
