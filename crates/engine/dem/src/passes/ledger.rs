//! The energy ledger: what each step adds to its sums.

use crate::model::Model;
use crate::neighbours::{NeighbourLists, Slots};
use crate::passes::bonds::freed_energy;
use crate::passes::drag::drag_power;
use crate::passes::instant::driven_now;
use crate::passes::touching::position_before;
use crate::passes::zones::idle_contacts::{bring, mute};
use crate::passes::zones::ledger::ZoneWork;
use crate::passes::{cell, local_damping, mount};
use crate::setup::Particle;
use crate::state::ledger::{carried, heavy, unwrapped_potential};
use crate::state::{ContactColumns, DrivenBody, Energy, LedgerSums, State};
use geom::Vec3;
use laws::contact::{LEDGER, LOST};
use laws::effects::DISSIPATORS;
use laws::space::sphere::inverse_inertia;

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
        let (row, a) = (&p.rows[k], p.acceleration[k].vector());
        let (spin, angular_acceleration) = p.rotation(k);
        // The moved velocity is predicted from the one of the step and its acceleration.
        let (velocity, spin) = (row.velocity() - a * model.dt, spin - angular_acceleration * model.dt);
        work += DrivenBody { velocity, spin, ..driven(model, state, k, a, angular_acceleration) }.power();
    }
    work += state.clumps.last_driven(&model.setup, model.dt).map(|d| d.power()).sum::<f64>();
    state.ledger.work += work * model.dt + state.clumps.made_by_turning(model.dt);
}

/// Opens the ledger, and later books particles `starting` that become free: their drive has booked the first half of their first step. Forces are those
/// of this instant.
pub fn open(model: &Model, state: &mut State, lists: &NeighbourLists, starting: &[u32]) {
    if !model.setup.ledger {
        return;
    }
    mute(model, state, lists);
    if !state.ledger.opened {
        let mut energy = Energy::default();
        close_step(model, state, lists, &mut energy);
        (state.ledger.start, state.ledger.opened) = (energy.integration, true);
        return;
    }
    if starting.is_empty() {
        return;
    }
    let sums = state.contacts.sums();
    let free = starting.iter().map(|&k| k as usize).filter(|&k| is_driven(state, k));
    let clumps = state.clumps.driven_now(model, state, &sums).filter(|(first, _)| starting.contains(first));
    let driven = free.map(|k| driven_now(model, state, k, &sums)).chain(clumps.map(|(_, d)| d));
    let halves = driven.map(|d| half(model, d.power(), d.step_share()));
    let (work, share) = halves.fold((0.0, 0.0), |(w, s), h| (w + h.0, s + h.1));
    // Until now they were moved, and took this half from their drive.
    state.ledger.entered -= work;
    state.ledger.passed += work;
    state.ledger.work -= work + share;
    bring(model, state, lists, starting);
}

/// What the energy of this instant is above that which velocity Verlet keeps [J]: it swings with the springs, and is no gain.
///
/// ```text
/// ½ v·M v + U − Δt²/8 F·M⁻¹F        is kept where forces are linear in positions
/// ```
pub fn swing(model: &Model, state: &State, lists: &NeighbourLists) -> f64 {
    let sums = state.contacts.sums();
    let free = (0..state.particles.len()).filter(|&k| is_driven(state, k));
    let clumps = state.clumps.driven_now(model, state, &sums).map(|(_, d)| d);
    let driven = free.map(|k| driven_now(model, state, k, &sums)).chain(clumps);
    let driven = driven.chain(mount::bodies(model, state, lists));
    0.125 * model.dt * model.dt * driven.map(|d| d.force_squared()).sum::<f64>()
}

/// Half the work of a power [W] in a step, and what a step's share [J/s²] makes [J].
fn half(model: &Model, power: f64, share: f64) -> (f64, f64) {
    (0.5 * power * model.dt, 0.125 * share * model.dt * model.dt)
}

/// Energy [J] that free particle `k` carried in the middle of the last move; what has just become free has none behind it, and has what it brought.
pub fn carried_in_the_middle(model: &Model, state: &State, k: usize) -> f64 {
    let is_new = state.starting.contains(&(k as u32));
    let (p, dt) = (&state.particles, if is_new { 0.0 } else { model.dt });
    let (row, a) = (&p.rows[k], p.acceleration[k].vector());
    let (spin, angular_acceleration) = p.rotation(k);
    let (velocity, spin) = (row.velocity() - a * (0.5 * dt), spin - angular_acceleration * (0.5 * dt));
    let before = if is_new { p.position(k) } else { position_before(model, state, k) };
    let position = (p.position(k) + before) * 0.5;
    let (id, material, radius) = (p.id[k], p.material[k], row.radius());
    let there = Particle { id, material, radius, position, velocity, spin };
    carried(&there, &model.setup).iter().sum()
}

/// Brings the ledger to this instant, whose forces are known: losses of a single instant count whole, all other terms of the step half.
pub fn close_step(model: &Model, state: &State, lists: &NeighbourLists, energy: &mut Energy) {
    let mut now = LedgerSums::default();
    now.add(&lists.slots, &state.contacts);
    now.add_bonds(&state.bonds, model.dt, freed_energy(state, lists));
    let sums = state.contacts.sums();
    let free = (0..state.particles.len()).filter(|&k| is_driven(state, k));
    let clumps = state.clumps.driven_now(model, state, &sums).map(|(_, d)| d);
    let driven = free.clone().map(|k| driven_now(model, state, k, &sums)).chain(clumps);
    let driven = driven.chain(mount::bodies(model, state, lists));
    let (power, share) = driven.fold((0.0, 0.0), |(p, s), d| (p + d.power(), s + d.step_share()));
    let drag = free.clone().map(|k| drag_power(model, state, k)).sum::<f64>()
        + state.clumps.drag_power(&model.setup);
    now.drag = drag * model.dt;
    let damped = free.map(|k| local_damping::power(model, state, k, &sums)).sum::<f64>();
    now.damped = (damped + state.clumps.damped_power(model, state, &sums)) * model.dt;
    let [brought, dashpots] = mount::step_sums(model, state, lists);
    (now.walls, now.mounts) = (now.walls - brought + cell::step_work(model, state, lists), dashpots);
    let (work, share) = half(model, power, share);
    let ZoneWork { entering, leaving } = ZoneWork::of(model, state, lists);
    energy.entered -= 0.5 * entering;
    energy.left += 0.5 * leaving;
    energy.normal += now.lost;
    energy.bonds += now.broken;
    energy.half_step = 0.5 * now.gone();
    let (ledger, lost) = (&state.ledger, |a: &LedgerSums| a.lost + a.broken);
    let passed = ledger.passed + 0.5 * (entering + leaving);
    let done = ledger.work + work + share + passed + lost(ledger) + lost(&now);
    energy.integration = done
        + ledger.gone()
        + energy.half_step
        + state.contacts.elastic()
        + state.bonds.elastic()
        + mount::elastic(model, state)
        - ledger.start;
    if model.setup.periodic.iter().any(Option::is_some) {
        energy.potential = unwrapped_potential(model, state) + ledger.wrapped;
    }
}

/// After the forces of a step: what contacts and bonds did.
pub fn add_contacts(model: &Model, state: &mut State, lists: &NeighbourLists) {
    if !model.setup.ledger {
        return;
    }
    mute(model, state, lists);
    let freed = freed_energy(state, lists);
    let State { ledger, contacts, bonds, .. } = state;
    ledger.add(&lists.slots, contacts);
    ledger.add_bonds(bonds, model.dt, freed);
    state.contacts.add_work();
    state.ledger.walls += cell::step_work(model, state, lists);
    let ZoneWork { entering, leaving } = ZoneWork::of(model, state, lists);
    state.ledger.passed += entering + leaving;
    state.ledger.entered -= entering;
    state.ledger.left += leaving;
}

/// Whether forces drive a particle: it is free, awake, and no member of a rigid clump.
fn is_driven(state: &State, k: usize) -> bool {
    state.zones.is_free(k)
        && !state.clumps.is_member(k)
        && !state.sleepers.as_ref().is_some_and(|s| s.sleeps(k))
}

/// What an acceleration [m/s²] and an angular acceleration [rad/s²] are made by; it stands still.
pub fn driven(model: &Model, state: &State, k: usize, a: Vec3, angular_acceleration: Vec3) -> DrivenBody {
    let row = &state.particles.rows[k];
    let density = model.setup.materials[state.particles.material[k] as usize].density;
    let weight = model.setup.gravity * heavy(&model.setup, density);
    let (mass, inverse_inertia) =
        (1.0 / row.inverse_mass(), inverse_inertia(row.radius(), row.inverse_mass()));
    let moment = angular_acceleration / inverse_inertia;
    let (velocity, spin) = (Vec3::zeros(), Vec3::zeros());
    let forces = [(a - weight) * mass, a * mass];
    let turning = angular_acceleration;
    DrivenBody { inverse_mass: row.inverse_mass(), forces, moment, turning, velocity, spin }
}

impl LedgerSums {
    /// Adds one step's ledger, in its order.
    pub fn add(&mut self, slots: &Slots, contacts: &ContactColumns) {
        for segment in &slots.segments {
            let range = segment.contacts();
            let wall = segment.with.is_wall();
            for row in contacts.ledger[range.start * LEDGER..range.end * LEDGER].chunks_exact(LEDGER) {
                for (sum, part) in self.dissipated.iter_mut().zip(&row[1..=DISSIPATORS]) {
                    *sum += part;
                }
                if wall {
                    self.walls += row[1 + DISSIPATORS];
                }
                self.lost += row[LOST];
            }
        }
    }
}
