//! Checkpoints: the whole state of a run, so that a resumed one goes on bit for bit.

use crate::bodies::Bodies;
use crate::energy::Account;
use crate::error::SetupError;
use crate::particles::Particles;
use crate::setup::{Setup, Step};
use crate::simulation::Simulation;
use crate::zones::Zones;
use serde::{Deserialize, Serialize};

/// Everything that a setup and the lists do not give.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct State {
    dt: f64,
    skin: f64,
    steps: u64,
    listed: u64,
    away: f64,
    stale: bool,
    current: bool,
    fresh: Vec<u32>,
    particles: Particles,
    zones: Zones,
    bodies: Bodies,
    account: Account,
    listings: u64,
    /// Contact memory of each interaction; empty while lists are stale from the start.
    memory: Vec<Vec<f64>>,
    /// Loads, couples and ledger, when they are those of this step.
    loads: [Vec<f64>; 3],
}

/// The like, borrowed from a simulation; serialized, it is a [`State`].
#[derive(Debug, Serialize)]
pub struct StateView<'a> {
    dt: f64,
    skin: f64,
    steps: u64,
    listed: u64,
    away: f64,
    stale: bool,
    current: bool,
    fresh: &'a [u32],
    particles: &'a Particles,
    zones: &'a Zones,
    bodies: &'a Bodies,
    account: Account,
    listings: u64,
    memory: Vec<&'a [f64]>,
    loads: [&'a [f64]; 3],
}

impl StateView<'_> {
    /// A copy that outlives the simulation.
    pub fn to_state(&self) -> State {
        State {
            dt: self.dt,
            skin: self.skin,
            steps: self.steps,
            listed: self.listed,
            away: self.away,
            stale: self.stale,
            current: self.current,
            fresh: self.fresh.to_vec(),
            particles: self.particles.clone(),
            zones: self.zones.clone(),
            bodies: self.bodies.clone(),
            account: self.account,
            listings: self.listings,
            memory: self.memory.iter().map(|m| m.to_vec()).collect(),
            loads: self.loads.map(<[f64]>::to_vec),
        }
    }
}

impl State {
    /// Steps done.
    pub fn steps(&self) -> u64 {
        self.steps
    }
    /// Steps × Δt [s].
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.dt
    }
}

impl Simulation {
    /// The state of this instant.
    pub fn state(&self) -> StateView<'_> {
        StateView {
            dt: self.dt,
            skin: self.skin,
            steps: self.steps,
            listed: self.listed,
            away: self.away,
            stale: self.stale,
            current: self.current,
            fresh: &self.fresh,
            particles: &self.particles,
            zones: &self.zones,
            bodies: &self.bodies,
            account: self.account,
            listings: self.listings,
            memory: self.interactions.iter().map(|i| i.all_memory()).collect(),
            loads: if self.current { [&self.loads, &self.couples, &self.ledger] } else { [&[]; 3] },
        }
    }

    /// Goes on from a state of the same setup.
    ///
    /// # Errors
    /// A setup that cannot run, or a state of another one.
    pub fn resume(setup: Setup, state: State) -> Result<Simulation, SetupError> {
        // "auto" goes on with the step it began with, also where a guard that enters the critical step has changed.
        let step = if let Step::Auto(_) = setup.step { Step::Fixed(state.dt) } else { setup.step };
        let mut sim = Simulation::new(Setup { step, ..setup })?;
        let other = |what: &str| SetupError::OtherState(what.to_owned());
        if sim.dt != state.dt {
            return Err(other(&format!("time step {} s, saved {} s", sim.dt, state.dt)));
        }
        if sim.particles.rotates() != state.particles.rotates() {
            return Err(other("one has rotation and the other has not"));
        }
        (sim.skin, sim.steps, sim.listed, sim.away) = (state.skin, state.steps, state.listed, state.away);
        (sim.particles, sim.zones, sim.account) = (state.particles, state.zones, state.account);
        sim.bodies = state.bodies;
        (sim.fresh, sim.listings) = (state.fresh, state.listings);
        if state.memory.len() != sim.interactions.len() {
            return Err(other("another number of materials or walls"));
        }
        if state.listings > 0 {
            // Those who have left since were still there when neighbours were listed.
            for (k, home) in sim.zones.left.clone() {
                sim.particles.home[k as usize] = home;
            }
            sim.list_contacts();
            sim.make_room();
            for (k, _) in sim.zones.left.clone() {
                let row = sim.particles.rows[k as usize];
                sim.particles.home[k as usize] = [row[0], row[1], row[2], 0.0];
            }
            for (interaction, memory) in sim.interactions.iter_mut().zip(&state.memory) {
                if !interaction.restore_memory(memory) {
                    return Err(other("another number of contacts"));
                }
            }
        }
        sim.stale = state.stale;
        if state.current {
            let [loads, couples, ledger] = state.loads;
            if loads.len() != sim.loads.len()
                || couples.len() != sim.couples.len()
                || ledger.len() != sim.ledger.len()
            {
                return Err(other("another number of loads"));
            }
            (sim.loads, sim.couples, sim.ledger, sim.current) = (loads, couples, ledger, true);
            // A crossing in this step asks where walls were touched.
            let time = sim.time();
            for interaction in &mut sim.interactions {
                interaction.renew(&sim.particles, &sim.walls, time, true);
            }
            sim.just_listed = false;
        }
        Ok(sim)
    }
}
