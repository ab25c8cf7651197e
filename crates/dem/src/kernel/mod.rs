//! The contact loop: the only one, for pairs and for walls, for every composition of effects and every width.

pub(crate) mod compose;
pub(crate) mod sums;

use crate::effects::{Contact, Effect, Load, Memory};
use crate::kernel::sums::Sums;
use crate::simd::number::{COUPLE, FORCE, FORCE_AND_MOMENT, Form, Number};
use crate::simd::{BLOCK, Lane, Places, Row, Row4, V, Width, fetch};
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

/// Blocks between one whose rows are asked for and the one that is computed; chosen on the bench pile.
const AHEAD: usize = 4;
/// Numbers of one contact in the energy ledger: elastic, dissipated (normal, sliding, rolling, twisting), wall work, lost at once.
pub const LEDGER: usize = 8;
/// Column of what is lost at once.
pub const LOST: usize = 6;

/// What all contacts share in one step.
#[derive(Clone, Copy)]
pub struct Common<'a> {
    /// Δt [s].
    pub dt: f64,
    /// Largest overlap over the smaller radius [–].
    pub overlap_limit: f64,
    /// Particle rows.
    pub rows: &'a [Row],
    /// Particle spins; empty without rotation.
    pub spins: &'a [Row4],
    /// How loads and memory are kept.
    pub form: Form,
}

/// Some blocks of one interaction.
pub struct Task<'a> {
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
    /// The like of each contact, for who looks at them; or empty.
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
    fn couples(&self) -> bool;
    /// Computes the loads of some blocks; true when an overlap passes the limit.
    fn run(&self, width: Width, common: Common, task: Task) -> bool;
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
    fn couples(&self) -> bool {
        E::COUPLES
    }
    fn run(&self, width: Width, common: Common, task: Task) -> bool {
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
    fn couples(&self) -> bool {
        self.0.couples()
    }
    fn run(&self, width: Width, common: Common, task: Task) -> bool {
        match task.ledger.is_empty() {
            true => dispatch_narrow::<E, T, false>(&self.0, width, common, task),
            false => dispatch_narrow::<E, T, true>(&self.0, width, common, task),
        }
    }
}

fn dispatch_narrow<E: Effect, T: Number, const KEEP: bool>(
    e: &E,
    width: Width,
    common: Common,
    task: Task,
) -> bool {
    match width {
        #[cfg(target_arch = "x86_64")]
        Width::Avx512 => simd::avx512::<Y8, E, T, KEEP>(e, common, task),
        #[cfg(target_arch = "x86_64")]
        Width::Avx2 => simd::avx2::<Y4, E, T, KEEP>(e, common, task),
        _ => blocks::<f32, E, T, KEEP>(e, common, task),
    }
}

fn dispatch<E: Effect, const KEEP: bool>(effect: &E, width: Width, common: Common, task: Task) -> bool {
    match width {
        #[cfg(target_arch = "x86_64")]
        Width::Avx512 => simd::avx512::<X8, E, f64, KEEP>(effect, common, task),
        #[cfg(target_arch = "x86_64")]
        Width::Avx2 => simd::avx2::<Two<X4>, E, f64, KEEP>(effect, common, task),
        _ => blocks::<f64, E, f64, KEEP>(effect, common, task),
    }
}

#[cfg(target_arch = "x86_64")]
mod simd {
    //! The loop, compiled for wider registers.
    #![allow(unsafe_code)]
    use super::*;

    pub fn avx512<R: Lane, E: Effect, T: Number, const KEEP: bool>(
        e: &E,
        common: Common,
        task: Task,
    ) -> bool {
        #[target_feature(enable = "avx512f,avx512dq,avx2")]
        fn inner<R: Lane, E: Effect, T: Number, const KEEP: bool>(e: &E, common: Common, task: Task) -> bool {
            blocks::<R, E, T, KEEP>(e, common, task)
        }
        // SAFETY: `Width::Avx512` is only made where the processor has these features.
        unsafe { inner::<R, E, T, KEEP>(e, common, task) }
    }

    pub fn avx2<R: Lane, E: Effect, T: Number, const KEEP: bool>(e: &E, common: Common, task: Task) -> bool {
        #[target_feature(enable = "avx2")]
        fn inner<R: Lane, E: Effect, T: Number, const KEEP: bool>(e: &E, common: Common, task: Task) -> bool {
            blocks::<R, E, T, KEEP>(e, common, task)
        }
        // SAFETY: `Width::Avx2` is only made where the processor has these features.
        unsafe { inner::<R, E, T, KEEP>(e, common, task) }
    }
}

#[inline(always)]
fn blocks<R: Lane, E: Effect, T: Number, const KEEP: bool>(e: &E, common: Common, mut task: Task) -> bool {
    let mut too_deep = false;
    let mut hand: Hand<T> =
        Hand { loads: [T::default(); BLOCK * FORCE_AND_MOMENT], couples: [T::default(); BLOCK * COUPLE] };
    for block in 0..task.active.len() {
        // Rows of partners come from far: they are asked for while other blocks are computed.
        let soon = (block + AHEAD) * BLOCK;
        for &j in task.j.get(soon..soon + BLOCK).unwrap_or_default() {
            fetch(task.partners.0, j as usize);
            if E::ROTATES {
                fetch(task.partners.1, j as usize);
            }
        }
        let was_active = task.active[block];
        let mut active = false;
        for lane in (0..BLOCK).step_by(R::WIDTH) {
            let (touches, deep) =
                lanes::<R, E, T, KEEP>(e, &common, &mut task, &mut hand, (block, lane, was_active));
            active |= touches;
            too_deep |= deep;
        }
        task.active[block] = active;
    }
    too_deep
}

/// `WIDTH` contacts; whether any touches, and whether any overlap passes the limit.
#[inline(always)]
fn lanes<R: Lane, E: Effect, T: Number, const KEEP: bool>(
    effect: &E,
    common: &Common,
    task: &mut Task,
    hand: &mut Hand<T>,
    (block, lane, was_active): (usize, usize, bool),
) -> (bool, bool) {
    let at = block * BLOCK + lane;
    let (i, j) = (&task.i[at..at + R::WIDTH], &task.j[at..at + R::WIDTH]);
    let rows =
        |table: (&[Row], &[Row4])| if E::ROTATES { table.0.len().min(table.1.len()) } else { table.0.len() };
    let (i, j) =
        (Places::within(i, rows((common.rows, common.spins))), Places::within(j, rows(task.partners)));
    let [xi, yi, zi, ri, ui, vi, wi, inverse_mi] = R::Wide::rows(common.rows, i);
    let [xj, yj, zj, rj, uj, vj, wj, inverse_mj] = R::Wide::rows(task.partners.0, j);
    let (apart, reach) = (V::new(xi - xj, yi - yj, zi - zj), ri + rj);
    let square = apart.dot(apart);
    let gap = R::narrow(reach * reach - square);
    let mut touching = gap.gt(R::splat(0.0));
    if !R::any(touching) && !was_active {
        return (false, false);
    }
    let (apart, reach, distance) = (V::narrow(apart), R::narrow(reach), R::narrow(square).sqrt());
    let (ri, rj) = (R::narrow(ri), R::narrow(rj));
    let inverse_mass = R::narrow(inverse_mi + inverse_mj);
    // One division for three: it takes as long as all multiplications of a contact.
    let both = distance * reach;
    let inverse = R::splat(1.0) / (both * inverse_mass);
    let normal = apart.scale(inverse * (reach * inverse_mass));
    let inverse_reach = inverse * (distance * inverse_mass);
    let overlap = R::overlap(gap, reach, distance);
    // The contact point divides the distance as the radii do: the whole of it on i's side at a flat wall.
    let share = distance * inverse_reach;
    let (arm_i, arm_j) = (ri * share, rj * share);
    let round = rj.gt(R::splat(0.0));
    let velocity = V::narrow(V::new(ui - uj, vi - vj, wi - wj));
    let along = velocity.dot(normal);
    let mut slip = velocity - normal.scale(along);
    let mut spin = V::zero();
    let mut turn = R::splat(0.0);
    let (mut surface, mut turning) = (V::narrow(V::new(uj, vj, wj)), V::zero());
    if E::ROTATES {
        let [axi, ayi, azi, _] = R::rows4(common.spins, i);
        let [axj, ayj, azj, _] = R::rows4(task.partners.1, j);
        let (si, sj) = (V::new(axi, ayi, azi), V::new(axj, ayj, azj));
        slip = slip - (si.scale(arm_i) + sj.scale(arm_j)).cross(normal);
        surface = surface + sj.scale(arm_j).cross(normal);
        (spin, turning) = (si - sj, sj);
        turn = (si + sj).dot(normal) * R::splat(0.5 * common.dt);
    }
    let radius = R::select(round, ri * rj * inverse_reach, ri);
    let words = E::MEMORY.div_ceil(T::IN_A_WORD) * BLOCK;
    let stored = T::of_mut(&mut task.memory[block * words..(block + 1) * words]);
    let mut memory = <E::Memory<R> as Memory<R>>::load(stored, lane);
    let zero = R::splat(0.0);
    let mut was_held = zero;
    if E::REACHES {
        was_held = effect.reach(radius, &memory);
        touching = R::select(touching, reach, overlap + was_held).gt(zero);
    }
    let contact = Contact {
        touching,
        normal,
        overlap,
        radius,
        curvature: R::select(round, inverse_reach, zero),
        mass: inverse * both,
        inverse_mass,
        approach: -along,
        slip,
        spin,
        turn,
    };
    let mut load = Load::zero();
    effect.apply(&contact, R::splat(common.dt), &mut memory, &mut load);
    memory.keep(touching).store(stored, lane);

    let force = V::select(touching, normal.scale(load.normal) + load.tangential, V::zero());
    if E::COUPLES {
        let c = V::select(touching, load.couple, V::zero());
        T::store_rows4([c.x, c.y, c.z, zero], &mut hand.couples);
    }
    if E::ROTATES {
        // Of a particle of radius −1: each takes it times minus its own.
        let moment = V::select(touching, normal.cross(load.tangential).scale(share), V::zero());
        let row = [force.x, force.y, force.z, zero, moment.x, moment.y, moment.z, zero];
        T::store_rows(row, &mut hand.loads);
        hand.over::<FORCE_AND_MOMENT>(task, at, R::WIDTH, E::COUPLES);
    } else if !common.form.rotates {
        T::store_rows4([force.x, force.y, force.z, zero], &mut hand.loads);
        hand.over::<FORCE>(task, at, R::WIDTH, false);
    } else {
        let row = [force.x, force.y, force.z, zero, zero, zero, zero, zero];
        T::store_rows(row, &mut hand.loads);
        hand.over::<FORCE_AND_MOMENT>(task, at, R::WIDTH, false);
    }
    if KEEP {
        let [a, b, c, d] = load.dissipated;
        // Work of j's surface on i; only walls' is added up.
        let surface = (surface.dot(force) + load.couple.dot(turning)) * R::splat(common.dt);
        let row = [load.elastic, a, b, c, d, surface, load.lost, zero];
        let mut row = [
            R::select(touching, row[0], zero),
            R::select(touching, row[1], zero),
            R::select(touching, row[2], zero),
            R::select(touching, row[3], zero),
            R::select(touching, row[4], zero),
            R::select(touching, row[5], zero),
            R::select(touching, row[6], zero),
            zero,
        ];
        if E::REACHES {
            // What a contact holds when it breaks is lost.
            let broken = R::select(was_held.gt(zero), load.elastic, zero);
            row[LOST] = R::select(touching, row[LOST], broken);
        }
        R::store_rows(row, &mut task.ledger[at * LEDGER..]);
    }
    let smaller = R::select(round, ri.min(rj), ri);
    let deep = R::both(touching, overlap.gt(smaller * R::splat(common.overlap_limit)));
    // A contact that has just broken stays in the ledger for one step.
    let active = R::any(touching) || (E::REACHES && KEEP && R::any(was_held.gt(zero)));
    (active, R::any(deep))
}

/// What some contacts have just been found to do.
#[repr(align(64))]
struct Hand<T> {
    loads: [T; BLOCK * FORCE_AND_MOMENT],
    couples: [T; BLOCK * COUPLE],
}

impl<T: Number> Hand<T> {
    /// Hands the loads (of `N` numbers) of `width` contacts from place `at` on to their particles, and to who wants to see them.
    #[inline(always)]
    fn over<const N: usize>(&self, task: &mut Task, at: usize, width: usize, couples: bool) {
        let pairs = (&task.i[at..at + width], &task.j[at..at + width]);
        let loads = &self.loads[..width * N];
        let couples = if couples { &self.couples[..width * COUPLE] } else { &[] };
        task.sums.take::<T, N>(pairs, task.both, (loads, couples));
        keep(task.kept.0, at * N, loads);
        keep(task.kept.1, at * COUPLE, couples);
        keep(task.each.0, at * N, loads);
        keep(task.each.1, at * COUPLE, couples);
    }
}

/// Copies to a column, if there is one.
#[inline(always)]
fn keep<T: Number>(column: &mut [f64], at: usize, rows: &[T]) {
    if !column.is_empty() {
        T::of_mut(column)[at..at + rows.len()].copy_from_slice(rows);
    }
}
