//! The contact loop: gather → geometry → effects → scatter, for `WIDTH` contacts at a time.
//!
//! Every function is inlined into the loop that is compiled for wide registers, always; a closure or a function that is not calls out for each
//! operation and takes several times as long.

use super::{Batch, LEDGER, LOST, StepInputs};
use crate::effects::{Contact, Effect, Load, Memory};
use crate::simd::number::{COUPLE, FORCE, FORCE_AND_MOMENT, Number};
use crate::simd::{BLOCK, Indices, Lane, Row, Row4, V, fetch};

/// Blocks between one whose rows are asked for and the one that is computed; chosen on the bench pile.
const AHEAD: usize = 4;

#[inline(always)]
pub fn blocks<R: Lane, E: Effect, T: Number, const KEEP: bool>(
    e: &E,
    common: StepInputs,
    mut task: Batch,
) -> bool {
    let mut too_deep = false;
    let mut hand: WrenchBuffer<T> = WrenchBuffer {
        loads: [T::default(); BLOCK * FORCE_AND_MOMENT],
        torques: [T::default(); BLOCK * COUPLE],
    };
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
    common: &StepInputs,
    task: &mut Batch,
    hand: &mut WrenchBuffer<T>,
    (block, lane, was_active): (usize, usize, bool),
) -> (bool, bool) {
    let at = block * BLOCK + lane;
    let ends = gather::<R, E>(common, task, at);
    let mut touching = ends.gap.gt(R::splat(0.0));
    if !R::any(touching) && !was_active {
        return (false, false);
    }
    let mut found = geometry::<R, E>(common, task, ends);
    let words = E::MEMORY.div_ceil(T::IN_A_WORD) * BLOCK;
    let stored = T::of_mut(&mut task.memory[block * words..(block + 1) * words]);
    let mut memory = <E::Memory<R> as Memory<R>>::load(stored, lane);
    let mut was_held = R::splat(0.0);
    if E::REACHES {
        was_held = effect.reach(found.contact.radius, &memory);
        touching = R::select(touching, found.reach, found.contact.overlap + was_held).gt(R::splat(0.0));
    }
    found.contact.touching = touching;
    let mut load = Load::zero();
    effect.apply(&found.contact, R::splat(common.dt), &mut memory, &mut load);
    memory.keep(touching).store(stored, lane);
    let force = scatter::<R, E, T>(common, task, hand, at, &found, &load);
    if KEEP {
        let row = ledger_row::<R, E>(common, &found, &load, force, was_held);
        R::store_rows(row, &mut task.ledger[at * LEDGER..]);
    }
    let deep = R::both(touching, found.contact.overlap.gt(found.smaller * R::splat(common.overlap_limit)));
    // A contact that has just broken stays in the ledger for one step.
    let active = R::any(touching) || (E::REACHES && KEEP && R::any(was_held.gt(R::splat(0.0))));
    (active, R::any(deep))
}

/// What is read of both ends: differences in double precision, rounded to the lane's.
struct Ends<'a, R: Lane> {
    i: Indices<'a>,
    j: Indices<'a>,
    /// x_i − x_j [m].
    apart: V<R::Wide>,
    /// Radii [m].
    radii: [R::Wide; 2],
    /// v_i − v_j, and v_j [m/s].
    velocities: [V<R::Wide>; 2],
    /// 1/m_i + 1/m_j [1/kg].
    inverse_mass: R::Wide,
    /// Square of the distance [m²].
    square: R::Wide,
    /// (r_i + r_j)² less that [m²].
    gap: R,
}

/// Reads the rows of both ends.
#[inline(always)]
fn gather<'a, R: Lane, E: Effect>(common: &StepInputs, task: &Batch<'a>, at: usize) -> Ends<'a, R> {
    let (i, j) = (&task.i[at..at + R::WIDTH], &task.j[at..at + R::WIDTH]);
    let rows =
        |table: (&[Row], &[Row4])| if E::ROTATES { table.0.len().min(table.1.len()) } else { table.0.len() };
    let (i, j) =
        (Indices::within(i, rows((common.rows, common.spins))), Indices::within(j, rows(task.partners)));
    let [xi, yi, zi, ri, ui, vi, wi, inverse_mi] = R::Wide::rows(common.rows, i);
    let [xj, yj, zj, rj, uj, vj, wj, inverse_mj] = R::Wide::rows(task.partners.0, j);
    let (apart, reach) = (V::new(xi - xj, yi - yj, zi - zj), ri + rj);
    let square = apart.dot(apart);
    let gap = R::narrow(reach * reach - square);
    let velocities = [V::new(ui - uj, vi - vj, wi - wj), V::new(uj, vj, wj)];
    Ends { i, j, apart, radii: [ri, rj], velocities, inverse_mass: inverse_mi + inverse_mj, square, gap }
}

/// A contact, and what else follows from where both ends are.
struct Geometry<R: Lane> {
    contact: Contact<R>,
    /// r_i + r_j [m].
    reach: R,
    /// The smaller radius [m].
    smaller: R,
    /// Distance over reach: how the contact point divides the radii [–].
    share: R,
    /// Velocity of j's surface at the contact [m/s].
    surface: V<R>,
    /// ω_j [rad/s].
    turning: V<R>,
}

/// Normal, overlap, and how the surfaces move past each other.
#[inline(always)]
fn geometry<R: Lane, E: Effect>(common: &StepInputs, task: &Batch, ends: Ends<R>) -> Geometry<R> {
    let zero = R::splat(0.0);
    let [ri, rj] = ends.radii;
    let (apart, reach, distance) = (V::narrow(ends.apart), R::narrow(ri + rj), R::narrow(ends.square).sqrt());
    let (ri, rj) = (R::narrow(ri), R::narrow(rj));
    let inverse_mass = R::narrow(ends.inverse_mass);
    // One division for three: it takes as long as all multiplications of a contact.
    let both = distance * reach;
    let inverse = R::splat(1.0) / (both * inverse_mass);
    let normal = apart.scale(inverse * (reach * inverse_mass));
    let inverse_reach = inverse * (distance * inverse_mass);
    let overlap = R::overlap(ends.gap, reach, distance);
    // The contact point divides the distance as the radii do: the whole of it on i's side at a flat wall.
    let share = distance * inverse_reach;
    let (arm_i, arm_j) = (ri * share, rj * share);
    let round = rj.gt(zero);
    let velocity = V::narrow(ends.velocities[0]);
    let along = velocity.dot(normal);
    let mut slip = velocity - normal.scale(along);
    let (mut spin, mut turn) = (V::zero(), zero);
    let (mut surface, mut turning) = (V::narrow(ends.velocities[1]), V::zero());
    if E::ROTATES {
        let [axi, ayi, azi, _] = R::rows4(common.spins, ends.i);
        let [axj, ayj, azj, _] = R::rows4(task.partners.1, ends.j);
        let (si, sj) = (V::new(axi, ayi, azi), V::new(axj, ayj, azj));
        slip = slip - (si.scale(arm_i) + sj.scale(arm_j)).cross(normal);
        surface = surface + sj.scale(arm_j).cross(normal);
        (spin, turning) = (si - sj, sj);
        turn = (si + sj).dot(normal) * R::splat(0.5 * common.dt);
    }
    let contact = Contact {
        touching: ends.gap.gt(zero),
        normal,
        overlap,
        radius: R::select(round, ri * rj * inverse_reach, ri),
        curvature: R::select(round, inverse_reach, zero),
        mass: inverse * both,
        inverse_mass,
        approach: -along,
        slip,
        spin,
        turn,
    };
    Geometry { contact, reach, smaller: R::select(round, ri.min(rj), ri), share, surface, turning }
}

/// Adds force, moment and torque to both ends, and keeps them where they are wanted; the force [N].
#[inline(always)]
fn scatter<R: Lane, E: Effect, T: Number>(
    common: &StepInputs,
    task: &mut Batch,
    hand: &mut WrenchBuffer<T>,
    at: usize,
    found: &Geometry<R>,
    load: &Load<R>,
) -> V<R> {
    let (zero, Contact { touching, normal, .. }) = (R::splat(0.0), found.contact);
    let force = V::select(touching, normal.scale(load.normal) + load.tangential, V::zero());
    if E::COUPLES {
        let c = V::select(touching, load.torque, V::zero());
        T::store_rows4([c.x, c.y, c.z, zero], &mut hand.torques);
    }
    if E::ROTATES {
        // Of a particle of radius −1: each takes it times minus its own.
        let moment = V::select(touching, normal.cross(load.tangential).scale(found.share), V::zero());
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
    force
}

/// Energies of a contact in the step: see [`LEDGER`].
#[inline(always)]
fn ledger_row<R: Lane, E: Effect>(
    common: &StepInputs,
    found: &Geometry<R>,
    load: &Load<R>,
    force: V<R>,
    was_held: R,
) -> [R; LEDGER] {
    let (zero, touching) = (R::splat(0.0), found.contact.touching);
    let [a, b, c, d] = load.dissipated;
    // Work of j's surface on i; only walls' is added up.
    let surface = (found.surface.dot(force) + load.torque.dot(found.turning)) * R::splat(common.dt);
    let mut row = [
        R::select(touching, load.elastic, zero),
        R::select(touching, a, zero),
        R::select(touching, b, zero),
        R::select(touching, c, zero),
        R::select(touching, d, zero),
        R::select(touching, surface, zero),
        R::select(touching, load.lost, zero),
        zero,
    ];
    if E::REACHES {
        // What a contact holds when it breaks is lost.
        let broken = R::select(was_held.gt(zero), load.elastic, zero);
        row[LOST] = R::select(touching, row[LOST], broken);
    }
    row
}

/// What some contacts have just been found to do.
#[repr(align(64))]
struct WrenchBuffer<T> {
    loads: [T; BLOCK * FORCE_AND_MOMENT],
    torques: [T; BLOCK * COUPLE],
}

impl<T: Number> WrenchBuffer<T> {
    /// Adds the wrenches (of `N` numbers) of `width` contacts from slot `at` on to their particles, and copies them where they are kept.
    #[inline(always)]
    fn over<const N: usize>(&self, task: &mut Batch, at: usize, width: usize, torques: bool) {
        let pairs = (&task.i[at..at + width], &task.j[at..at + width]);
        let loads = &self.loads[..width * N];
        let torques = if torques { &self.torques[..width * COUPLE] } else { &[] };
        task.sums.take::<T, N>(pairs, task.both, (loads, torques));
        keep(task.kept.0, at * N, loads);
        keep(task.kept.1, at * COUPLE, torques);
        keep(task.each.0, at * N, loads);
        keep(task.each.1, at * COUPLE, torques);
    }
}

/// Copies to a column, if there is one.
#[inline(always)]
fn keep<T: Number>(column: &mut [f64], at: usize, rows: &[T]) {
    if !column.is_empty() {
        T::of_mut(column)[at..at + rows.len()].copy_from_slice(rows);
    }
}
