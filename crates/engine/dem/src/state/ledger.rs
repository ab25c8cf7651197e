//! What has come and gone since the start, and what the finite time step made of it.
//!
//! ```text
//! velocity Verlet, v± = vₙ ± aₙ Δt/2:   ½ m v₋·v₊ |ₙ₊₁ = ½ m v₋·v₊ |ₙ + ½ (Fₙ + Fₙ₊₁)·(xₙ₊₁ − xₙ)   to rounding
//! xₙ₊₁ − xₙ = v₊ Δt:   work on a particle until now = Σ Fₖ·vₖ Δt + ½ Fₙ·v₋ Δt,   ½ m v₋·v₊ = ½ m vₙ² − ⅛ m aₙ² Δt²
//! integration = work on particles + change of elastic + dissipated − work of walls + change of Σ ⅛ m a² Δt²
//! ```
//!
//! Sums run in the order of particles and contacts: they are the same for any number of threads.

use crate::model::Model;
use crate::setup::{Particle, Setup};
use crate::space::mass;
use crate::state::{Bonds, State};
use geom::Vec3;
use laws::effects::DISSIPATORS;
use serde::{Deserialize, Serialize};

/// Sums since the start [J].
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct LedgerSums {
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
    /// Taken by local damping.
    pub damped: f64,
    /// Taken by dashpots of walls on springs.
    pub mounts: f64,
    /// Brought along.
    pub entered: f64,
    /// Taken along.
    pub left: f64,
    /// Work of contacts and fluid on free particles.
    pub(crate) work: f64,
    /// Work of contacts on zone particles, and the energy of contacts that left with them.
    pub passed: f64,
    /// What the sums that make up the integration error were at the start.
    pub(crate) start: f64,
    /// Whether it was opened: also in a run that is resumed with a ledger and had none before.
    pub(crate) opened: bool,
    /// Potential that particles lost when they came back through a periodic face.
    pub(crate) wrapped: f64,
    /// Largest energy of motion and springs together that the guard has found.
    pub peak: f64,
}

/// A particle or a rigid clump at one instant: what moves it.
#[derive(Clone, Copy)]
pub struct DrivenBody {
    /// 1/m [1/kg].
    pub inverse_mass: f64,
    /// Force but for its weight, and all of it [N].
    pub forces: [Vec3; 2],
    /// Moment [N·m], and what I⁻¹ makes of it [rad/s²].
    pub moment: Vec3,
    pub turning: Vec3,
    /// Velocity [m/s] and angular velocity [rad/s].
    pub velocity: Vec3,
    pub spin: Vec3,
}

impl DrivenBody {
    /// Power of contacts and fluid [W].
    pub(crate) fn power(&self) -> f64 {
        self.forces[0].dot(&self.velocity) + self.moment.dot(&self.spin)
    }

    /// F·M⁻¹F, and the same of its rotation [J/s²].
    pub(crate) fn force_squared(&self) -> f64 {
        self.forces[1].norm_squared() * self.inverse_mass + self.moment.dot(&self.turning)
    }

    /// m a² − 2 F·a, and the same of its rotation [J/s²]: an eighth of it times Δt² takes ½ F·v to ½ F·v₋, and ½ m v² to ½ m v₋·v₊.
    pub(crate) fn step_share(&self) -> f64 {
        let [contacts, all] = self.forces;
        (all - 2.0 * contacts).dot(&all) * self.inverse_mass - self.moment.dot(&self.turning)
    }
}

impl LedgerSums {
    /// Adds what bonds take in a step of `dt` [s]; what the contacts hold that take their place, `freed` [J], is not lost.
    pub fn add_bonds(&mut self, bonds: &Bonds, dt: f64, freed: f64) {
        let [power, lost] = bonds.dissipated();
        self.bonds += power * dt;
        self.broken += lost - freed;
    }

    /// Books a work [J] on particles, from outside and without contacts.
    pub fn move_by_walls(&mut self, work: f64) {
        if self.opened {
            self.walls += work;
            self.work += work;
        }
    }

    /// What has gone, less what walls brought.
    pub(crate) fn gone(&self) -> f64 {
        self.dissipated.iter().sum::<f64>() + self.bonds + self.drag + self.damped + self.mounts - self.walls
    }
}

/// −m g·x of the particles where they are between two listings, which may be beyond a periodic face [J].
pub fn unwrapped_potential(model: &Model, state: &State) -> f64 {
    let gravity = model.setup.gravity;
    let inside = |&k: &usize| state.zones.is_free(k) && !state.clumps.is_member(k);
    let of = |k: usize| {
        let density = model.setup.materials[state.particles.material[k] as usize].density;
        -heavy(&model.setup, density) / state.particles.rows[k].inverse_mass()
            * gravity.dot(&state.particles.position(k))
    };
    (0..state.particles.len()).filter(inside).map(of).sum::<f64>() + state.clumps.potential(&model.setup)
}

/// Brings particles back into the periodic box; what that does to their potential is booked.
pub fn wrap_in_ledger(model: &Model, state: &mut State, wrap: impl FnOnce(&mut State)) {
    let before = if model.setup.ledger { unwrapped_potential(model, state) } else { 0.0 };
    wrap(state);
    if model.setup.ledger {
        state.ledger.wrapped += before - unwrapped_potential(model, state);
    }
}

/// Translation, rotation, potential of a particle [J]; what a fluid displaced lifts is no longer heavy.
pub fn carried(p: &Particle, setup: &Setup) -> [f64; 3] {
    let density = setup.materials[p.material as usize].density;
    let m = mass(p.radius, density);
    let heavy = heavy(setup, density);
    [
        0.5 * m * p.velocity.norm_squared(),
        0.2 * m * p.radius * p.radius * p.spin.norm_squared(),
        -m * heavy * setup.gravity.dot(&p.position),
    ]
}

/// Weight that the fluid leaves of a particle's own [–].
pub fn heavy(setup: &Setup, density: f64) -> f64 {
    1.0 - setup.drag.map_or(0.0, |d| d.lift(density))
}
