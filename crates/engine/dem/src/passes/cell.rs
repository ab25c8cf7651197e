//! The periodic cell that is strained: its lengths follow a rate, a path of strain or a stress, and all that is in it takes its share.
//!
//! ```text
//! ε = ln(h₀/h),   h_{n+1} = h₀ exp(−ε_{n+1}),   h'_n = (h_{n+1} − h_n)/Δt          compression is positive
//! v ← v + (h'_{n+1} − h'_n)/h_{n+1} (x − x₀)                                      by axis, after the move to n + 1
//! σ = (1/V) Σ f ⊗ b = (1/V) (Σ F ⊗ X − A ⊗ h),   A = Σ f ⊗ n                      b: branch from j to image n of i, f: force on i
//! ```
//!
//! Velocities are those of space. An image n of a particle is at x + n h and moves with v + n h', in contacts, bonds and where a particle comes back through
//! a face. When h' changes, every particle takes its share of the change at once, so that the strain is uniform from the start and no wave runs in from
//! the faces (as with Cundall's periodic space in TRUBAL; h'' = 0 leaves particles to themselves). X is the centre of a sphere or of a rigid clump: the
//! branch joins bodies, so moments do not count. The stress is that of contacts and bonds, without what motion carries.
//!
//! **Stress.** ε' follows the lack of stress as a wall follows that of force ([`crate::passes::servo`]), with S = Σ (k Δt + c) b²/V over all contacts and
//! bonds: what an affine strain meets at most. S is summed again every [`EVERY`] steps, at the overlaps that the largest rate would make until then.
//!
//! **Energy.** Contacts and bonds across faces do the work h'·A, and the changes of v bring energy of motion; both are booked as work of walls.

use crate::model::bonds::springs::numbers;
use crate::model::{Halt, Model, With};
use crate::neighbours::NeighbourLists;
use crate::state::clumps::FREE;
use crate::state::particles::kick_row;
use crate::state::{CellState, ClumpMotion, Held, ListStatus, RigidClumps, State};
use crate::threads::{FEW, share};
use geom::Vec3;
use laws::slowing::has_left;
use laws::space::cell::Cell;
use nalgebra::Matrix3;

/// Steps between two sums of the stiffness.
const EVERY: u64 = 16;
/// Particles of one task.
const CHUNK: usize = 256;

/// A strained cell at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellReport {
    /// Lowest and highest coordinate [m] of its periodic axes.
    pub range: [Option<(f64, f64)>; 3],
    /// Logarithmic strain of each axis, compression positive [–].
    pub strain: Vec3,
    /// Its rate [1/s].
    pub rate: Vec3,
    /// Mean stress of contacts and bonds, compression positive [Pa]; 0 where an axis is open.
    pub stress: Matrix3<f64>,
    /// Stress that is wanted along each axis that follows one [Pa].
    pub target: [Option<f64>; 3],
}

/// What a strained cell is and does at this instant, whose forces are known; `None` where it is not strained.
pub fn report(model: &Model, state: &State, lists: &NeighbourLists) -> Option<CellReport> {
    let strained = state.strained.as_ref()?;
    Some(CellReport {
        range: strained.cell().range,
        strain: strained.strain,
        rate: (strained.next - strained.strain) / model.dt,
        stress: stress(model, state, lists),
        target: followed(model, state).map(|axis| axis.map(|(target, _)| target)),
    })
}

/// Stress that each axis follows now [Pa], and how well it has held that.
pub fn followed(model: &Model, state: &State) -> [Option<(f64, Held)>; 3] {
    let of = |a: usize| {
        let (target, _) = model.setup.strain[a].as_ref()?.stress(state.time())?;
        Some((target, state.strained.as_ref()?.followers[a].as_ref()?.held))
    };
    [0, 1, 2].map(of)
}

/// Volume of the cell [m³]; 0 where an axis is open.
fn volume(cell: &Cell) -> f64 {
    cell.lengths().product()
}

/// Mean stress of contacts and bonds, compression positive [Pa].
fn stress(model: &Model, state: &State, lists: &NeighbourLists) -> Matrix3<f64> {
    let (cell, p) = (state.cell(model), &state.particles);
    let middle = cell.centre();
    let chunk = |from: &usize| {
        let particles = *from..(from + CHUNK).min(p.len());
        particles.fold(Matrix3::zeros(), |sum: Matrix3<f64>, k| {
            let force = state.contacts.force_on(k);
            // Most members of clumps touch nothing; to add zeros would change no bit.
            if force == Vec3::zeros() {
                return sum;
            }
            sum + force * (p.position(k) - state.clumps.arm(k) - middle).transpose()
        })
    };
    let chunks: Vec<usize> = (0..p.len()).step_by(CHUNK).collect();
    let parts = share(p.len() >= FEW, chunks, |from| chunk(&from));
    let moments = parts.into_iter().fold(Matrix3::zeros(), |sum: Matrix3<f64>, part| sum + part);
    let volume = volume(&cell);
    let across = contacts_across(state, lists, &cell) * Matrix3::from_diagonal(&cell.lengths());
    if volume > 0.0 { (moments - across) / volume } else { Matrix3::zeros() }
}

/// A = Σ f ⊗ n of contacts and bonds across faces [N]: force on the first, image of the second.
fn contacts_across(state: &State, lists: &NeighbourLists, cell: &Cell) -> Matrix3<f64> {
    let mut sum = Matrix3::zeros();
    for segment in lists.slots.segments.iter().filter(|s| s.with == With::Images) {
        for slot in segment.contacts() {
            let image = lists.slots.image[slot].map(f64::from);
            sum += state.contacts.force(slot) * Vec3::from(image).transpose();
        }
    }
    let bonds = &state.bonds;
    for (pair, pull) in bonds.pairs.iter().zip(&bonds.pulls).filter(|(pair, _)| pair.is_whole()) {
        let [i, j] = pair.ends.map(|k| state.particles.position(k as usize));
        sum += Vec3::from(pull.force) * cell.between(&(i - j)).transpose();
    }
    sum
}

/// Σ f ⊗ n of members that lie n lengths of the cell from the place that their clump gives them [N].
fn members_beyond(state: &State) -> Matrix3<f64> {
    let mut sum = Matrix3::zeros();
    for (k, image) in state.clumps.images.iter().enumerate().filter(|(_, image)| **image != [0; 3]) {
        sum += state.contacts.force_on(k) * Vec3::from(image.map(f64::from)).transpose();
    }
    sum
}

/// Work of the cell on particles in the step that begins at this instant [J], whose forces are known.
pub fn step_work(model: &Model, state: &State, lists: &NeighbourLists) -> f64 {
    let Some(strained) = &state.strained else { return 0.0 };
    let cell = strained.cell();
    let across = contacts_across(state, lists, &cell) - members_beyond(state);
    across.diagonal().dot(&cell.speed) * model.dt
}

/// How stiffly contacts and bonds answer along each axis: Σ (k Δt + c) b²/V [Pa·s], and how many there are.
fn response(model: &Model, state: &State, lists: &NeighbourLists, rates: &Vec3) -> (u32, Vec3) {
    let (cell, p) = (state.cell(model), &state.particles);
    let (mut count, mut sum) = (0, Vec3::zeros());
    for segment in lists.slots.segments.iter().filter(|s| !s.with.is_wall()) {
        for slot in segment.contacts() {
            let k = lists.slots.i[slot] as usize;
            let (other, radius) = lists.partner(p, segment, slot, |k| p.position(k));
            let (apart, mine) = (p.position(k) - other, p.rows[k].radius());
            let overlap = mine + radius - apart.norm();
            if overlap <= 0.0 {
                continue;
            }
            // Between bodies, as the stress has it.
            let arms = state.clumps.arm(lists.slots.partner[slot] as usize) - state.clumps.arm(k);
            let branch = apart + arms;
            let ahead = branch.abs().component_mul(rates).norm() * model.dt * EVERY as f64;
            let stiffness = model.responses[segment.kind].at((overlap + ahead) / mine.min(radius));
            count += 1;
            sum += branch.component_mul(&branch) * stiffness;
        }
    }
    let bonds = state.bonds.pairs.iter().zip(&state.bonds.springs);
    for (pair, springs) in bonds.filter(|(pair, _)| pair.is_whole()) {
        let [i, j] = pair.ends.map(|k| p.position(k as usize));
        let (apart, bond) = (cell.nearest(i - j), numbers(springs));
        let [along, shear, ..] = bond.stiffness;
        count += 1;
        sum += apart.component_mul(&apart) * (along.max(shear) * (model.dt + bond.lag));
    }
    (count, sum / volume(&cell))
}

/// Moves the cell to the next step, by the forces of this one, and all particles with it.
///
/// # Errors
/// A cell that has become too small for its particles, or whose lengths are lost.
pub fn drive(model: &Model, state: &mut State, lists: &NeighbourLists) -> Result<(), Halt> {
    let Some(mut strained) = state.strained.clone() else { return Ok(()) };
    let before = strained.cell();
    let next = next_strain(model, state, lists, &mut strained);
    strained.advance(next);
    let (time, now) = (state.time() + model.dt, strained.cell());
    let (lengths, least, finite) = (now.lengths(), strained.least, strained.is_finite());
    state.strained = Some(strained);
    follow(model, state, &before, &now);
    for (a, axis) in ['x', 'y', 'z'].into_iter().enumerate() {
        if now.range[a].is_some() && !(lengths[a] >= least && finite) {
            return Err(Halt::CellTooSmall { time, axis, length: lengths[a], least });
        }
    }
    Ok(())
}

/// The strain a step after the next instant.
fn next_strain(model: &Model, state: &State, lists: &NeighbourLists, strained: &mut CellState) -> Vec3 {
    let (dt, time) = (model.dt, state.time());
    let limits = model.setup.strain.each_ref().map(|s| s.as_ref()?.stress(time));
    let mut next = strained.next;
    if limits.iter().any(Option::is_some) {
        if state.steps.is_multiple_of(EVERY) {
            let rates = Vec3::from(limits.map(|l| l.map_or(0.0, |(_, rate)| rate)));
            let (contacts, sums) = response(model, state, lists, &rates);
            for (a, follower) in strained.followers.iter_mut().enumerate() {
                if let Some(f) = follower {
                    (f.contacts, f.response) = (contacts, sums[a]);
                }
            }
        }
        let stress = stress(model, state, lists);
        for a in 0..3 {
            let (Some((target, limit)), Some(f)) = (limits[a], &mut strained.followers[a]) else { continue };
            let push = stress[(a, a)];
            f.governor.follow(limit, (f.contacts, f.response), (target, target - push));
            f.held.touched |= f.contacts > 0;
            f.held.add(time, push, target, f.governor.speed.abs() >= limit);
            next[a] += f.governor.speed * dt;
        }
    }
    for (a, strain) in model.setup.strain.iter().enumerate() {
        // Step n + 2, where the last instant was n.
        let prescribed = strain.as_ref().and_then(|s| s.prescribed((state.steps + 2) as f64 * dt));
        next[a] = prescribed.unwrap_or(next[a]);
    }
    next
}

/// Gives every particle its share of how the cell has changed; that of a member is that of its clump's centre.
fn follow(model: &Model, state: &mut State, before: &Cell, now: &Cell) {
    let (change, stretched) = (now.speed - before.speed, now.lengths() - before.lengths());
    let (dt, ahead) = (model.dt, model.ahead());
    let RigidClumps { flights, of, images, .. } = &mut state.clumps;
    if change == Vec3::zeros() && flights.is_empty() {
        return;
    }
    let carried = |f: &ClumpMotion| (!f.is_prescribed).then(|| now.affine(&change, &f.position));
    let carried: Vec<Option<Vec3>> = flights.iter().map(carried).collect();
    let (count, p) = (state.particles.len(), &mut state.particles);
    let tiles = p.rows[..count].chunks_mut(CHUNK).zip(p.acceleration.chunks(CHUNK)).zip(p.home.chunks(CHUNK));
    let done = share(count >= FEW, tiles.enumerate().collect(), |(tile, ((rows, accelerations), home))| {
        let (mut work, mut out) = (0.0, false);
        for (k, row) in rows.iter_mut().enumerate() {
            let body = of.get(tile * CHUNK + k).map_or(FREE, |of| *of);
            if body == FREE {
                if change == Vec3::zeros() {
                    continue;
                }
                work += kick_row(row, &accelerations[k], &now.affine(&change, &row.position()), dt);
            } else {
                let Some(by) = carried[body as usize] else { continue };
                let image = images[tile * CHUNK + k].map(f64::from);
                for a in 0..3 {
                    row[a] += image[a] * stretched[a];
                    row[4 + a] += by[a] + image[a] * change[a];
                }
            }
            out |= has_left(row, &home[k], ahead);
        }
        (work, out)
    });
    let (mut work, out) = done.into_iter().fold((0.0, false), |(w, o), d| (w + d.0, o | d.1));
    for (f, by) in flights.iter_mut().zip(&carried) {
        work += by.map_or(0.0, |by| f.kick(&by, dt));
    }
    state.ledger.move_by_walls(work);
    if out {
        state.listing.outdate(ListStatus::MarginLeft);
    }
}

/// Gives particles at t = 0 the velocities of the affine flow.
pub fn start(state: &mut State) {
    let Some(cell) = state.strained.as_ref().map(CellState::cell).filter(Cell::moves) else { return };
    for k in (0..state.particles.len()).filter(|&k| !state.clumps.is_member(k)) {
        let flow = cell.flow(&state.particles.position(k));
        (0..3).for_each(|a| state.particles.rows[k][4 + a] += flow[a]);
    }
    for f in &mut state.clumps.flights {
        let flow = cell.flow(&f.position);
        f.velocity += flow;
        for &m in &state.clumps.members[f.range()] {
            (0..3).for_each(|a| state.particles.rows[m as usize][4 + a] += flow[a]);
        }
    }
}
