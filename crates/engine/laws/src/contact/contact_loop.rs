//! The contact loop: gather → geometry → effects → scatter, for `WIDTH` contacts at a time.
//!
//! Every function is inlined into the loop that is compiled for wide registers, always; a closure or a function that is not calls out for each
//! operation and takes several times as long.

use super::averaged::{average, share, size};
use super::patch::PATCH;
use super::{Batch, LEDGER, LOST, STIFFNESS, StepInputs, WrenchBuffer};
use crate::effects::{Contact, DISSIPATORS, Effect, History, Response};
use crate::simd::{BLOCK, FORCE, FORCE_AND_MOMENT, Indices, Lane, Number, Row, Row4, V, fetch};

/// Blocks between the one whose rows are prefetched and the one that is computed; chosen on the bench pile.
const AHEAD: usize = 4;
/// Several units in the last place of a square [–].
const ROUNDING: f64 = 2e-15;

/// Computes the wrenches of a batch with lanes `R`, with the ledger where it is kept; true when an overlap passes the limit.
#[inline(always)]
pub fn blocks<R: Lane, E: Effect, T: Number, const KEEP: bool>(
    e: &E,
    step: StepInputs,
    mut batch: Batch,
) -> bool {
    let mut too_deep = false;
    let mut buffer = WrenchBuffer::<T>::new();
    for block in 0..batch.active.len() {
        // Rows of partners come from far: they are prefetched while other blocks are computed.
        let soon = (block + AHEAD) * BLOCK;
        for &j in batch.j.get(soon..soon + BLOCK).unwrap_or_default() {
            fetch(batch.partners.0, j as usize);
            if E::ROTATES {
                fetch(batch.partners.1, j as usize);
            }
        }
        let was_active = batch.active[block];
        let mut active = false;
        for lane in (0..BLOCK).step_by(R::WIDTH) {
            let (touches, deep) =
                lanes::<R, E, T, KEEP>(e, &step, &mut batch, &mut buffer, Group { block, lane, was_active });
            active |= touches;
            too_deep |= deep;
        }
        batch.active[block] = active;
    }
    too_deep
}

/// `WIDTH` contacts of a block, from `lane` on.
struct Group {
    block: usize,
    lane: usize,
    /// Whether the block was active before.
    was_active: bool,
}

/// `WIDTH` contacts; whether any touches, and whether any overlap passes the limit.
#[inline(always)]
fn lanes<R: Lane, E: Effect, T: Number, const KEEP: bool>(
    effect: &E,
    step: &StepInputs,
    batch: &mut Batch,
    buffer: &mut WrenchBuffer<T>,
    Group { block, lane, was_active }: Group,
) -> (bool, bool) {
    let at = block * BLOCK + lane;
    let ends = gather::<R, E>(step, batch, at);
    if !was_active && !ends.may_act(step) {
        return (false, false);
    }
    act::<R, E, T, KEEP>(effect, step, batch, buffer, (block, lane), ends)
}

/// What `WIDTH` contacts from `lane` of a block on do, some of which may act: as [`lanes`].
#[inline(always)]
pub fn act<R: Lane, E: Effect, T: Number, const KEEP: bool>(
    effect: &E,
    step: &StepInputs,
    batch: &mut Batch,
    buffer: &mut WrenchBuffer<T>,
    (block, lane): (usize, usize),
    ends: Ends<R>,
) -> (bool, bool) {
    let at = block * BLOCK + lane;
    let mut found = geometry::<R, E>(step, batch, ends);
    if !batch.patch.is_empty() {
        share::<R>(&mut found.contact, &batch.patch[block * PATCH * BLOCK..][lane..]);
    }
    let words = E::HISTORY.div_ceil(T::IN_A_WORD) * BLOCK;
    let stored = T::of_mut(&mut batch.history[block * words..(block + 1) * words]);
    let mut history = <E::History<R> as History<R>>::load(stored, lane);
    let mut was_held = R::splat(0.0);
    if E::REACHES {
        was_held = effect.reach(found.contact.radius, &history);
        let touches = found.contact.touching;
        let beyond = R::select(touches, found.reach, found.contact.overlap + was_held);
        found.contact.touching = beyond.gt(R::splat(0.0));
    }
    if KEEP {
        found.contact.stiffness_last = in_ledger(&batch.ledger[at * LEDGER..], STIFFNESS);
    }
    let part = if step.ahead > 0.0 { average(step.ahead, &mut found.contact, was_held) } else { None };
    let touching = found.contact.touching;
    let mut response = Response::zero();
    let dt = R::splat(step.dt);
    effect.apply(&found.contact, part.map_or(dt, |share| share * dt), &mut history, &mut response);
    if let Some(share) = part {
        response.shorten(share);
    }
    history.keep(touching).store(stored, lane);
    let force = scatter::<R, E, T>(step, batch, buffer, at, &found, &response);
    let mut ended = false;
    if KEEP {
        let held = if E::REACHES { in_ledger(&batch.ledger[at * LEDGER..], 0) } else { R::splat(0.0) };
        let row = ledger_row::<R, E>(step, &found, &response, force, (was_held, held));
        ended = R::any(released(&row, touching).gt(R::splat(0.0)));
        R::store_rows(row, &mut batch.ledger[at * LEDGER..]);
    }
    let deep =
        R::both(touching, found.contact.present.gt(found.contact.smaller * R::splat(step.overlap_limit)));
    // A contact that has just ended or broken stays in the ledger for one step.
    let active = R::any(touching) || ended || (E::REACHES && KEEP && R::any(was_held.gt(R::splat(0.0))));
    (active, R::any(deep))
}

/// What is read of both ends: differences in double precision, rounded to the lane's.
pub struct Ends<'a, R: Lane> {
    i: Indices<'a>,
    j: Indices<'a>,
    /// x_i − x_j [m].
    apart: V<R::Wide>,
    /// Radii [m].
    radii: [R::Wide; 2],
    /// v_i − v_j, and v_j [m/s].
    velocities: [V<R::Wide>; 2],
    /// 1/m_i and 1/m_j [1/kg].
    inverse_masses: [R::Wide; 2],
    /// Square of the distance [m²].
    square: R::Wide,
    /// (r_i + r_j)² less that [m²].
    gap: R,
}

impl<R: Lane> Ends<'_, R> {
    /// Whether any touches, or may come to touch within half a step.
    #[inline(always)]
    pub fn may_act(&self, step: &StepInputs) -> bool {
        R::any(self.gap.gt(R::splat(0.0))) || self.meet_soon(step)
    }

    /// Whether any may come to touch within half a step. Where a distance d between centres shrinks by w to less than r_i + r_j,
    /// (r_i + r_j)² − d² + 2 d w > w².
    #[inline(always)]
    fn meet_soon(&self, step: &StepInputs) -> bool {
        let shrinks = size(R::narrow(self.apart.dot(self.velocities[0]))) * R::splat(2.0 * step.ahead);
        // A gap of less than what d² is rounded by counts as none: `average` takes the difference of distances, which may then be 0.
        let rounding = R::splat(ROUNDING) * R::narrow(self.square);
        step.ahead > 0.0 && R::any((self.gap + shrinks + rounding).gt(R::splat(0.0)))
    }
}

/// Reads the rows of both ends.
#[inline(always)]
pub fn gather<'a, R: Lane, E: Effect>(step: &StepInputs, batch: &Batch<'a>, at: usize) -> Ends<'a, R> {
    let (i, j) = (&batch.i[at..at + R::WIDTH], &batch.j[at..at + R::WIDTH]);
    let rows =
        |table: (&[Row], &[Row4])| if E::ROTATES { table.0.len().min(table.1.len()) } else { table.0.len() };
    let (i, j) =
        (Indices::within(i, rows((step.rows, step.spins))), Indices::within(j, rows(batch.partners)));
    let [xi, yi, zi, ri, ui, vi, wi, inverse_mi] = R::Wide::rows(step.rows, i);
    let [xj, yj, zj, rj, uj, vj, wj, inverse_mj] = R::Wide::rows(batch.partners.0, j);
    let (apart, reach) = (V::new(xi - xj, yi - yj, zi - zj), ri + rj);
    let square = apart.dot(apart);
    let gap = R::narrow(reach * reach - square);
    let velocities = [V::new(ui - uj, vi - vj, wi - wj), V::new(uj, vj, wj)];
    let inverse_masses = [inverse_mi, inverse_mj];
    Ends { i, j, apart, radii: [ri, rj], velocities, inverse_masses, square, gap }
}

/// A contact, and what else follows from where both ends are.
struct Geometry<R: Lane> {
    contact: Contact<R>,
    /// r_i + r_j [m].
    reach: R,
    /// Distance over reach: how the contact point divides the radii [–].
    share: R,
    /// Velocity of j's surface at the contact [m/s].
    surface: V<R>,
    /// ω_j [rad/s].
    spin_j: V<R>,
}

/// Normal, overlap, and how the surfaces move past each other.
#[inline(always)]
fn geometry<R: Lane, E: Effect>(step: &StepInputs, batch: &Batch, ends: Ends<R>) -> Geometry<R> {
    let zero = R::splat(0.0);
    let [ri, rj] = ends.radii;
    let (apart, reach, distance) = (V::narrow(ends.apart), R::narrow(ri + rj), R::narrow(ends.square).sqrt());
    let (ri, rj) = (R::narrow(ri), R::narrow(rj));
    let [inverse_mi, inverse_mj] = ends.inverse_masses;
    let inverse_mass = R::narrow(inverse_mi + inverse_mj);
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
    let (mut spin, mut turn, mut lever, mut inertia) = (V::zero(), zero, zero, zero);
    let (mut surface, mut spin_j) = (V::narrow(ends.velocities[1]), V::zero());
    if E::ROTATES {
        let [axi, ayi, azi, _] = R::rows4(step.spins, ends.i);
        let [axj, ayj, azj, _] = R::rows4(batch.partners.1, ends.j);
        let (si, sj) = (V::new(axi, ayi, azi), V::new(axj, ayj, azj));
        slip = slip - (si.scale(arm_i) + sj.scale(arm_j)).cross(normal);
        surface = surface + sj.scale(arm_j).cross(normal);
        (spin, spin_j) = (si - sj, sj);
        turn = (si + sj).dot(normal) * R::splat(0.5 * step.dt);
    }
    if E::TORQUES {
        // Of spheres, 1/I ∝ 1/m r²; all of it on i's side at a flat wall.
        let (ui, uj) = (R::narrow(inverse_mi) * rj, R::narrow(inverse_mj) * ri);
        let yields = R::splat(1.0) / (ui * rj + uj * ri).max(R::splat(R::TINY));
        lever = R::select(round, (arm_i * ui * rj - arm_j * uj * ri) * yields, arm_i);
        let square = R::select(round, ri * rj * (ri * rj) * yields, ri * ri * (inverse * both));
        inertia = R::splat(0.4) * square;
    }
    let contact = Contact {
        touching: ends.gap.gt(zero),
        normal,
        overlap,
        present: overlap,
        partial: zero,
        before: overlap + along * R::splat(step.dt),
        radius: R::select(round, ri * rj * inverse_reach, ri),
        smaller: R::select(round, ri.min(rj), ri),
        share: R::splat(1.0),
        share_before: R::splat(1.0),
        curvature: R::select(round, inverse_reach, zero),
        mass: inverse * both,
        inverse_mass,
        approach: -along,
        slip,
        spin,
        lever,
        inertia,
        stiffness_last: zero,
        turn,
    };
    Geometry { contact, reach, share, surface, spin_j }
}

/// Adds force, moment and torque to both ends, and keeps them where they are wanted; the force [N].
#[inline(always)]
fn scatter<R: Lane, E: Effect, T: Number>(
    step: &StepInputs,
    batch: &mut Batch,
    buffer: &mut WrenchBuffer<T>,
    at: usize,
    found: &Geometry<R>,
    response: &Response<R>,
) -> V<R> {
    let (zero, Contact { touching, normal, .. }) = (R::splat(0.0), found.contact);
    let force = V::select(touching, normal.scale(response.normal) + response.tangential, V::zero());
    if E::TORQUES {
        let c = V::select(touching, response.torque, V::zero());
        T::store_rows4([c.x, c.y, c.z, zero], &mut buffer.torques);
    }
    if E::ROTATES {
        // Of a particle of radius −1: each takes it times minus its own.
        let moment = V::select(touching, normal.cross(response.tangential).scale(found.share), V::zero());
        let row = [force.x, force.y, force.z, zero, moment.x, moment.y, moment.z, zero];
        T::store_rows(row, &mut buffer.forces);
        buffer.scatter::<FORCE_AND_MOMENT>(batch, at, R::WIDTH, E::TORQUES);
    } else if !step.layout.rotates {
        T::store_rows4([force.x, force.y, force.z, zero], &mut buffer.forces);
        buffer.scatter::<FORCE>(batch, at, R::WIDTH, false);
    } else {
        let row = [force.x, force.y, force.z, zero, zero, zero, zero, zero];
        T::store_rows(row, &mut buffer.forces);
        buffer.scatter::<FORCE_AND_MOMENT>(batch, at, R::WIDTH, false);
    }
    force
}

/// A column of the step before, which its ledger kept.
#[inline(always)]
fn in_ledger<R: Lane>(ledger: &[f64], column: usize) -> R {
    let mut last = [0.0; BLOCK];
    for (k, last) in last.iter_mut().enumerate().take(R::WIDTH) {
        *last = ledger[k * LEDGER + column];
    }
    R::load(&last)
}

/// Energies of a contact in the step: see [`LEDGER`].
#[inline(always)]
fn ledger_row<R: Lane, E: Effect>(
    step: &StepInputs,
    found: &Geometry<R>,
    response: &Response<R>,
    force: V<R>,
    (was_held, held): (R, R),
) -> [R; LEDGER] {
    let (zero, touching) = (R::splat(0.0), found.contact.touching);
    let [a, b, c, d] = response.dissipated;
    // A contact that has just ended books what its springs let go of. It was closed at most two steps of its speed ago; a particle that has
    // left is parked far away, and its contacts were booked when it left.
    let two_steps = R::splat(2.0 * step.dt);
    let recent =
        R::select(touching, R::splat(1.0), found.contact.present - found.contact.approach * two_steps)
            .gt(zero);
    // Work of j's surface on i; only walls' is added up.
    let surface = (found.surface.dot(force) + response.torque.dot(found.spin_j)) * R::splat(step.dt);
    let mut row = [
        R::select(touching, response.elastic, zero),
        R::select(touching, a, zero),
        R::select(recent, b, zero),
        R::select(recent, c, zero),
        R::select(recent, d, zero),
        R::select(touching, surface, zero),
        R::select(touching, response.lost, zero),
        R::select(touching, response.stiffness, zero),
    ];
    if E::REACHES {
        // What a contact holds when it breaks is lost; where its triangle has handed the particle to another, which is put out of reach, what it held last.
        let near = R::splat(1e3).gt(found.share);
        let broken = R::select(was_held.gt(zero), R::select(near, response.elastic, held), zero);
        row[LOST] = R::select(touching, row[LOST], broken);
    }
    row
}

/// What contacts that have ended lose in this step, without its sign [J].
#[inline(always)]
fn released<R: Lane>(row: &[R; LEDGER], touching: R::Mask) -> R {
    let zero = R::splat(0.0);
    // A closure would not be inlined into wide registers.
    let mut largest = zero;
    for x in &row[2..=DISSIPATORS] {
        largest = largest.max(size(*x));
    }
    R::select(touching, zero, largest)
}
