//! What is fixed while a simulation runs: resolved once from a setup, read by everything, changed by nothing.
//!
//! `check` refuses numbers without meaning (by `in_range`), `limit` bounds the time step (with `dense_walls` and `bonds`), `start` makes
//! the kinds of contact, each with its composition of effects. Uses setup, walls and laws.

pub mod bonds;
pub mod check;
pub mod clumps;
pub mod compose;
pub mod contact_check;
pub mod dense_walls;
pub mod entrance;
pub mod error;
pub mod halt;
pub mod in_range;
pub mod kind;
pub mod limit;
pub mod matched;
pub mod mount;
pub mod quantity;
pub mod servo;
pub mod start;
pub mod step_cause;

pub use bonds::law::Pull;
pub use bonds::springs::Springs;
pub use bonds::{BondedPair, BreakMode, GONE, NewBond};
pub use dense_walls::DenseWalls;
pub use entrance::Entrance;
pub use error::{SetupError, StateMismatch};
pub use halt::{Halt, Partner, Stiffer};
pub use in_range::Check;
pub use kind::{Kind, With};
pub use quantity::{Allowed, OutOfRange, Quantity, Subject};
pub use step_cause::{
    BondedParticle, CriticalBonds, CriticalDrag, CriticalGrain, CriticalPair, CriticalPartner, Limit,
    RepeatedMotion, StepCause,
};

use crate::model::limit::{critical_of_contacts, largest_reach};
use crate::model::servo::{Response, responses};
use crate::model::start::{faster_than_sleep, kinds, mean_radius, slow_enough, time_step};
use crate::setup::Setup;
use crate::space::search::FIRST_SKIN;
use crate::walls::{self, WallBody};
use laws::contact::MoveInputs;
use laws::effects::needed;
use laws::simd::{Layout, Precision, Width};
use laws::space::cell::Cell;

/// Steps that margins are made for; chosen on the bench pile.
const HORIZON: f64 = 100.0;

/// What is fixed while a simulation runs.
pub struct Model {
    /// The setup, without the particles and clumps that it begins with.
    pub setup: Setup,
    /// Time step [s].
    pub dt: f64,
    /// Largest gap at which a contact that was made still acts [m]; the skin is no less.
    pub reach: f64,
    /// Skin at the start [m].
    pub skin: f64,
    /// Lanes that contacts are computed with.
    pub width: Width,
    /// Walls as at t = 0.
    pub walls: Vec<WallBody>,
    /// How stiffly contacts answer servos, by kind of contact.
    pub responses: Vec<Response>,
    /// Kinds of contact.
    pub kinds: Vec<Kind>,
    /// Steps that the margins of particles are made for; 0 where the setup gives the skin.
    pub horizon: f64,
    /// Mean radius [m].
    pub mean_radius: f64,
    /// Whether particles turn.
    pub rotates: bool,
    /// The critical step of contacts alone [s], where bonds are made later.
    pub contact_step: f64,
}

impl Model {
    /// Checks a setup and resolves it, with the time step `begun` [s] of a run that is resumed, or with the one that the setup asks for.
    ///
    /// # Errors
    /// Everything that would make the run wrong or unstable.
    pub fn new(setup: Setup, width: Width, begun: Option<f64>) -> Result<Model, SetupError> {
        // Wide lanes are unsafe without it.
        if !Width::available().contains(&width) {
            return Err(SetupError::NoWidth(width));
        }
        check::check(&setup)?;
        let contacts = setup.contacts.iter().map(|c| needed(c).0).collect();
        let setup = Setup { contacts, ..setup };
        let dt = begun.map_or_else(|| time_step(&setup), Ok)?;
        let kinds = kinds(&setup, dt)?;
        let mean_radius = mean_radius(&setup);
        let reach = largest_reach(&setup);
        let skin = setup.skin.unwrap_or(FIRST_SKIN * mean_radius).max(reach);
        let horizon = if setup.skin.is_some() { 0.0 } else { HORIZON };
        let ahead = setup.sampling.ahead(dt);
        let mut walls: Vec<WallBody> = setup.walls.iter().map(|w| WallBody::new(w, reach, ahead)).collect();
        walls::beside::find(&mut walls, setup.periodic.iter().any(Option::is_some));
        slow_enough(&setup, &walls, dt)?;
        faster_than_sleep(&setup, &walls)?;
        let responses = responses(&setup, &kinds, dt);
        let rotates = kinds.iter().any(|k| k.composition.rotates()) || !setup.bonds.is_empty();
        let later = setup.bonds.iter().any(|law| law.at > 0.0);
        let contact_step = if later { critical_of_contacts(&setup)?.dt } else { f64::INFINITY };
        Ok(Model {
            setup,
            dt,
            reach,
            skin,
            width,
            walls,
            responses,
            kinds,
            horizon,
            mean_radius,
            rotates,
            contact_step,
        })
    }

    /// How far ahead in time contacts are looked for, half a step or nothing [s].
    pub fn ahead(&self) -> f64 {
        self.setup.sampling.ahead(self.dt)
    }

    /// What all particles share in a move.
    pub fn move_inputs(&self) -> MoveInputs {
        let (gravity, motion_limit) = (self.setup.gravity.into(), self.setup.guards.motion);
        MoveInputs { dt: self.dt, ahead: self.ahead(), gravity, motion_limit }
    }

    /// How the numbers of contacts are kept.
    pub fn layout(&self) -> Layout {
        Layout { rotates: self.rotates, single: self.setup.precision == Precision::Single }
    }

    /// The periodic cell as it is at t = 0, and stays where it is not strained.
    pub fn cell(&self) -> Cell {
        Cell::at_rest(self.setup.periodic)
    }
}
