//! Observing a simulation: everything is of this instant, and nothing that is observed changes.

use super::Simulation;
use crate::model::Halt;
use crate::neighbours::poses::pose;
use crate::observe::snapshot::Snapshot;
use crate::observe::{guards, record, snapshot, unbalanced};
use crate::passes::cell::CellReport;
use crate::passes::clumps::instant::ClumpState;
use crate::passes::servo::{ServoReport, WallForce};
use crate::passes::{bonds, cell, earlier_contacts, servo, wall_sums};
use crate::setup::{KeptContact, Particle};
use crate::state::{BondState, ContactRecord, Crack, Energy, Held, Sleepers, WallInterval};
use geom::Vec3;

impl Simulation {
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
        self.lists.slots.len()
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

    /// Histories of all contacts that have one, to start another simulation from its particles ([`crate::setup::Setup::kept`]).
    pub fn contact_histories(&self) -> impl Iterator<Item = KeptContact> + '_ {
        earlier_contacts::histories(&self.model, &self.state, &self.lists)
    }

    /// Wall spheres of a wall, as they are now: centre, radius [m], in the order they were given.
    pub fn wall_spheres(&self, wall: usize) -> Vec<(Vec3, f64)> {
        self.model.walls[wall].spheres(&pose(&self.model, &self.state, wall, self.time()))
    }

    /// Whether all positions, velocities and histories are finite: whether a run can be resumed from here.
    pub fn is_finite(&self) -> bool {
        guards::is_finite(&self.state)
    }

    /// Where spheres or triangles of a wall are now, by their numbers: centres and centroids [m].
    pub fn wall_part_positions(&self, wall: usize, parts: impl Iterator<Item = u32>) -> Vec<Vec3> {
        self.model.walls[wall].part_positions(&pose(&self.model, &self.state, wall, self.time()), parts)
    }

    /// Force on each wall, and where it is.
    ///
    /// # Errors
    /// When the state is beyond a guard, or wrenches are not kept ([`crate::Setup::record_wrenches`]).
    pub fn wall_forces(&mut self) -> Result<Vec<WallForce>, Halt> {
        self.ready_to_record()?;
        Ok(servo::wall_forces(&self.model, &self.state, &self.lists))
    }

    /// What particles have done to walls in all steps since the last call, up to this instant.
    ///
    /// # Errors
    /// When the state is beyond a guard, or nothing is added up ([`crate::Setup::wall_sums`]).
    pub fn take_wall_sums(&mut self) -> Result<WallInterval, Halt> {
        self.ready()?;
        if self.state.wall_sums.none() && !self.model.walls.is_empty() {
            return Err(Halt::NotKept { time: self.time() });
        }
        Ok(wall_sums::take(&self.model, &mut self.state, &self.lists))
    }

    /// Point of each wall about which its torque is, now [m]: on the axis of its first motion that turns, else its point at the origin at t = 0.
    pub fn wall_references(&self) -> Vec<Vec3> {
        wall_sums::references(&self.model, &self.state, &self.lists)
    }

    /// What each servo follows and how well it has held that, with the index of its wall; pushes are those of the last step.
    pub fn servos(&self) -> Vec<(usize, ServoReport)> {
        servo::reports(&self.model, &self.state)
    }

    /// What a strained cell is and does; `None` where no axis of it is strained.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn cell(&mut self) -> Result<Option<CellReport>, Halt> {
        self.ready()?;
        Ok(cell::report(&self.model, &self.state, &self.lists))
    }

    /// Stress that each axis of a strained cell follows [Pa], and how well it has held that.
    pub fn followed_stresses(&self) -> [Option<(f64, Held)>; 3] {
        cell::followed(&self.model, &self.state)
    }

    /// All contacts that carry a force, or have done work since the last call, in the order of the lists.
    ///
    /// # Errors
    /// When the state is beyond a guard, or wrenches are not kept ([`crate::Setup::record_wrenches`]).
    pub fn record_contacts(&mut self) -> Result<Vec<ContactRecord>, Halt> {
        self.ready_to_record()?;
        Ok(record::record_contacts(&self.model, &mut self.state, &self.lists))
    }

    fn ready_to_record(&mut self) -> Result<(), Halt> {
        self.ready()?;
        if self.state.contacts.keeps { Ok(()) } else { Err(Halt::NotKept { time: self.time() }) }
    }

    /// Particles in the calculation, by id, with velocities of this instant.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn particles(&mut self) -> Result<Vec<Particle>, Halt> {
        self.ready()?;
        Ok(snapshot::particles(&self.model, &self.state))
    }

    /// The same, without a list of them: each is made on demand.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn snapshot(&mut self) -> Result<Snapshot<'_>, Halt> {
        self.ready()?;
        Ok(Snapshot::new(&self.model, &self.state))
    }

    /// Rigid clumps in the calculation, by id, with velocities of this instant.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn clumps(&mut self) -> Result<Vec<ClumpState>, Halt> {
        self.ready()?;
        Ok(self.state.clumps.states(&self.model, &self.state))
    }

    /// Bonds of this instant, broken ones as well, by ids.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn bonds(&mut self) -> Result<Vec<BondState>, Halt> {
        self.ready()?;
        Ok(bonds::bonds(&self.model, &self.state))
    }

    /// Bonds that broke since the last call, by time.
    pub fn take_cracks(&mut self) -> Vec<Crack> {
        bonds::take_cracks(&mut self.state)
    }

    /// Materials of the bonds that were due and found no pair, since the last call.
    pub fn take_idle_bonds(&mut self) -> Vec<[String; 2]> {
        std::mem::take(&mut self.state.bonds.idle)
    }

    /// Clusters of particles by id, in their order; those that are not listed have none.
    pub fn clusters(&self) -> &[(u32, u32)] {
        &self.state.clusters
    }

    /// How many bonds there were at the start or have come in, and how many of them have broken.
    pub fn bond_count(&self) -> [usize; 2] {
        self.state.bonds.count()
    }

    /// Mean unbalanced force over mean contact force [–]: the mean of |F| over all free particles (a clump counts as one), with F the sum of contacts, bonds, weight
    /// and fluid, over the mean of |f| over all contacts that carry a force and all whole bonds. `None` where no contact carries a force.
    ///
    /// # Errors
    /// When the state is beyond a guard, or wrenches are not kept ([`crate::Setup::record_wrenches`]).
    pub fn unbalanced(&mut self) -> Result<Option<f64>, Halt> {
        self.ready_to_record()?;
        Ok(unbalanced::ratio(&self.model, &self.state, &self.lists))
    }

    /// Energy of this instant [J]; elastic and dissipated parts only when the setup asked for the ledger.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn energy(&mut self) -> Result<Energy, Halt> {
        self.ready()?;
        Ok(snapshot::energy(&self.model, &self.state, &self.lists))
    }

    /// Energy below which nothing moves [J]: what grains hold that touch up to the rounding of their places is less.
    pub fn energy_of_rest(&self) -> f64 {
        guards::rest(&self.model, &self.state)
    }
}
