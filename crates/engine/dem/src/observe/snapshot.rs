//! Snapshots: particles, clumps and energy of this instant.

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::passes::instant::{Instant, instant};
use crate::passes::ledger::close_step;
use crate::passes::mount;
use crate::setup::{Particle, Setup};
use crate::state::ledger::{carried, heavy};
use crate::state::{Energy, State};
use geom::Vec3;
use laws::contact::WrenchSums;
use laws::space::cell::Cell;
use std::collections::BTreeSet;

/// All particles at one instant, by id.
pub struct Snapshot<'a> {
    model: &'a Model,
    state: &'a State,
    sums: WrenchSums<'a>,
    /// Velocity and spin of those that are members of clumps.
    members: Vec<Option<(Vec3, Vec3)>>,
    order: Vec<u32>,
    cell: Cell,
}

impl<'a> Snapshot<'a> {
    /// Of an instant whose forces are known.
    pub(crate) fn new(model: &'a Model, state: &'a State) -> Snapshot<'a> {
        let (p, sums) = (&state.particles, state.contacts.sums());
        let members = state.clumps.member_states(model, state, &sums);
        // All at once: a list that grows takes twice its length, beside the largest state there is.
        let (hidden, mut order) = (state.zones.hidden(state.time()), Vec::with_capacity(p.len()));
        order.extend((0..p.len() as u32).filter(|&k| !hidden(k as usize)));
        drop(hidden);
        order.sort_unstable_by_key(|&k| p.id[k as usize]);
        Snapshot { model, state, sums, members, order, cell: state.cell(model) }
    }

    /// Clusters of particles by id, in their order; those that are not listed have none.
    pub fn clusters(&self) -> &'a [(u32, u32)] {
        &self.state.clusters
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// State of the one after `n` others.
    ///
    /// # Panics
    /// Where there are not so many.
    pub fn particle(&self, n: usize) -> Particle {
        let mut p = self.as_listed(n);
        if self.cell.moves() {
            p.velocity -= self.cell.away(&p.position).component_mul(&self.cell.speed);
        }
        p.position = self.cell.wrapped(p.position);
        p
    }

    /// The same, where it is between two listings, which may be beyond a periodic face.
    fn as_listed(&self, n: usize) -> Particle {
        let (k, p) = (self.order[n] as usize, &self.state.particles);
        let Instant { velocity, spin, .. } = instant(self.model, self.state, k, &self.sums);
        let (velocity, spin) = self.members.get(k).copied().flatten().unwrap_or((velocity, spin));
        Particle {
            id: p.id[k],
            material: p.material[k],
            radius: p.rows[k].radius(),
            position: p.position(k),
            velocity,
            spin,
        }
    }
}

/// Particles in the calculation, by id, with velocities of this instant, whose forces are known.
pub fn particles(model: &Model, state: &State) -> Vec<Particle> {
    let snapshot = Snapshot::new(model, state);
    (0..snapshot.len()).map(|n| snapshot.particle(n)).collect()
}

/// Energy of this instant [J]; elastic and dissipated parts only when the setup asked for the ledger.
pub fn energy(model: &Model, state: &State, lists: &NeighbourLists) -> Energy {
    let snapshot = Snapshot::new(model, state);
    let mut particles: Vec<Particle> = (0..snapshot.len()).map(|n| snapshot.as_listed(n)).collect();
    let mut clumps = state.clumps.states_as_listed(model, state);
    if !state.zones.none() {
        let all = 0..state.particles.len();
        let travelling: BTreeSet<u32> =
            all.filter(|&k| state.zones.is_prescribed(k)).map(|k| state.particles.id[k]).collect();
        particles.retain(|p| !travelling.contains(&p.id));
        clumps.retain(|b| !travelling.contains(&b.id));
    }
    let body_of = |id: u32| clumps[..clumps.partition_point(|b| b.id <= id)].last();
    particles.retain(|p| !body_of(p.id).is_some_and(|b| b.has(p.id)));
    let setup = &model.setup;
    let mut energy = ledger_terms(state, setup);
    for [translation, rotation, potential] in particles.iter().map(|p| carried(p, setup)) {
        energy.translation += translation;
        energy.rotation += rotation;
        energy.potential += potential;
    }
    for clump in &clumps {
        let material = setup.clumps.shapes[clump.shape as usize].material;
        let heavy = heavy(setup, setup.materials[material as usize].density);
        energy.translation += 0.5 * clump.mass * clump.velocity.norm_squared();
        energy.rotation += 0.5 * clump.spin.dot(&clump.angular_momentum);
        energy.potential -= clump.mass * heavy * setup.gravity.dot(&clump.position);
    }
    [energy.mount_kinetic, energy.mount_elastic] = mount::energy(model, state, lists);
    if setup.ledger {
        close_step(model, state, lists, &mut energy);
    }
    energy
}

/// The terms of the ledger, and what the springs of contacts and bonds hold.
fn ledger_terms(state: &State, setup: &Setup) -> Energy {
    let State { ledger, contacts, bonds, .. } = state;
    Energy {
        normal: ledger.dissipated[0] + ledger.lost,
        sliding: ledger.dissipated[1],
        rolling: ledger.dissipated[2],
        twisting: ledger.dissipated[3],
        bonds: ledger.bonds + ledger.broken,
        walls: ledger.walls,
        slept: ledger.slept,
        drag: ledger.drag,
        local_damping: ledger.damped,
        mount_damping: ledger.mounts,
        entered: ledger.entered,
        left: ledger.left,
        elastic: if setup.ledger { contacts.elastic() + bonds.elastic() } else { 0.0 },
        ..Energy::default()
    }
}
