//! The energy ledger: what each step adds to its sums.

use crate::effects::DISSIPATORS;
use crate::kernel::{LEDGER, LOST};
use crate::model::Model;
use crate::model::kind::{Kind, With};
use crate::neighbours::NeighbourLists;
use crate::neighbours::contacts::Contacts;
use crate::passes::drag::drag_power;
use crate::passes::instant::driven_now;
use crate::passes::touching::position_before;
use crate::passes::zones::ledger::add_zones;
use crate::setup::Particle;
use crate::simd::Row4;
use crate::state::State;
use crate::state::energy::Energy;
use crate::state::ledger::{DrivenBody, LedgerSums, carried, heavy, unwrapped_potential};
use crate::state::zones::Zones;
use geom::Vec3;

/// After a move: what contacts and fluid did to each particle in it.
pub fn add_moves(model: &Model, state: &mut State) {
    if !model.setup.ledger {
        return;
    }
    let mut work = 0.0;
    for k in (0..state.particles.len()).filter(|&k| is_driven(state, k)) {
        if state.sleepers.as_ref().is_some_and(|s| s.fell_asleep(k)) {
            continue;
        }
        let p = &state.particles;
        let (row, a) = (&p.rows[k], p.acceleration[k]);
        let (spin, turning) = match (p.spins.get(k), p.turning.get(k)) {
            (Some(w), Some(t)) => (*w, *t),
            _ => (Row4::default(), Row4::default()),
        };
        // The moved velocity is predicted from the one of the step and its acceleration.
        let back = |predicted: [f64; 3], rate: [f64; 3]| Vec3::from(predicted) - Vec3::from(rate) * model.dt;
        let velocity = back([row[4], row[5], row[6]], three(a));
        let spin = back(three(spin), three(turning));
        work += DrivenBody { velocity, spin, ..driven(model, state, k, three(a), three(turning)) }.power();
    }
    work += state.bodies.last_driven(&model.setup, model.dt).map(|d| d.power()).sum::<f64>();
    state.ledger.work += work * model.dt;
}

/// Particles `fresh` begin their first step: its first half was before them. Loads are those of this instant.
pub fn open(model: &Model, state: &mut State, lists: &NeighbourLists, starting: &[u32]) {
    if !model.setup.ledger {
        return;
    }
    if !state.ledger.opened {
        let mut energy = Energy::default();
        close_step(model, state, lists, &mut energy);
        (state.ledger.start, state.ledger.opened) = (energy.integration, true);
        return;
    }
    if starting.is_empty() {
        return;
    }
    let loads = lists.contacts.sums();
    let free = starting.iter().map(|&k| k as usize).filter(|&k| is_driven(state, k));
    let bodies = state.bodies.driven_now(model, state, &loads).filter(|(first, _)| starting.contains(first));
    let driven = free.map(|k| driven_now(model, state, k, &loads)).chain(bodies.map(|(_, d)| d));
    let halves = driven.map(|d| half(model, d.power(), d.step_share()));
    let (work, share) = halves.fold((0.0, 0.0), |(w, s), h| (w + h.0, s + h.1));
    // Until now they were moved, and took this half from their drive.
    state.ledger.entered -= work;
    state.ledger.passed += work;
    state.ledger.work -= work + share;
}

/// Half the work of a power [W] in a step, and what a step's share [J/s²] makes [J].
fn half(model: &Model, power: f64, share: f64) -> (f64, f64) {
    (0.5 * power * model.dt, 0.125 * share * model.dt * model.dt)
}

/// A free particle is taken over in the middle of its last step, with an energy `taken` [J]: what the finite step made of it.
pub fn close_crossing(model: &Model, state: &mut State, k: usize, taken: f64) {
    let (p, dt) = (&state.particles, model.dt);
    let half = |v: Row4, a: Row4| Vec3::from(three(v)) - Vec3::from(three(a)) * (0.5 * dt);
    let (row, a) = (&p.rows[k], p.acceleration[k]);
    let velocity = half(Row4([row[4], row[5], row[6], 0.0]), a);
    let middle = (p.position(k) + position_before(model, state, k)) * 0.5;
    let spin = match (p.spins.get(k), p.turning.get(k)) {
        (Some(w), Some(t)) => half(*w, *t),
        _ => Vec3::zeros(),
    };
    let (id, material, radius) = (p.id[k], p.material[k], row[3]);
    let there = Particle { id, material, radius, position: middle, velocity, spin };
    state.ledger.passed += taken - carried(&there, &model.setup).iter().sum::<f64>();
}

/// Brings the ledger to this instant, whose loads are known: what is lost at once is gone, of all else half is done.
pub fn close_step(model: &Model, state: &State, lists: &NeighbourLists, energy: &mut Energy) {
    let mut now = LedgerSums::default();
    now.add(&model.kinds, &lists.contacts, &state.zones);
    now.add_bonds(&state.bonds, model.dt);
    let loads = lists.contacts.sums();
    let free = (0..state.particles.len()).filter(|&k| is_driven(state, k));
    let bodies = state.bodies.driven_now(model, state, &loads).map(|(_, d)| d);
    let driven = free.clone().map(|k| driven_now(model, state, k, &loads)).chain(bodies);
    let (power, share) = driven.fold((0.0, 0.0), |(p, s), d| (p + d.power(), s + d.step_share()));
    let drag = free.map(|k| drag_power(model, state, k)).sum::<f64>() + state.bodies.drag_power(&model.setup);
    now.drag = drag * model.dt;
    let (work, share) = half(model, power, share);
    energy.normal += now.lost;
    energy.bonds += now.broken;
    energy.half_step = 0.5 * now.gone();
    let (ledger, lost) = (&state.ledger, |a: &LedgerSums| a.lost + a.broken);
    let done = ledger.work + work + share + ledger.passed + lost(ledger) + lost(&now);
    energy.integration =
        done + ledger.gone() + energy.half_step + lists.contacts.elastic() + state.bonds.elastic()
            - ledger.start;
    if model.setup.periodic.iter().any(Option::is_some) {
        energy.potential = unwrapped_potential(model, state) + ledger.wrapped;
    }
}

/// After the forces of a step: what contacts and bonds did.
pub fn add_contacts(model: &Model, state: &mut State, lists: &mut NeighbourLists) {
    if !model.setup.ledger {
        return;
    }
    state.ledger.add(&model.kinds, &lists.contacts, &state.zones);
    state.ledger.add_bonds(&state.bonds, model.dt);
    lists.contacts.add_work();
    add_zones(model, state, lists);
}

/// Whether forces drive a particle: it is free, awake, and no member of a rigid clump.
fn is_driven(state: &State, k: usize) -> bool {
    !state.zones.travels(k)
        && !state.zones.is_gone(k)
        && !state.bodies.is_member(k)
        && !state.sleepers.as_ref().is_some_and(|s| s.sleeps(k))
}

/// What an acceleration [m/s²] and an angular acceleration [rad/s²] are made by; it stands still.
pub fn driven(model: &Model, state: &State, k: usize, a: [f64; 3], turning: [f64; 3]) -> DrivenBody {
    let row = &state.particles.rows[k];
    let density = model.setup.materials[state.particles.material[k] as usize].density;
    let weight = model.setup.gravity * heavy(&model.setup, density);
    let (mass, inverse_inertia) = (1.0 / row[7], 2.5 * row[7] / (row[3] * row[3]));
    let (a, moment) = (Vec3::from(a), Vec3::from(turning) / inverse_inertia);
    let (velocity, spin) = (Vec3::zeros(), Vec3::zeros());
    let forces = [(a - weight) * mass, a * mass];
    DrivenBody { inverse_mass: row[7], inverse_inertia, forces, moment, velocity, spin }
}

fn three(row: Row4) -> [f64; 3] {
    [row[0], row[1], row[2]]
}

impl LedgerSums {
    /// Adds one step's ledger, in its order. What a contact that acts on no particle took or brought is part of the work on zone particles, and is booked with it.
    pub fn add(&mut self, kinds: &[Kind], contacts: &Contacts, zones: &Zones) {
        for segment in &contacts.segments {
            let places = segment.contacts();
            let rows = &contacts.ledger[places.start * LEDGER..places.end * LEDGER];
            let with = kinds[segment.kind].with;
            let wall = matches!(with, With::Wall(_));
            for (place, row) in places.zip(rows.chunks_exact(LEDGER)) {
                let (dissipated, surface) =
                    (&row[1..=DISSIPATORS], if wall { row[1 + DISSIPATORS] } else { 0.0 });
                if zones.idles(contacts.ends(with, place)) {
                    let gone = dissipated.iter().sum::<f64>() - surface;
                    self.left += gone;
                    self.passed += gone;
                } else {
                    for (sum, part) in self.dissipated.iter_mut().zip(dissipated) {
                        *sum += part;
                    }
                    self.walls += surface;
                }
                self.lost += row[LOST];
            }
        }
    }
}
