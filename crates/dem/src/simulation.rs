//! The time loop.
//!
//! One step: `ready` (lists still hold? contact points of walls, loads of all contacts at time n), then `advance`
//! (gather, move to n + 1), then zones. Looking at a simulation calls `ready` and no more, so that output changes nothing.

use crate::effects::needed;
use crate::forces::sweep::Pass;
use crate::kernel::sums::Loads;
use crate::model::error::Halt;
use crate::model::error::SetupError;
use crate::model::limit::largest_reach;
use crate::model::start::kinds;
use crate::model::start::mean_radius;
use crate::model::start::slow_enough;
use crate::model::start::time_step;
use crate::neighbours::contacts::Contacts;
use crate::neighbours::contacts::Kind;
use crate::passes::integrate::Moved;
use crate::passes::servo::Piston;
use crate::passes::sleep::Sleepers;
use crate::setup::Particle;
use crate::setup::Precision;
use crate::setup::Setup;
use crate::simd::Row;
use crate::simd::Row4;
use crate::simd::Width;
use crate::simd::number::Form;
use crate::state::bonds::Bonds;
use crate::state::clumps::Bodies;
use crate::state::ledger::Account;
use crate::state::particles::Particles;
use crate::state::zones::Zones;
use crate::walls::WallBody;
use crate::walls::images::Periods;
use geom::Vec3;

/// Steps that rooms are made for; chosen on the bench pile.
const HORIZON: f64 = 100.0;

/// A running simulation.
pub struct Simulation {
    pub(crate) setup: Setup,
    pub(crate) dt: f64,
    pub(crate) skin: f64,
    /// Largest gap at which a contact that was made still acts [m]; the skin is no less.
    pub(crate) reach: f64,
    pub(crate) width: Width,
    pub(crate) particles: Particles,
    pub(crate) walls: Vec<WallBody>,
    /// Servos, by wall; empty where no wall follows a force.
    pub(crate) pistons: Vec<Piston>,
    /// What their gain is made of, by wall [N·s/m].
    pub(crate) answers: Vec<f64>,
    /// Whole periods that walls had travelled when neighbours were listed; empty where nothing is periodic.
    pub(crate) counted_back: Vec<Periods>,
    pub(crate) kinds: Vec<Kind>,
    pub(crate) contacts: Contacts,
    /// Particles as they were before the move; only where a fluid drags them.
    pub(crate) before: Vec<Row>,
    /// Steps that the rooms of particles are made for; 0 where the setup gives the skin.
    pub(crate) horizon: f64,
    /// Mean radius [m].
    pub(crate) grain: f64,
    pub(crate) steps: u64,
    /// Step at which neighbours were listed.
    pub(crate) listed: u64,
    /// Whether a particle has left its room.
    pub(crate) out: bool,
    /// Whether lists must be made anew whatever has moved.
    pub(crate) stale: bool,
    /// Whether loads are those of this step.
    pub(crate) current: bool,
    /// Particles whose acceleration of the step before is unknown.
    pub(crate) fresh: Vec<u32>,
    pub(crate) zones: Zones,
    pub(crate) bodies: Bodies,
    pub(crate) bonds: Bonds,
    /// Who sleeps, where the setup asks for it.
    pub(crate) sleepers: Option<Sleepers>,
    pub(crate) account: Account,
    /// How often neighbours were listed.
    pub(crate) listings: u64,
    /// Whether the load of each contact is kept when somebody looks.
    pub(crate) records: bool,
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
    /// As for [`Simulation::new`], and a width that this machine does not have.
    pub fn with_width(setup: Setup, width: Width) -> Result<Simulation, SetupError> {
        Simulation::build(setup, width, None)
    }

    /// The like with the step [s] of a run that goes on, which was checked when that began; or with the one that the setup asks for.
    pub(crate) fn build(setup: Setup, width: Width, begun: Option<f64>) -> Result<Simulation, SetupError> {
        // What computes with wide lanes relies on it.
        if !Width::available().contains(&width) {
            return Err(SetupError::NoWidth(width));
        }
        crate::model::check::check(&setup)?;
        let contacts = setup.contacts.iter().map(|c| needed(c).0).collect();
        let setup = Setup { contacts, ..setup };
        let dt = begun.map_or_else(|| time_step(&setup), Ok)?;
        let kinds = kinds(&setup)?;
        let mut particles =
            Particles::new(kinds.iter().any(|k| k.kernel.rotates()) || !setup.bonds.is_empty());
        let mut sorted: Vec<&Particle> = setup.particles.iter().collect();
        sorted.sort_unstable_by_key(|p| p.id);
        sorted.into_iter().for_each(|p| particles.push(p, &setup.materials));
        let bodies = Bodies::new(&setup, &mut particles);
        let bonds = Bonds::new(&setup, &particles)?;
        let fresh = (0..particles.len() as u32).collect();
        let grain = mean_radius(&setup);
        let reach = largest_reach(&setup);
        let skin = setup.skin.unwrap_or(crate::space::search::SKIN.start * grain).max(reach);
        let horizon = if setup.skin.is_some() { 0.0 } else { HORIZON };
        let walls: Vec<WallBody> = setup.walls.iter().map(|w| WallBody::new(w, reach)).collect();
        slow_enough(&setup, &walls, dt)?;
        let zones = Zones::new(&setup, &particles);
        let sleepers = setup.sleep.map(|s| Sleepers::new(s, dt, setup.gravity.norm(), particles.len()));
        let (pistons, answers) =
            (crate::passes::servo::pistons(&setup), crate::passes::servo::answers(&setup, dt));
        // They are in their columns now.
        let setup = Setup { particles: Vec::new(), clumps: setup.clumps.without_bodies(), ..setup };
        Ok(Simulation {
            setup,
            dt,
            skin,
            reach,
            width,
            particles,
            walls,
            pistons,
            answers,
            counted_back: Vec::new(),
            kinds,
            contacts: Contacts::default(),
            before: Vec::new(),
            horizon,
            grain,
            steps: 0,
            listed: 0,
            out: false,
            stale: true,
            current: false,
            fresh,
            sleepers,
            zones,
            bodies,
            bonds,
            account: Account::default(),
            listings: 0,
            records: true,
        })
    }

    /// Whether looking keeps the load of each contact, as it does unless it is told not to: 64 bytes a contact that only
    /// [`Simulation::record_contacts`] and [`Simulation::wall_forces`] want.
    pub fn record_loads(&mut self, records: bool) {
        self.records = records;
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
        self.contacts.len()
    }

    /// Number of particles that sleep.
    pub fn asleep(&self) -> usize {
        self.sleepers.as_ref().map_or(0, Sleepers::count)
    }

    /// Number of particles in the calculation.
    pub fn particle_count(&self) -> usize {
        let hidden = self.zones.hidden(self.time());
        (0..self.particles.len()).filter(|&k| !hidden(k)).count()
    }

    /// Wall spheres of a wall, as they are now: centre, radius [m], in the order they were given.
    pub fn wall_spheres(&self, wall: usize) -> Vec<(Vec3, f64)> {
        self.walls[wall].spheres(&self.pose(wall, self.time()))
    }

    /// Whether a wall moves.
    pub fn wall_moves(&self, wall: usize) -> bool {
        self.walls[wall].motion.moves()
    }

    /// Crossings of storage planes since the last call, in time order.
    pub fn take_crossings(&mut self) -> Vec<crate::setup::Crossing> {
        self.zones.take_crossings()
    }

    /// One time step.
    ///
    /// # Errors
    /// A guard. The state is that of the last whole step; where only this step's loads showed an overlap, of the step itself.
    pub fn step(&mut self) -> Result<(), Halt> {
        let pass = if self.current {
            Pass::Move
        } else {
            self.prepare();
            if self.fresh.is_empty() {
                Pass::Step
            } else {
                self.ready()?;
                Pass::Move
            }
        };
        let found = self.pass(pass);
        if self.setup.ledger {
            self.account.add(&self.kinds, &self.contacts, &self.zones);
            self.account.add_bonds(&self.bonds, self.dt);
            self.contacts.add_work();
            self.account_zones();
        }
        if let Some(sleepers) = &mut self.sleepers {
            self.account.slept += sleepers.turn(self.contacts.tile());
        }
        let moved = self.move_bodies(found.moved);
        let driven = self.drive_pistons();
        self.out = moved.out | self.apply_drag();
        if self.setup.ledger {
            self.account_moves();
        }
        self.steps += 1;
        self.current = false;
        self.bonds.turn(&self.particles, self.dt);
        if !self.zones.none() {
            self.move_zones();
        }
        crate::observe::guards::overlap(self, &found.deep, true)?;
        if moved.wild {
            crate::observe::guards::motion(self)?;
        }
        driven?;
        let looks = self.setup.guards.energy.is_finite()
            && self.steps.is_multiple_of(crate::observe::guards::ENERGY_EVERY);
        if looks { crate::observe::guards::energy(self) } else { Ok(()) }
    }

    /// Brings lists and loads to this instant, as looking at anything does.
    ///
    /// # Errors
    /// When the state is beyond a guard.
    pub fn ready(&mut self) -> Result<(), Halt> {
        if self.current {
            return Ok(());
        }
        self.prepare();
        let found = self.pass(Pass::Loads);
        self.current = true;
        let fresh = self.prime();
        if self.setup.ledger {
            self.open_account(&fresh);
        }
        crate::observe::guards::overlap(self, &found.deep, false)
    }

    /// Brings lists to this instant.
    fn prepare(&mut self) {
        if !self.zones.none() {
            self.admit();
            self.admit_bonds();
        }
        if self.stale || self.lists_expired() {
            self.relist();
        }
    }

    /// Whether a particle or a wall may have left the room that neighbours were listed for.
    fn lists_expired(&self) -> bool {
        let since = (self.steps - self.listed) as f64 * self.dt;
        // Written so that NaN is caught.
        self.out || !(0..self.walls.len()).all(|w| self.wall_way(w, since) <= self.wall_room(w))
    }

    /// Particles without a past get the acceleration of this instant as that of the step before; which they are.
    fn prime(&mut self) -> Vec<u32> {
        let fresh = std::mem::take(&mut self.fresh);
        for k in fresh.iter().map(|&k| k as usize) {
            let rotates = self.particles.rotates();
            let loads = self.all_loads();
            let (force, m) = loads.on(k, self.particles.rows[k][3]);
            let row = self.particles.rows[k];
            let (mut a, body) = (Row4::default(), self.body_acceleration(k));
            for (axis, value) in a.iter_mut().enumerate().take(3) {
                *value = force[axis] * row[7] + body[axis];
            }
            self.particles.acceleration[k] = a;
            if rotates {
                let inverse_inertia = 2.5 * row[7] / (row[3] * row[3]);
                self.particles.turning[k].0 =
                    [m[0] * inverse_inertia, m[1] * inverse_inertia, m[2] * inverse_inertia, 0.0];
            }
        }
        self.bodies.prime(&self.particles, &self.setup);
        fresh
    }

    /// After a move: rigid clumps take the loads of their members and put them in their places.
    fn move_bodies(&mut self, moved: Moved) -> Moved {
        if self.bodies.none() {
            return moved;
        }
        if self.setup.ledger {
            self.account.drag += self.bodies.drag_power(&self.setup) * self.dt;
        }
        moved.and(self.bodies.advance(&mut self.particles, &self.setup, self.dt))
    }

    pub(crate) fn all_loads(&self) -> Loads<'_> {
        self.contacts.sums()
    }

    /// Whether the load of each contact is wanted in each step: by servos, planes of zones, and sleepers.
    pub(crate) fn keeps_each(&self) -> bool {
        !self.pistons.is_empty() || !self.zones.none() || self.sleepers.is_some()
    }

    /// How what is computed of contacts is kept.
    pub(crate) fn form(&self) -> Form {
        Form { rotates: self.particles.rotates(), single: self.setup.precision == Precision::Single }
    }

    /// Whether anything makes couples.
    pub(crate) fn couples(&self) -> bool {
        !self.bonds.none() || self.kinds.iter().any(|k| k.kernel.couples())
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
