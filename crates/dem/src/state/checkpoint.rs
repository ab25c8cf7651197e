//! Checkpoints: the whole state of a run, so that a resumed one goes on bit for bit.

use crate::forces::sweep::Pass;
use crate::model::error::SetupError;
use crate::passes::servo::Piston;
use crate::passes::sleep::Sleepers;
use crate::setup::Setup;
use crate::setup::Step;
use crate::simd::Width;
use crate::simulation::Simulation;
use crate::state::bonds::Bonds;
use crate::state::clumps::Bodies;
use crate::state::ledger::Account;
use crate::state::particles::Particles;
use crate::state::zones::Zones;
use serde::Deserialize;
use serde::Serialize;

/// Everything that a setup and the lists do not give.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct State {
    dt: f64,
    skin: f64,
    steps: u64,
    listed: u64,
    out: bool,
    stale: bool,
    current: bool,
    fresh: Vec<u32>,
    particles: Particles,
    zones: Zones,
    bodies: Bodies,
    bonds: Bonds,
    sleepers: Option<Sleepers>,
    pistons: Vec<Piston>,
    account: Account,
    listings: u64,
    /// Contact memory, by place.
    memory: Vec<f64>,
    /// Whether nothing has been computed of the lists.
    new: bool,
    /// Sliding work of each contact that has not been recorded, by place.
    work: Vec<f64>,
    /// Loads, couples and ledger of each contact, when they are those of this step and kept.
    loads: [Vec<f64>; 3],
    /// Sums of loads and couples by particle, when they are those of this step and loads are not kept.
    sums: [Vec<f64>; 2],
}

/// The like, borrowed from a simulation; serialized, it is a [`State`].
#[derive(Debug, Serialize)]
pub struct StateView<'a> {
    dt: f64,
    skin: f64,
    steps: u64,
    listed: u64,
    out: bool,
    stale: bool,
    current: bool,
    fresh: &'a [u32],
    particles: &'a Particles,
    zones: &'a Zones,
    bodies: &'a Bodies,
    bonds: &'a Bonds,
    sleepers: Option<&'a Sleepers>,
    pistons: &'a [Piston],
    account: Account,
    listings: u64,
    memory: &'a [f64],
    new: bool,
    work: &'a [f64],
    loads: [&'a [f64]; 3],
    sums: [&'a [f64]; 2],
}

impl StateView<'_> {
    /// A copy that outlives the simulation.
    pub fn to_state(&self) -> State {
        State {
            dt: self.dt,
            skin: self.skin,
            steps: self.steps,
            listed: self.listed,
            out: self.out,
            stale: self.stale,
            current: self.current,
            fresh: self.fresh.to_vec(),
            particles: self.particles.clone(),
            zones: self.zones.clone(),
            bodies: self.bodies.clone(),
            bonds: self.bonds.clone(),
            sleepers: self.sleepers.cloned(),
            pistons: self.pistons.to_vec(),
            account: self.account,
            listings: self.listings,
            memory: self.memory.to_vec(),
            new: self.new,
            work: self.work.to_vec(),
            loads: self.loads.map(<[f64]>::to_vec),
            sums: self.sums.map(<[f64]>::to_vec),
        }
    }
}

impl State {
    /// Steps done.
    pub fn steps(&self) -> u64 {
        self.steps
    }
    /// Δt [s].
    pub fn dt(&self) -> f64 {
        self.dt
    }
    /// Steps × Δt [s].
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.dt
    }

    /// Entries due until [`State::time`] + this [s] had been given.
    pub fn look_ahead(&self) -> f64 {
        self.dt * crate::state::zones::LOOK_AHEAD as f64
    }
}

impl Simulation {
    /// The state of this instant.
    pub fn state(&self) -> StateView<'_> {
        let c = &self.contacts;
        let sums = c.sums().sums;
        StateView {
            dt: self.dt,
            skin: self.skin,
            steps: self.steps,
            listed: self.listed,
            out: self.out,
            stale: self.stale,
            current: self.current,
            fresh: &self.fresh,
            particles: &self.particles,
            zones: &self.zones,
            bodies: &self.bodies,
            bonds: &self.bonds,
            sleepers: self.sleepers.as_ref(),
            pistons: &self.pistons,
            account: self.account,
            listings: self.listings,
            memory: &self.contacts.memory,
            work: &self.contacts.work,
            new: c.new,
            // Loads between sleepers are those of the step in which they fell asleep.
            loads: match (self.current || self.sleepers.is_some(), c.keeps()) {
                (true, true) => [&c.loads, &c.couples, &c.ledger],
                (true, false) => [&[], &[], &c.ledger],
                (false, _) => [&[]; 3],
            },
            sums: if self.current && !c.keeps() { [sums.0, sums.1] } else { [&[]; 2] },
        }
    }

    /// Goes on from a state of the same setup.
    ///
    /// # Errors
    /// A setup that cannot run, or a state of another one.
    pub fn resume(setup: Setup, state: State) -> Result<Simulation, SetupError> {
        let other = |what: &str| SetupError::OtherState(what.to_owned());
        let asked = if let Step::Fixed(dt) = setup.step { dt } else { state.dt };
        if asked != state.dt || !(asked > 0.0 && asked.is_finite()) {
            return Err(other(&format!("time step {asked} s, saved {} s", state.dt)));
        }
        // It goes on with the step it began with, also where a guard that enters the critical step has changed.
        let mut sim = Simulation::build(setup, Width::best(), Some(state.dt))?;
        if sim.sleepers.is_some() != state.sleepers.is_some() {
            return Err(other("one has particles that sleep and the other has not"));
        }
        if sim.particles.rotates() != state.particles.rotates() {
            return Err(other("one has rotation and the other has not"));
        }
        (sim.skin, sim.steps, sim.listed, sim.out) = (state.skin, state.steps, state.listed, state.out);
        (sim.particles, sim.zones, sim.account) = (state.particles, state.zones, state.account);
        if sim.bonds.none() != state.bonds.none() || sim.bonds.count()[0] > state.bonds.count()[0] {
            return Err(other("another number of bonds"));
        }
        (sim.bodies, sim.bonds) = (state.bodies, state.bonds);
        sim.bonds.index(&sim.particles.id);
        (sim.fresh, sim.listings, sim.sleepers) = (state.fresh, state.listings, state.sleepers);
        if sim.pistons.len() != state.pistons.len() {
            return Err(other("one has walls that follow a force and the other has not"));
        }
        sim.pistons = state.pistons;
        if state.listings > 0 {
            // Those who have left since were still there when neighbours were listed.
            for (k, home) in sim.zones.left.clone() {
                sim.particles.home[k as usize] = home;
            }
            sim.list_again();
            sim.make_room();
            for (k, _) in sim.zones.left.clone() {
                let row = sim.particles.rows[k as usize];
                sim.particles.home[k as usize].0 = [row[0], row[1], row[2], 0.0];
            }
            if state.memory.len() != sim.contacts.memory.len() {
                return Err(other("another number of contacts"));
            }
            sim.contacts.memory.copy_from_slice(&state.memory);
            if state.work.len() == sim.contacts.work.len() {
                sim.contacts.work = state.work;
            }
        }
        sim.stale = state.stale;
        let [loads, ..] = &state.loads;
        if state.current || !loads.is_empty() {
            // Where nobody meets anybody, loads that are kept are none, either.
            let kept = state.sums.iter().all(Vec::is_empty);
            sim.contacts.keep_each(kept);
            // A crossing in this step asks where walls were touched, and so do sleepers on walls at rest.
            sim.find_contact_points();
            if !sim.contacts.put_loads(&state.loads, &state.sums) {
                return Err(other("another number of loads"));
            }
            sim.current = state.current;
            sim.contacts.new = state.new;
            if kept {
                sim.pass(Pass::Recall);
            }
        }
        Ok(sim)
    }
}
