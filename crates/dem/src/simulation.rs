//! The time loop.
//!
//! One step: `ready` (lists still hold? contact points of walls, loads of all contacts at time n), then `advance`
//! (gather, move to n + 1), then zones. Looking at a simulation calls `ready` and no more, so that output changes nothing.

use crate::advance::{Columns, Drive, Loads, Moved, advance};
use crate::bodies::{Bodies, BodyState};
use crate::energy::{Account, Energy};
use crate::error::{Halt, SetupError};
use crate::interaction::{Interaction, With};
use crate::kernel::{Common, FORCE, FORCE_AND_MOMENT, LEDGER};
use crate::lane::{Row4, Width};
use crate::law::{Elastic, compose};
use crate::limit::{contact_between, critical_step, radii_by_material};
use crate::particles::Particles;
use crate::setup::{Entry, Particle, Setup, Step};
use crate::walls::WallBody;
use crate::zones::Zones;
use geom::Vec3;
use rayon::prelude::*;

/// Blocks of contacts below which one thread is faster than several.
const FEW_TASKS: usize = 8;

/// A running simulation.
pub struct Simulation {
    pub(crate) setup: Setup,
    pub(crate) dt: f64,
    pub(crate) skin: f64,
    pub(crate) width: Width,
    pub(crate) particles: Particles,
    pub(crate) walls: Vec<WallBody>,
    pub(crate) interactions: Vec<Interaction>,
    pub(crate) starts: Vec<u32>,
    pub(crate) entries: Vec<u32>,
    pub(crate) loads: Vec<f64>,
    pub(crate) couples: Vec<f64>,
    pub(crate) ledger: Vec<f64>,
    pub(crate) steps: u64,
    /// Step at which neighbours were listed.
    pub(crate) listed: u64,
    /// Largest distance from home [m].
    pub(crate) away: f64,
    /// Whether lists must be made anew whatever has moved.
    pub(crate) stale: bool,
    /// Whether loads are those of this step.
    pub(crate) current: bool,
    /// Whether contact points of walls at rest are to be found.
    pub(crate) just_listed: bool,
    /// Particles whose acceleration of the step before is unknown.
    pub(crate) fresh: Vec<u32>,
    pub(crate) zones: Zones,
    pub(crate) bodies: Bodies,
    pub(crate) account: Account,
    /// How often neighbours were listed.
    pub(crate) listings: u64,
}

impl Simulation {
    /// Checks a setup and makes it ready to run.
    ///
    /// # Errors
    /// Everything that would make the run wrong or unstable: see [`SetupError`].
    pub fn new(setup: Setup) -> Result<Simulation, SetupError> {
        Simulation::with_width(setup, Width::best())
    }

    /// The like with lanes of a given width; all widths give the same bits.
    ///
    /// # Errors
    /// As for [`Simulation::new`].
    pub fn with_width(setup: Setup, width: Width) -> Result<Simulation, SetupError> {
        crate::check::check(&setup)?;
        let dt = time_step(&setup)?;
        let interactions = interactions(&setup)?;
        let rotates = interactions.iter().any(|i| i.kernel.rotates());
        let mut particles = Particles::new(rotates);
        for p in &setup.particles {
            particles.push(p, &setup.materials);
        }
        let bodies = Bodies::new(&setup, &mut particles);
        let fresh = (0..particles.len() as u32).collect();
        let skin = setup.skin.unwrap_or_else(|| default_skin(&setup));
        let walls: Vec<WallBody> = setup.walls.iter().map(WallBody::new).collect();
        slow_enough(&setup, &walls, dt)?;
        let zones = Zones::new(&setup, &particles);
        // They are in their columns now.
        let setup = Setup { particles: Vec::new(), clumps: setup.clumps.without_bodies(), ..setup };
        Ok(Simulation {
            setup,
            dt,
            skin,
            width,
            particles,
            walls,
            interactions,
            starts: Vec::new(),
            entries: Vec::new(),
            loads: Vec::new(),
            couples: Vec::new(),
            ledger: Vec::new(),
            steps: 0,
            listed: 0,
            away: 0.0,
            stale: true,
            current: false,
            just_listed: false,
            fresh,
            zones,
            bodies,
            account: Account::default(),
            listings: 0,
        })
    }

    /// Time step [s].
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Steps done.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Steps × Δt [s].
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.dt
    }

    /// How often neighbours were listed so far.
    pub fn listings(&self) -> u64 {
        self.listings
    }

    /// Gap up to which neighbours are listed [m].
    pub fn skin(&self) -> f64 {
        self.skin
    }

    /// Number of contacts listed now.
    pub fn listed_contacts(&self) -> usize {
        self.interactions.iter().map(|i| i.len).sum()
    }

    /// Number of particles in the calculation.
    pub fn particle_count(&self) -> usize {
        self.particles.len() - self.zones.hidden(self.time())
    }

    /// Wall spheres of a wall, as they are now: centre, radius [m], in the order they were given.
    pub fn wall_spheres(&self, wall: usize) -> Vec<(Vec3, f64)> {
        self.walls[wall].spheres(self.time())
    }

    /// Whether a wall moves.
    pub fn wall_moves(&self, wall: usize) -> bool {
        self.walls[wall].motion.moves()
    }

    /// Queues a particle that will enter; due when time() reaches `entry.time`.
    ///
    /// # Errors
    /// An entry that comes after it was due, out of order, or outside what the setup announced.
    pub fn enter(&mut self, entry: Entry) -> Result<(), SetupError> {
        let now = self.time();
        self.zones.enter(entry, now, &self.setup)
    }

    /// Entries due until time() + this [s] must have been given before the next step.
    pub fn look_ahead(&self) -> f64 {
        self.dt * crate::zones::LOOK_AHEAD as f64
    }

    /// Crossings of storage planes since the last call, in time order.
    pub fn take_crossings(&mut self) -> Vec<crate::setup::Crossing> {
        self.zones.take_crossings()
    }

    /// Particles in the calculation, by id, with velocities of this instant.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn particles(&mut self) -> Result<Vec<Particle>, Halt> {
        self.ready()?;
        let half = 0.5 * self.dt;
        let loads = self.all_loads();
        let (p, time) = (&self.particles, self.time());
        let members = self.bodies.member_states(p, &loads, &self.setup.gravity, self.dt);
        let mut out: Vec<Particle> = (0..p.len())
            .filter(|&k| !self.zones.is_hidden(k, time))
            .map(|k| {
                let row = &p.rows[k];
                let free = !self.zones.travels(k);
                let (force, moment) = loads.on(k, p.rotates());
                let (mut v, mut w) = (Vec3::new(row[4], row[5], row[6]), Vec3::zeros());
                for a in 0..3 {
                    if free {
                        v[a] += half * (force[a] * row[7] + self.setup.gravity[a] - p.acceleration[k][a]);
                    }
                    if p.rotates() {
                        w[a] = p.spins[k][a];
                        if free {
                            let inverse_inertia = 2.5 * row[7] / (row[3] * row[3]);
                            w[a] += half * (moment[a] * inverse_inertia - p.turning[k][a]);
                        }
                    }
                }
                if let Some(&Some(state)) = members.get(k) {
                    (v, w) = state;
                }
                let (id, material) = (p.id[k], p.material[k]);
                Particle {
                    id,
                    material,
                    radius: row[3],
                    position: self.wrapped(p.position(k)),
                    velocity: v,
                    spin: w,
                }
            })
            .collect();
        out.sort_by_key(|p| p.id);
        Ok(out)
    }

    /// Energy of this instant [J]; elastic and dissipated parts only when the setup asked for the ledger.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn energy(&mut self) -> Result<Energy, Halt> {
        let mut particles = self.particles()?;
        let bodies = self.bodies()?;
        bodies.iter().for_each(|b| particles.retain(|p| !b.has(p.id)));
        let mut energy = Energy::of(&particles, &self.setup, &self.ledger, &self.account);
        bodies.iter().for_each(|b| energy.add_body(b, &self.setup));
        Ok(energy)
    }

    /// Rigid clumps in the calculation, by id, with velocities of this instant.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn bodies(&mut self) -> Result<Vec<BodyState>, Halt> {
        self.ready()?;
        let mut states = self.bodies.states(&self.particles, &self.all_loads(), &self.setup, self.dt);
        states.iter_mut().for_each(|s| s.position = self.wrapped(s.position));
        Ok(states)
    }

    /// One time step.
    ///
    /// # Errors
    /// A guard: the state is then that of the last whole step, unless a particle has moved too far.
    pub fn step(&mut self) -> Result<(), Halt> {
        self.ready()?;
        if self.setup.ledger {
            self.account.add(&self.interactions, &self.ledger);
        }
        let gravity = [self.setup.gravity.x, self.setup.gravity.y, self.setup.gravity.z];
        let drive = Drive { dt: self.dt, gravity, motion_limit: self.setup.guards.motion };
        let count = self.particles.len();
        let Particles { rows, acceleration, spins, turning, home, .. } = &mut self.particles;
        let rotating = if spins.is_empty() { 0 } else { count };
        let columns = Columns {
            first: 0,
            rows: &mut rows[..count],
            acceleration,
            spins: &mut spins[..rotating],
            turning,
            home,
        };
        let loads = Loads {
            loads: &self.loads,
            couples: &self.couples,
            starts: &self.starts,
            entries: &self.entries,
        };
        let moved: Moved = advance(self.width, columns, loads, drive);
        let moved = self.move_bodies(moved);
        self.away = moved.away.sqrt();
        self.steps += 1;
        self.current = false;
        if !self.zones.none() {
            self.move_zones();
        }
        if moved.wild { crate::guards::motion(self) } else { Ok(()) }
    }

    /// Brings lists and loads to this instant.
    pub(crate) fn ready(&mut self) -> Result<(), Halt> {
        if self.current {
            return Ok(());
        }
        if !self.zones.none() {
            self.admit();
        }
        if self.stale || self.lists_expired() {
            self.relist();
        }
        let too_deep = self.load();
        self.current = true;
        self.prime();
        if too_deep { crate::guards::overlap(self) } else { Ok(()) }
    }

    /// Half a skin each for two particles, or a particle's way and a wall's.
    fn lists_expired(&self) -> bool {
        let since = (self.steps - self.listed) as f64 * self.dt;
        let wall = self.walls.iter().map(|w| w.fastest() * since).fold(0.0, f64::max);
        self.away + self.away.max(wall) > self.skin
    }

    /// Loads of all contacts; whether any overlap passes its limit.
    fn load(&mut self) -> bool {
        let time = self.time();
        for interaction in &mut self.interactions {
            interaction.renew(&self.particles, &self.walls, time, self.just_listed);
        }
        self.just_listed = false;
        let stride = stride(self.particles.rotates());
        let common = Common {
            dt: self.dt,
            overlap_limit: self.setup.guards.overlap,
            rows: &self.particles.rows,
            spins: &self.particles.spins,
            stride,
        };
        let (mut loads, mut couples, mut ledger) =
            (&mut self.loads[..], &mut self.couples[..], &mut self.ledger[..]);
        let mut tasks = Vec::new();
        for interaction in &mut self.interactions {
            let places = interaction.places();
            let (l, rest) = loads.split_at_mut(places * stride);
            let (c, couples_rest) = couples.split_at_mut((places * 4).min(couples.len()));
            let (e, ledger_rest) = ledger.split_at_mut((places * LEDGER).min(ledger.len()));
            (loads, couples, ledger) = (rest, couples_rest, ledger_rest);
            interaction.tasks(&common, &self.walls, l, c, e, &mut tasks);
        }
        let width = self.width;
        if tasks.len() < FEW_TASKS {
            return tasks
                .into_iter()
                .fold(false, |deep, (kernel, task)| kernel.run(width, common, task) | deep);
        }
        tasks
            .into_par_iter()
            .map(|(kernel, task)| kernel.run(width, common, task))
            .reduce(|| false, |a, b| a | b)
    }

    /// Particles without a past get the acceleration of this instant as that of the step before.
    fn prime(&mut self) {
        for k in std::mem::take(&mut self.fresh) {
            let k = k as usize;
            let rotates = self.particles.rotates();
            let loads = self.all_loads();
            let (force, m) = loads.on(k, rotates);
            let row = self.particles.rows[k];
            let mut a: Row4 = [0.0; 4];
            for (axis, value) in a.iter_mut().enumerate().take(3) {
                *value = force[axis] * row[7] + self.setup.gravity[axis];
            }
            self.particles.acceleration[k] = a;
            if rotates {
                let inverse_inertia = 2.5 * row[7] / (row[3] * row[3]);
                self.particles.turning[k] =
                    [m[0] * inverse_inertia, m[1] * inverse_inertia, m[2] * inverse_inertia, 0.0];
            }
        }
        self.bodies.prime(&self.particles, &self.setup.gravity);
    }

    /// After a move: rigid clumps take the loads of their members and put them in their places.
    fn move_bodies(&mut self, moved: Moved) -> Moved {
        if self.bodies.none() {
            return moved;
        }
        let (gravity, limit) = (self.setup.gravity, self.setup.guards.motion);
        let own = self.bodies.advance(&mut self.particles, self.dt, &gravity, limit);
        Moved { away: moved.away.max(own.away), wild: moved.wild | own.wild }
    }

    pub(crate) fn all_loads(&self) -> Loads<'_> {
        Loads { loads: &self.loads, couples: &self.couples, starts: &self.starts, entries: &self.entries }
    }

    pub(crate) fn wrapped(&self, p: Vec3) -> Vec3 {
        wrapped(&self.setup.periodic, p)
    }
}

/// A place, brought back into the periodic box.
pub(crate) fn wrapped(periodic: &[Option<(f64, f64)>; 3], mut p: Vec3) -> Vec3 {
    for a in 0..3 {
        if let Some((lo, hi)) = periodic[a] {
            p[a] -= (hi - lo) * ((p[a] - lo) / (hi - lo)).floor();
        }
    }
    p
}

/// Numbers of one load.
pub(crate) fn stride(rotates: bool) -> usize {
    if rotates { FORCE_AND_MOMENT } else { FORCE }
}

fn time_step(setup: &Setup) -> Result<f64, SetupError> {
    let limit = critical_step(setup)?;
    match setup.step {
        Step::Auto(_) if limit.dt.is_infinite() => Err(SetupError::NoStep),
        Step::Auto(share) => Ok(share * limit.dt),
        Step::Fixed(dt) if dt > limit.dt => {
            Err(SetupError::StepTooLarge { dt, critical: limit.dt, pair: limit.pair })
        }
        Step::Fixed(dt) => Ok(dt),
    }
}

/// A wall must not pass a particle within a few steps.
fn slow_enough(setup: &Setup, walls: &[WallBody], dt: f64) -> Result<(), SetupError> {
    let smallest = radii_by_material(setup).iter().flatten().map(|r| r.0).fold(f64::INFINITY, f64::min);
    for (body, wall) in walls.iter().zip(&setup.walls) {
        let (speed, limit) = (body.fastest(), setup.guards.motion);
        let share = speed * dt / smallest;
        if share > limit {
            return Err(SetupError::WallTooFast { wall: wall.name.clone(), speed, dt, share, limit });
        }
    }
    Ok(())
}

/// 0.3 × the mean radius: the skin of the bench pile, scaled to the grains.
fn default_skin(setup: &Setup) -> f64 {
    let members = setup.clumps.member_radii();
    let radii = || setup.particles.iter().map(|p| p.radius).chain(members.iter().copied());
    let count = radii().count() as f64;
    let mean = radii().sum::<f64>() / count;
    0.3 * if count > 0.0 { mean } else { 0.5 * (setup.smallest_entry + setup.largest_entry).max(1e-30) }
}

/// One interaction for each pair of materials that particles have, and for each wall and material.
fn interactions(setup: &Setup) -> Result<Vec<Interaction>, SetupError> {
    let present: Vec<u16> =
        (0u16..).zip(radii_by_material(setup)).filter(|(_, r)| r.is_some()).map(|(m, _)| m).collect();
    let periodic = setup.periodic.iter().any(|p| p.is_some());
    let mut list = Vec::new();
    let kernel = |a: u16, b: u16| -> Result<_, SetupError> {
        let elastic = Elastic::of(&setup.materials[a as usize], &setup.materials[b as usize]);
        Ok(compose(contact_between(setup, a, b)?, elastic))
    };
    for &a in &present {
        for &b in present.iter().filter(|&&b| a <= b) {
            list.push(Interaction::new(kernel(a, b)?, (a, b), With::Particles));
            if periodic {
                list.push(Interaction::new(kernel(a, b)?, (a, b), With::Images));
            }
        }
        for (w, wall) in setup.walls.iter().enumerate() {
            list.push(Interaction::new(kernel(a, wall.material)?, (a, wall.material), With::Wall(w)));
        }
    }
    Ok(list)
}
