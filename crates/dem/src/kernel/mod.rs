//! The contact loop: the only one, for pairs and for walls, for every composition of effects and every width.

mod averaged;
pub(crate) mod compose;
mod contact_loop;
pub(crate) mod sums;
pub(crate) mod wrenches;

pub(crate) use averaged::average;
pub(crate) use sums::{Pairs, Sums, WrenchSums};
pub(crate) use wrenches::{Arrival, SlotEnd, WrenchSlices, WrenchSlicesMut};

use crate::effects::{Effect, History};
use crate::simd::{Lane, Layout, Number, Row, Row4, Width};
use std::marker::PhantomData;

#[cfg(target_arch = "x86_64")]
use crate::simd::{
    two::Two,
    x86::{X4, X8},
    x86_single::{Y4, Y8},
};

/// Numbers of one contact in the energy ledger: elastic, dissipated (normal, sliding, rolling, twisting), wall work, lost at once.
pub const LEDGER: usize = 8;
/// Column of what is lost at once.
pub const LOST: usize = 6;

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
    /// Where the wrench of each contact is kept, for observers; or empty.
    pub each: WrenchSlicesMut<'a>,
    /// Ledger, [`LEDGER`] numbers a contact; empty when it is not kept.
    pub ledger: &'a mut [f64],
}

/// A composition of effects, as the engine sees it.
pub trait Kernel: Send + Sync {
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
}

impl<E: Effect> Kernel for E {
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
        match batch.ledger.is_empty() {
            true => dispatch::<E, false>(self, width, step, batch),
            false => dispatch::<E, true>(self, width, step, batch),
        }
    }
}

/// A composition of effects computed in single precision, from positions and velocities in double precision. Its history and its wrenches
/// are kept as `T`.
pub struct Narrow<E, T>(pub E, pub PhantomData<T>);

impl<E: Effect, T: Number> Kernel for Narrow<E, T> {
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
        match batch.ledger.is_empty() {
            true => dispatch_narrow::<E, T, false>(&self.0, width, step, batch),
            false => dispatch_narrow::<E, T, true>(&self.0, width, step, batch),
        }
    }
}

fn dispatch_narrow<E: Effect, T: Number, const KEEP: bool>(
    e: &E,
    width: Width,
    step: StepInputs,
    batch: Batch,
) -> bool {
    match width {
        #[cfg(target_arch = "x86_64")]
        Width::Avx512 => simd::avx512::<Y8, E, T, KEEP>(e, step, batch),
        #[cfg(target_arch = "x86_64")]
        Width::Avx2 => simd::avx2::<Y4, E, T, KEEP>(e, step, batch),
        _ => contact_loop::blocks::<f32, E, T, KEEP>(e, step, batch),
    }
}

fn dispatch<E: Effect, const KEEP: bool>(effect: &E, width: Width, step: StepInputs, batch: Batch) -> bool {
    match width {
        #[cfg(target_arch = "x86_64")]
        Width::Avx512 => simd::avx512::<X8, E, f64, KEEP>(effect, step, batch),
        #[cfg(target_arch = "x86_64")]
        Width::Avx2 => simd::avx2::<Two<X4>, E, f64, KEEP>(effect, step, batch),
        _ => contact_loop::blocks::<f64, E, f64, KEEP>(effect, step, batch),
    }
}

#[cfg(target_arch = "x86_64")]
mod simd {
    //! The loop, compiled for wider registers.
    #![expect(
        unsafe_code,
        reason = "one loop is compiled for several widths and called after asking the processor"
    )]
    use super::*;

    macro_rules! compiled {
        ($name:ident, $features:literal) => {
            pub fn $name<R: Lane, E: Effect, T: Number, const KEEP: bool>(
                e: &E,
                step: StepInputs,
                batch: Batch,
            ) -> bool {
                #[target_feature(enable = $features)]
                fn inner<R: Lane, E: Effect, T: Number, const KEEP: bool>(
                    e: &E,
                    step: StepInputs,
                    batch: Batch,
                ) -> bool {
                    contact_loop::blocks::<R, E, T, KEEP>(e, step, batch)
                }
                // SAFETY: a width is only made where the processor has its features.
                unsafe { inner::<R, E, T, KEEP>(e, step, batch) }
            }
        };
    }
    compiled!(avx512, "avx512f,avx512dq,avx2");
    compiled!(avx2, "avx2");
}
