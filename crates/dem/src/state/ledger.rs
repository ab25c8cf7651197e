//! What has come and gone since the start, and what the finite time step made of it.
//!
//! ```text
//! velocity Verlet, v± = vₙ ± aₙ Δt/2:   ½ m v₋·v₊ |ₙ₊₁ = ½ m v₋·v₊ |ₙ + ½ (Fₙ + Fₙ₊₁)·(xₙ₊₁ − xₙ)   to rounding
//! xₙ₊₁ − xₙ = v₊ Δt:   work on a particle until now = Σ Fₖ·vₖ Δt + ½ Fₙ·v₋ Δt,   ½ m v₋·v₊ = ½ m vₙ² − ⅛ m aₙ² Δt²
//! integration = work on particles + change of elastic + dissipated − work of walls + change of Σ ⅛ m a² Δt²
//! ```
//!
//! Sums run in the order of particles and contacts: they are the same for any number of threads.

use crate::effects::DISSIPATORS;
use crate::kernel::LEDGER;
use crate::kernel::LOST;
use crate::neighbours::contacts::Contacts;
use crate::neighbours::contacts::Kind;
use crate::neighbours::contacts::With;
use crate::observe::energy::Energy;
use crate::observe::energy::carried;
use crate::observe::energy::heavy;
use crate::setup::Particle;
use crate::simd::Row4;
use crate::simulation::Simulation;
use crate::state::bonds::Bonds;
use crate::state::zones::Zones;
use geom::Vec3;
use serde::Deserialize;
use serde::Serialize;

/// Sums since the start [J].
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Account {
    /// By the normal law, sliding, rolling, twisting.
    pub dissipated: [f64; DISSIPATORS],
    /// Lost at once, when contacts are made or break.
    pub lost: f64,
    /// Work of walls.
    pub walls: f64,
    /// By dashpots of bonds.
    pub(crate) bonds: f64,
    /// With bonds that broke.
    pub(crate) broken: f64,
    /// Of those that fell asleep.
    pub slept: f64,
    /// Taken by the fluid.
    pub drag: f64,
    /// Brought along.
    pub entered: f64,
    /// Taken along.
    pub left: f64,
    /// Work of contacts and fluid on free particles.
    pub(crate) work: f64,
    /// Work of contacts on those that travel by a prescribed motion, and what contacts held that left with them.
    pub passed: f64,
    /// What the sums that make up the integration error were at the start.
    pub(crate) start: f64,
    /// Whether it was opened: also in a run that is resumed with a ledger and had none before.
    pub(crate) opened: bool,
    /// Potential that particles lost when they came back through a periodic face.
    pub(crate) wrapped: f64,
    /// Most that the guard has seen in motion and springs together.
    pub peak: f64,
}

/// A particle or a rigid clump at one instant: what moves it.
#[derive(Clone, Copy)]
pub struct Driven {
    /// 1/m [1/kg].
    pub inverse_mass: f64,
    /// 1/I [1/(kg·m²)]; of a clump 0, whose turn has no such energy.
    pub inverse_inertia: f64,
    /// Force but for its weight, and all of it [N].
    pub forces: [Vec3; 2],
    /// Moment [N·m].
    pub moment: Vec3,
    /// Velocity [m/s] and angular velocity [rad/s].
    pub velocity: Vec3,
    pub spin: Vec3,
}

impl Driven {
    /// Power of contacts and fluid [W].
    fn power(&self) -> f64 {
        self.forces[0].dot(&self.velocity) + self.moment.dot(&self.spin)
    }

    /// m a² − 2 F·a, and the like of its turn [J/s²]: an eighth of it times Δt² takes ½ F·v to ½ F·v₋, and ½ m v² to ½ m v₋·v₊.
    fn step_share(&self) -> f64 {
        let [contacts, all] = self.forces;
        (all - 2.0 * contacts).dot(&all) * self.inverse_mass
            - self.moment.norm_squared() * self.inverse_inertia
    }
}

impl Account {
    /// Adds one step's ledger, in its order. What a contact that acts on nobody took or brought is part of the work on those that travel, and goes where that goes.
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

    /// Adds what bonds take in a step of `dt` [s].
    pub fn add_bonds(&mut self, bonds: &Bonds, dt: f64) {
        let [power, lost] = bonds.dissipated();
        self.bonds += power * dt;
        self.broken += lost;
    }

    /// What has gone for good by bonds.
    pub fn by_bonds(&self) -> f64 {
        self.bonds + self.broken
    }

    /// What has gone, less what walls brought.
    fn gone(&self) -> f64 {
        self.dissipated.iter().sum::<f64>() + self.bonds + self.drag - self.walls
    }
}

impl Simulation {
    /// After a move: what contacts and fluid did to each particle in it.
    pub(crate) fn account_moves(&mut self) {
        let mut work = 0.0;
        for k in (0..self.particles.len()).filter(|&k| self.is_driven(k)) {
            if self.sleepers.as_ref().is_some_and(|s| s.fell(k)) {
                continue;
            }
            let p = &self.particles;
            let (row, a) = (&p.rows[k], p.acceleration[k]);
            let (spin, turning) = match (p.spins.get(k), p.turning.get(k)) {
                (Some(w), Some(t)) => (*w, *t),
                _ => (Row4::default(), Row4::default()),
            };
            // The moved velocity is predicted from the one of the step and its acceleration.
            let back =
                |predicted: [f64; 3], rate: [f64; 3]| Vec3::from(predicted) - Vec3::from(rate) * self.dt;
            let velocity = back([row[4], row[5], row[6]], three(a));
            let spin = back(three(spin), three(turning));
            work += Driven { velocity, spin, ..self.driven(k, three(a), three(turning)) }.power();
        }
        work += self.bodies.last_driven(&self.setup, self.dt).map(|d| d.power()).sum::<f64>();
        self.account.work += work * self.dt;
    }

    /// Particles `fresh` begin their first step: its first half was before them. Loads are those of this instant.
    pub(crate) fn open_account(&mut self, fresh: &[u32]) {
        if !self.account.opened {
            let mut energy = Energy::default();
            self.close_step(&mut energy);
            (self.account.start, self.account.opened) = (energy.integration, true);
            return;
        }
        if fresh.is_empty() {
            return;
        }
        let loads = self.all_loads();
        let free = fresh.iter().map(|&k| k as usize).filter(|&k| self.is_driven(k));
        let bodies = self.bodies.driven_now(self, &loads).filter(|(first, _)| fresh.contains(first));
        let driven = free.map(|k| self.driven_now(k, &loads)).chain(bodies.map(|(_, d)| d));
        let halves = driven.map(|d| self.half(d.power(), d.step_share()));
        let (work, share) = halves.fold((0.0, 0.0), |(w, s), h| (w + h.0, s + h.1));
        // Until now they were moved, and took this half from their drive.
        self.account.entered -= work;
        self.account.passed += work;
        self.account.work -= work + share;
    }

    /// Half the work of a power [W] in a step, and what a step's share [J/s²] makes [J].
    fn half(&self, power: f64, share: f64) -> (f64, f64) {
        (0.5 * power * self.dt, 0.125 * share * self.dt * self.dt)
    }

    /// A free particle is taken over in the middle of its last step, with an energy `taken` [J]: what the finite step made of it.
    pub(crate) fn close_account(&mut self, k: usize, taken: f64) {
        let (p, dt) = (&self.particles, self.dt);
        let half = |v: Row4, a: Row4| Vec3::from(three(v)) - Vec3::from(three(a)) * (0.5 * dt);
        let (row, a) = (&p.rows[k], p.acceleration[k]);
        let velocity = half(Row4([row[4], row[5], row[6], 0.0]), a);
        let middle = (p.position(k) + self.position_before(k)) * 0.5;
        let spin = match (p.spins.get(k), p.turning.get(k)) {
            (Some(w), Some(t)) => half(*w, *t),
            _ => Vec3::zeros(),
        };
        let (id, material, radius) = (p.id[k], p.material[k], row[3]);
        let there = Particle { id, material, radius, position: middle, velocity, spin };
        self.account.passed += taken - carried(&there, &self.setup).iter().sum::<f64>();
    }

    /// Brings the ledger to this instant, whose loads are known: what is lost at once is gone, of all else half is done.
    pub(crate) fn close_step(&self, energy: &mut Energy) {
        let mut now = Account::default();
        now.add(&self.kinds, &self.contacts, &self.zones);
        now.add_bonds(&self.bonds, self.dt);
        let loads = self.all_loads();
        let free = (0..self.particles.len()).filter(|&k| self.is_driven(k));
        let bodies = self.bodies.driven_now(self, &loads).map(|(_, d)| d);
        let driven = free.clone().map(|k| self.driven_now(k, &loads)).chain(bodies);
        let (power, share) = driven.fold((0.0, 0.0), |(p, s), d| (p + d.power(), s + d.step_share()));
        let drag = free.map(|k| self.drag_power(k)).sum::<f64>() + self.bodies.drag_power(&self.setup);
        now.drag = drag * self.dt;
        let (work, share) = self.half(power, share);
        energy.normal += now.lost;
        energy.bonds += now.broken;
        energy.half_step = 0.5 * now.gone();
        let (account, lost) = (&self.account, |a: &Account| a.lost + a.broken);
        let done = account.work + work + share + account.passed + lost(account) + lost(&now);
        energy.integration =
            done + account.gone() + energy.half_step + self.contacts.elastic() + self.bonds.elastic()
                - account.start;
        if self.setup.periodic.iter().any(Option::is_some) {
            energy.potential = self.unwrapped_potential() + account.wrapped;
        }
    }

    /// −m g·x of the particles where they are between two listings, which may be beyond a periodic face [J].
    fn unwrapped_potential(&self) -> f64 {
        let gravity = self.setup.gravity;
        let inside =
            |&k: &usize| !self.zones.travels(k) && !self.zones.is_gone(k) && !self.bodies.is_member(k);
        let of = |k: usize| {
            let density = self.setup.materials[self.particles.material[k] as usize].density;
            -heavy(&self.setup, density) / self.particles.rows[k][7]
                * gravity.dot(&self.particles.position(k))
        };
        (0..self.particles.len()).filter(inside).map(of).sum::<f64>() + self.bodies.potential(&self.setup)
    }

    /// Brings particles back into the periodic box; what that does to their potential is booked.
    pub(crate) fn wrap_accounted(&mut self, wrap: impl FnOnce(&mut Simulation)) {
        let before = if self.setup.ledger { self.unwrapped_potential() } else { 0.0 };
        wrap(self);
        if self.setup.ledger {
            self.account.wrapped += before - self.unwrapped_potential();
        }
    }

    /// Whether forces drive a particle: it is free, awake, and no member of a rigid clump.
    fn is_driven(&self, k: usize) -> bool {
        !self.zones.travels(k)
            && !self.zones.is_gone(k)
            && !self.bodies.is_member(k)
            && !self.sleepers.as_ref().is_some_and(|s| s.sleeps(k))
    }

    /// What an acceleration [m/s²] and an angular acceleration [rad/s²] are made by; it stands still.
    pub(crate) fn driven(&self, k: usize, a: [f64; 3], turning: [f64; 3]) -> Driven {
        let row = &self.particles.rows[k];
        let density = self.setup.materials[self.particles.material[k] as usize].density;
        let weight = self.setup.gravity * heavy(&self.setup, density);
        let (mass, inverse_inertia) = (1.0 / row[7], 2.5 * row[7] / (row[3] * row[3]));
        let (a, moment) = (Vec3::from(a), Vec3::from(turning) / inverse_inertia);
        let (velocity, spin) = (Vec3::zeros(), Vec3::zeros());
        let forces = [(a - weight) * mass, a * mass];
        Driven { inverse_mass: row[7], inverse_inertia, forces, moment, velocity, spin }
    }
}

fn three(row: Row4) -> [f64; 3] {
    [row[0], row[1], row[2]]
}
