//! The contact loop: the only one, for pairs and for walls, for every composition of effects and every width.

use alloc::vec::Vec;
mod averaged;
mod buffer;
pub mod contact_loop;
pub mod damped_mass;
pub mod motion;
pub mod patch;
pub mod seams;
pub mod sums;
pub mod touch;
mod translation;
pub mod wall_point;
pub mod wrenches;

pub use averaged::average;
pub use buffer::WrenchBuffer;
pub use motion::{MoveFlags, MoveInputs, Mover};
pub use sums::{Pairs, Sums, WrenchSums};
pub use wrenches::{Arrival, SlotEnd, WrenchSlices, WrenchSlicesMut};

use crate::effects::{Effect, History};
use crate::simd::compiled::{self, Eights, Job, Lanes, Singles};
use crate::simd::{Lane, Layout, Number, Row, Row4, Width};
use core::any::TypeId;
use core::marker::PhantomData;

/// Numbers of one contact in the energy ledger: elastic, dissipated (normal, sliding, rolling, twisting), wall work, lost at once; and its normal stiffness.
pub const LEDGER: usize = 8;
/// Column of what is lost at once.
pub const LOST: usize = 6;
/// Column of ∂F_n/∂δ, for the step after [N/m].
pub const STIFFNESS: usize = 7;

/// What all contacts share in one step.
#[derive(Clone, Copy)]
pub struct StepInputs<'a> {
    /// Δt [s].
    pub dt: f64,
    /// Half of it where contacts are averaged over a kick, 0 where they are sampled [s].
    pub ahead: f64,
    /// Largest overlap over the smaller radius [–].
    pub overlap_limit: f64,
    /// Particle rows.
    pub rows: &'a [Row],
    /// Particle spins; empty without rotation.
    pub spins: &'a [Row4],
    /// How wrenches and history lie in their columns.
    pub layout: Layout,
}

/// Some blocks of contacts of one kind.
pub struct Batch<'a> {
    /// Rows and spins that `j` points into: the particles' own, or a wall's contact points.
    pub partners: (&'a [Row], &'a [Row4]),
    /// First particle of each contact; whole blocks.
    pub i: &'a [u32],
    /// Its partner.
    pub j: &'a [u32],
    /// Words of contact history, by block and column.
    pub history: &'a mut [f64],
    /// Whether a block's wrenches or history are not all zero.
    pub active: &'a mut [bool],
    /// Sums of the tile that the contacts belong to; empty for images.
    pub sums: Sums<'a>,
    /// Whether the second of each contact is in that tile, too.
    pub both: bool,
    /// Where wrenches are kept for other tiles; or empty.
    pub kept: WrenchSlicesMut<'a>,
    /// [`patch::PATCH`] numbers of each contact, by block and column; empty where all act by themselves.
    pub patch: &'a [f64],
    /// Where the wrench of each contact is kept, for observers; or empty.
    pub each: WrenchSlicesMut<'a>,
    /// Ledger, [`LEDGER`] numbers a contact; empty when it is not kept.
    pub ledger: &'a mut [f64],
}

/// A composition of effects, as the engine sees it.
pub trait Composition: Send + Sync {
    /// Numbers of history for each contact.
    fn columns(&self) -> usize;
    /// Whether number `column` of the history changes its sign when i and j are exchanged.
    fn flips(&self, column: usize) -> bool;
    /// Whether it turns particles.
    fn rotates(&self) -> bool;
    /// Whether it makes torques besides those of tangential forces.
    fn torques(&self) -> bool;
    /// Computes the wrenches of some blocks; true when an overlap passes the limit.
    fn run(&self, width: Width, step: StepInputs, batch: Batch) -> bool;
    /// Its type and its numbers, as a device gets them; none where devices do not have its precision.
    fn ported(&self) -> Option<(TypeId, Vec<f64>)> {
        None
    }
}

impl<E: Effect> Composition for E {
    fn columns(&self) -> usize {
        E::HISTORY
    }
    fn flips(&self, column: usize) -> bool {
        <E::History<f64> as History<f64>>::flips(column)
    }
    fn rotates(&self) -> bool {
        E::ROTATES
    }
    fn torques(&self) -> bool {
        E::TORQUES
    }
    fn run(&self, width: Width, step: StepInputs, batch: Batch) -> bool {
        run::<Eights, E, f64>(self, width, step, batch)
    }
    fn ported(&self) -> Option<(TypeId, Vec<f64>)> {
        let mut numbers = Vec::new();
        self.put(&mut numbers);
        Some((TypeId::of::<E>(), numbers))
    }
}

/// A composition of effects computed in single precision, from positions and velocities in double precision. Its history and its wrenches
/// are kept as `T`.
pub struct Narrow<E, T>(pub E, pub PhantomData<T>);

impl<E: Effect, T: Number> Composition for Narrow<E, T> {
    fn columns(&self) -> usize {
        self.0.columns()
    }
    fn flips(&self, column: usize) -> bool {
        self.0.flips(column)
    }
    fn rotates(&self) -> bool {
        self.0.rotates()
    }
    fn torques(&self) -> bool {
        self.0.torques()
    }
    fn run(&self, width: Width, step: StepInputs, batch: Batch) -> bool {
        run::<Singles, E, T>(&self.0, width, step, batch)
    }
}

/// The contact loop over a batch.
struct Blocks<'a, E, T, const KEEP: bool> {
    effect: &'a E,
    step: StepInputs<'a>,
    batch: Batch<'a>,
    number: PhantomData<T>,
}

impl<E: Effect, T: Number, const KEEP: bool> Job for Blocks<'_, E, T, KEEP> {
    type Output = bool;
    #[inline(always)]
    fn run<R: Lane>(self) -> bool {
        // A copy: numbers behind a reference in a struct are read again after every write.
        let effect = *self.effect;
        contact_loop::blocks::<R, E, T, KEEP>(&effect, self.step, self.batch)
    }
}

/// Runs the contact loop with the lanes `L`, and with the ledger where it is kept.
pub fn run<L: Lanes, E: Effect, T: Number>(effect: &E, width: Width, step: StepInputs, batch: Batch) -> bool {
    let number = PhantomData::<T>;
    match batch.ledger.is_empty() {
        true => compiled::run::<L, _>(width, Blocks::<E, T, false> { effect, step, batch, number }),
        false => compiled::run::<L, _>(width, Blocks::<E, T, true> { effect, step, batch, number }),
    }
}
