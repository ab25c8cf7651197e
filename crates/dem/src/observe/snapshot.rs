//! Looking at a simulation: particles, clumps and energy of this instant. Nothing that is looked at changes.

use crate::kernel::sums::Loads;
use crate::model::error::Halt;
use crate::observe::clumps::BodyState;
use crate::observe::energy::Energy;
use crate::setup::Particle;
use crate::simulation::Simulation;
use crate::state::ledger::Driven;
use geom::Vec3;
use std::collections::BTreeSet;

/// What a particle does at this instant.
struct Instant {
    velocity: Vec3,
    spin: Vec3,
    acceleration: [f64; 3],
    turning: [f64; 3],
}

/// All particles at one instant, by id.
pub struct Snapshot<'a> {
    sim: &'a Simulation,
    loads: Loads<'a>,
    /// Velocity and spin of those that are members of clumps.
    members: Vec<Option<(Vec3, Vec3)>>,
    order: Vec<u32>,
}

impl Snapshot<'_> {
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
        let (k, p) = (self.order[n] as usize, &self.sim.particles);
        let Instant { velocity, spin, .. } = self.sim.instant(k, &self.loads);
        let (velocity, spin) = self.members.get(k).copied().flatten().unwrap_or((velocity, spin));
        Particle {
            id: p.id[k],
            material: p.material[k],
            radius: p.rows[k][3],
            position: self.sim.wrapped(p.position(k)),
            velocity,
            spin,
        }
    }
}

impl Simulation {
    /// Particles in the calculation, by id, with velocities of this instant.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn particles(&mut self) -> Result<Vec<Particle>, Halt> {
        let seen = self.snapshot()?;
        Ok((0..seen.len()).map(|n| seen.particle(n)).collect())
    }

    /// The same, without a list of them: each is made when it is asked for.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn snapshot(&mut self) -> Result<Snapshot<'_>, Halt> {
        self.ready()?;
        let (p, time) = (&self.particles, self.time());
        let loads = self.all_loads();
        let members = self.bodies.member_states(p, &loads, &self.setup, self.dt);
        // All at once: a list that grows takes twice its length, beside the largest state there is.
        let (hidden, mut order) = (self.zones.hidden(time), Vec::with_capacity(p.len()));
        order.extend((0..p.len() as u32).filter(|&k| !hidden(k as usize)));
        drop(hidden);
        order.sort_unstable_by_key(|&k| p.id[k as usize]);
        Ok(Snapshot { sim: self, loads, members, order })
    }

    /// Corrects what was predicted for particle `k`, whose loads are those of this instant.
    fn instant(&self, k: usize, loads: &Loads) -> Instant {
        let p = &self.particles;
        let row = &p.rows[k];
        let (free, half) = (!self.zones.travels(k), 0.5 * self.dt);
        let body = self.body_acceleration(k);
        let (force, moment) = loads.on(k, row[3]);
        let mut at = Instant {
            velocity: Vec3::new(row[4], row[5], row[6]),
            spin: Vec3::zeros(),
            acceleration: [0.0; 3],
            turning: [0.0; 3],
        };
        for a in 0..3 {
            at.acceleration[a] = force[a] * row[7] + body[a];
            if free {
                at.velocity[a] += half * (at.acceleration[a] - p.acceleration[k][a]);
            }
            if p.rotates() {
                at.spin[a] = p.spins[k][a];
                at.turning[a] = moment[a] * (2.5 * row[7] / (row[3] * row[3]));
                if free {
                    at.spin[a] += half * (at.turning[a] - p.turning[k][a]);
                }
            }
        }
        at
    }

    /// What drives particle `k` at this instant.
    pub(crate) fn driven_now(&self, k: usize, loads: &Loads) -> Driven {
        let Instant { velocity, spin, acceleration, turning } = self.instant(k, loads);
        Driven { velocity, spin, ..self.driven(k, acceleration, turning) }
    }

    /// Energy of this instant [J]; elastic and dissipated parts only when the setup asked for the ledger.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn energy(&mut self) -> Result<Energy, Halt> {
        let (mut particles, mut bodies) = (self.particles()?, self.bodies()?);
        if !self.zones.none() {
            let all = 0..self.particles.len();
            let travelling: BTreeSet<u32> =
                all.filter(|&k| self.zones.travels(k)).map(|k| self.particles.id[k]).collect();
            particles.retain(|p| !travelling.contains(&p.id));
            bodies.retain(|b| !travelling.contains(&b.id));
        }
        let body_of = |id: u32| bodies[..bodies.partition_point(|b| b.id <= id)].last();
        particles.retain(|p| !body_of(p.id).is_some_and(|b| b.has(p.id)));
        let mut energy = Energy::of(&particles, &self.setup, (&self.contacts, &self.bonds), &self.account);
        bodies.iter().for_each(|b| energy.add_body(b, &self.setup));
        if self.setup.ledger {
            let held = self.held_by_idle();
            energy.elastic -= held;
            energy.left += held;
            self.close_step(&mut energy);
        }
        Ok(energy)
    }

    /// Rigid clumps in the calculation, by id, with velocities of this instant.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn bodies(&mut self) -> Result<Vec<BodyState>, Halt> {
        self.ready()?;
        Ok(self.bodies.states(self))
    }
}
