//! Observing a simulation: everything is of this instant, and nothing that is observed changes.

use super::Simulation;
use crate::model::halt::Halt;
use crate::neighbours::poses::pose;
use crate::observe::explain::{ContactBytes, EffectCost};
use crate::observe::record::ContactRecord;
use crate::observe::snapshot::Snapshot;
use crate::observe::{explain, guards, record, snapshot};
use crate::passes::bonds::pull;
use crate::passes::clumps::instant::BodyState;
use crate::passes::servo;
use crate::passes::servo::WallForce;
use crate::setup::Particle;
use crate::state::bonds::BondState;
use crate::state::energy::Energy;
use crate::state::sleepers::Sleepers;
use geom::Vec3;

impl Simulation {
    /// Whether the wrench of each contact is kept when a run is observed, as it is by default: 64 bytes a contact that only
    /// [`Simulation::record_contacts`] and [`Simulation::wall_forces`] want.
    pub fn record_loads(&mut self, records: bool) {
        self.lists.records = records;
    }

    /// Time step [s].
    pub fn dt(&self) -> f64 {
        self.model.dt
    }

    /// Steps done.
    pub fn steps(&self) -> u64 {
        self.state.steps
    }

    /// Steps × Δt [s].
    pub fn time(&self) -> f64 {
        self.state.time()
    }

    /// How often neighbours were listed so far.
    pub fn rebuilds(&self) -> u64 {
        self.state.listing.rebuilds
    }

    /// Gap up to which neighbours are listed [m].
    pub fn skin(&self) -> f64 {
        self.state.listing.skin
    }

    /// Number of contacts listed now.
    pub fn listed_contacts(&self) -> usize {
        self.lists.contacts.len()
    }

    /// Number of particles that sleep.
    pub fn asleep(&self) -> usize {
        self.state.sleepers.as_ref().map_or(0, Sleepers::count)
    }

    /// Number of particles in the calculation.
    pub fn particle_count(&self) -> usize {
        let hidden = self.state.zones.hidden(self.time());
        (0..self.state.particles.len()).filter(|&k| !hidden(k)).count()
    }

    /// Wall spheres of a wall, as they are now: centre, radius [m], in the order they were given.
    pub fn wall_spheres(&self, wall: usize) -> Vec<(Vec3, f64)> {
        self.model.walls[wall].spheres(&pose(&self.model, &self.state, wall, self.time()))
    }

    /// Whether a wall moves.
    pub fn wall_moves(&self, wall: usize) -> bool {
        self.model.walls[wall].motion.moves()
    }

    /// Whether a wall follows a force.
    pub fn wall_follows(&self, wall: usize) -> bool {
        self.model.walls[wall].motion.servo.is_some()
    }

    /// Whether everything that moves is at a position and has a velocity: what a run can be resumed from.
    pub fn is_finite(&self) -> bool {
        guards::is_finite(&self.state, &self.lists)
    }

    /// Force on each wall, and where it is.
    ///
    /// # Errors
    /// When the state is beyond a guard, or wrenches are not kept ([`Simulation::record_loads`]).
    pub fn wall_forces(&mut self) -> Result<Vec<WallForce>, Halt> {
        self.ready_to_record()?;
        Ok(servo::wall_forces(&self.model, &self.state, &self.lists))
    }

    /// All contacts that carry a force, or have done work since the last call, in the order of the lists.
    ///
    /// # Errors
    /// When the state is beyond a guard, or wrenches are not kept ([`Simulation::record_loads`]).
    pub fn record_contacts(&mut self) -> Result<Vec<ContactRecord>, Halt> {
        self.ready_to_record()?;
        Ok(record::record_contacts(&self.model, &self.state, &mut self.lists))
    }

    fn ready_to_record(&mut self) -> Result<(), Halt> {
        self.ready()?;
        if self.lists.contacts.keeps() { Ok(()) } else { Err(Halt::NotKept { time: self.time() }) }
    }

    /// Particles in the calculation, by id, with velocities of this instant.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn particles(&mut self) -> Result<Vec<Particle>, Halt> {
        self.ready()?;
        Ok(snapshot::particles(&self.model, &self.state, &self.lists))
    }

    /// The same, without a list of them: each is made when it is asked for.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn snapshot(&mut self) -> Result<Snapshot<'_>, Halt> {
        self.ready()?;
        Ok(Snapshot::new(&self.model, &self.state, &self.lists))
    }

    /// Rigid clumps in the calculation, by id, with velocities of this instant.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn bodies(&mut self) -> Result<Vec<BodyState>, Halt> {
        self.ready()?;
        Ok(self.state.bodies.states(&self.model, &self.state, &self.lists))
    }

    /// Bonds of this instant, broken ones as well, by ids.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn bonds(&mut self) -> Result<Vec<BondState>, Halt> {
        self.ready()?;
        Ok(pull::bonds(&self.model, &self.state))
    }

    /// How many bonds there were at the start or have come in, and how many of them have broken.
    pub fn bond_count(&self) -> [usize; 2] {
        self.state.bonds.count()
    }

    /// Energy of this instant [J]; elastic and dissipated parts only when the setup asked for the ledger.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn energy(&mut self) -> Result<Energy, Halt> {
        self.ready()?;
        Ok(snapshot::energy(&self.model, &self.state, &self.lists))
    }

    /// Effects in force, by pair of materials that can meet.
    pub fn explain(&self) -> Vec<EffectCost> {
        explain::effects(&self.model)
    }

    /// State of one particle [bytes], without its share of contacts.
    pub fn bytes_per_particle(&self) -> usize {
        explain::bytes_per_particle(&self.model, &self.state)
    }

    /// Memory of a rigid clump, and of each of its members beyond that of a particle [bytes].
    pub fn bytes_of_clump() -> (usize, usize) {
        crate::state::clumps::RigidClumps::bytes()
    }

    /// Memory that rigid clumps take beyond that of their members' rows [bytes].
    pub fn bytes_of_clumps(&self) -> usize {
        self.state.bodies.all_bytes()
    }

    /// Memory that bonds take, with what they keep of their particles [bytes].
    pub fn bytes_of_bonds(&self) -> usize {
        self.state.bonds.bytes()
    }

    /// What a listed contact takes without the history of its effects.
    pub fn bytes_of_contact(&self) -> ContactBytes {
        explain::bytes_of_contact(&self.model, &self.state)
    }

    /// Whether particles turn in this scene.
    pub fn rotates(&self) -> bool {
        self.model.rotates
    }
}
