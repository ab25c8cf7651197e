//! The contact loop: the only one, for pairs and for walls, for every composition of effects and every width.

pub(crate) mod compose;
mod contact_loop;
pub(crate) mod sums;

use crate::effects::{Effect, Memory};
use crate::kernel::sums::Sums;
use crate::simd::number::{Layout, Number};
use crate::simd::{Lane, Row, Row4, Width};
use std::marker::PhantomData;

#[cfg(target_arch = "x86_64")]
use crate::simd::two::Two;
#[cfg(target_arch = "x86_64")]
use crate::simd::x86::X4;
#[cfg(target_arch = "x86_64")]
use crate::simd::x86::X8;
#[cfg(target_arch = "x86_64")]
use crate::simd::x86_single::Y4;
#[cfg(target_arch = "x86_64")]
use crate::simd::x86_single::Y8;

/// Numbers of one contact in the energy ledger: elastic, dissipated (normal, sliding, rolling, twisting), wall work, lost at once.
pub const LEDGER: usize = 8;
/// Column of what is lost at once.
pub const LOST: usize = 6;

/// What all contacts share in one step.
#[derive(Clone, Copy)]
pub struct StepInputs<'a> {
    /// Δt [s].
    pub dt: f64,
    /// Largest overlap over the smaller radius [–].
    pub overlap_limit: f64,
    /// Particle rows.
    pub rows: &'a [Row],
    /// Particle spins; empty without rotation.
    pub spins: &'a [Row4],
    /// How loads and memory are kept.
    pub form: Layout,
}

/// Some blocks of one interaction.
pub struct Batch<'a> {
    /// Rows and spins that `j` points into: the particles' own, or a wall's contact points.
    pub partners: (&'a [Row], &'a [Row4]),
    /// First particle of each contact; whole blocks.
    pub i: &'a [u32],
    /// Its partner.
    pub j: &'a [u32],
    /// Words of contact memory, by block and column.
    pub memory: &'a mut [f64],
    /// Whether a block's loads or memory are not all zero.
    pub active: &'a mut [bool],
    /// Sums of the tile that the contacts belong to; empty for images.
    pub sums: Sums<'a>,
    /// Whether the second of each contact is in that tile, too.
    pub both: bool,
    /// Words of loads and couples that are kept for other tiles, or empty.
    pub kept: (&'a mut [f64], &'a mut [f64]),
    /// Wrenches and torques of each contact, for observers; or empty.
    pub each: (&'a mut [f64], &'a mut [f64]),
    /// Ledger, [`LEDGER`] numbers a contact; empty when it is not kept.
    pub ledger: &'a mut [f64],
}

/// A composition of effects, as the engine sees it.
pub trait Kernel: Send + Sync {
    /// Numbers of memory for each contact.
    fn columns(&self) -> usize;
    /// Whether number `column` of memory changes its sign when i and j are the other way round.
    fn flips(&self, column: usize) -> bool;
    /// Whether it turns particles.
    fn rotates(&self) -> bool;
    /// Whether it makes couples.
    fn torques(&self) -> bool;
    /// Computes the loads of some blocks; true when an overlap passes the limit.
    fn run(&self, width: Width, common: StepInputs, task: Batch) -> bool;
}

impl<E: Effect> Kernel for E {
    fn columns(&self) -> usize {
        E::MEMORY
    }
    fn flips(&self, column: usize) -> bool {
        <E::Memory<f64> as Memory<f64>>::flips(column)
    }
    fn rotates(&self) -> bool {
        E::ROTATES
    }
    fn torques(&self) -> bool {
        E::COUPLES
    }
    fn run(&self, width: Width, common: StepInputs, task: Batch) -> bool {
        match task.ledger.is_empty() {
            true => dispatch::<E, false>(self, width, common, task),
            false => dispatch::<E, true>(self, width, common, task),
        }
    }
}

/// A composition of effects computed in single precision, between places and velocities in double precision. What it remembers and its loads
/// are kept as `T`.
pub struct Narrow<E, T>(pub E, PhantomData<T>);

impl<E, T> Narrow<E, T> {
    /// The composition.
    pub fn new(effects: E) -> Narrow<E, T> {
        Narrow(effects, PhantomData)
    }
}

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
    fn run(&self, width: Width, common: StepInputs, task: Batch) -> bool {
        match task.ledger.is_empty() {
            true => dispatch_narrow::<E, T, false>(&self.0, width, common, task),
            false => dispatch_narrow::<E, T, true>(&self.0, width, common, task),
        }
    }
}

fn dispatch_narrow<E: Effect, T: Number, const KEEP: bool>(
    e: &E,
    width: Width,
    common: StepInputs,
    task: Batch,
) -> bool {
    match width {
        #[cfg(target_arch = "x86_64")]
        Width::Avx512 => simd::avx512::<Y8, E, T, KEEP>(e, common, task),
        #[cfg(target_arch = "x86_64")]
        Width::Avx2 => simd::avx2::<Y4, E, T, KEEP>(e, common, task),
        _ => contact_loop::blocks::<f32, E, T, KEEP>(e, common, task),
    }
}

fn dispatch<E: Effect, const KEEP: bool>(effect: &E, width: Width, common: StepInputs, task: Batch) -> bool {
    match width {
        #[cfg(target_arch = "x86_64")]
        Width::Avx512 => simd::avx512::<X8, E, f64, KEEP>(effect, common, task),
        #[cfg(target_arch = "x86_64")]
        Width::Avx2 => simd::avx2::<Two<X4>, E, f64, KEEP>(effect, common, task),
        _ => contact_loop::blocks::<f64, E, f64, KEEP>(effect, common, task),
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

    pub fn avx512<R: Lane, E: Effect, T: Number, const KEEP: bool>(
        e: &E,
        common: StepInputs,
        task: Batch,
    ) -> bool {
        #[target_feature(enable = "avx512f,avx512dq,avx2")]
        fn inner<R: Lane, E: Effect, T: Number, const KEEP: bool>(
            e: &E,
            common: StepInputs,
            task: Batch,
        ) -> bool {
            contact_loop::blocks::<R, E, T, KEEP>(e, common, task)
        }
        // SAFETY: `Width::Avx512` is only made where the processor has these features.
        unsafe { inner::<R, E, T, KEEP>(e, common, task) }
    }

    pub fn avx2<R: Lane, E: Effect, T: Number, const KEEP: bool>(
        e: &E,
        common: StepInputs,
        task: Batch,
    ) -> bool {
        #[target_feature(enable = "avx2")]
        fn inner<R: Lane, E: Effect, T: Number, const KEEP: bool>(
            e: &E,
            common: StepInputs,
            task: Batch,
        ) -> bool {
            contact_loop::blocks::<R, E, T, KEEP>(e, common, task)
        }
        // SAFETY: `Width::Avx2` is only made where the processor has these features.
        unsafe { inner::<R, E, T, KEEP>(e, common, task) }
    }
}
