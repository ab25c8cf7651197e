//! Why a run stops: each reason has its numbers as fields, and says what happened; when ([`Halt::time`]) and what to do about it is up to the caller.

use crate::model::{BondedParticle, Entrance, SetupError};
use geom::Vec3;
use std::fmt::{Display, Formatter};
use thiserror::Error;

/// Why a run was stopped.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Halt {
    /// A particle overlaps another or a wall too far.
    #[error(
        "particle {id} at {} overlaps {partner} by {overlap:.3e} m, {:.1} % of the smaller radius (limit {:.1} %)",
        shown(position), 100.0 * share, 100.0 * limit
    )]
    Overlap {
        /// When [s].
        time: f64,
        /// Which particle.
        id: u32,
        /// What it overlaps.
        partner: Partner,
        /// Where [m].
        position: Vec3,
        /// By how much [m].
        overlap: f64,
        /// Over the smaller radius [–].
        share: f64,
        /// Allowed share [–].
        limit: f64,
        /// What would bear it, where that is known.
        stiffer: Option<Box<Stiffer>>,
    },
    /// A particle comes in on top of another.
    #[error(
        "particle {id} comes in by {by} at {} on top of {partner}: they overlap by \
         {overlap:.3e} m, {:.1} % of the smaller radius (limit {:.1} %)",
        shown(position), 100.0 * share, 100.0 * limit
    )]
    InletOverlap {
        /// When [s].
        time: f64,
        /// Which particle.
        id: u32,
        /// What it comes in by.
        by: Entrance,
        /// What it overlaps.
        partner: Partner,
        /// Where [m].
        position: Vec3,
        /// By how much [m].
        overlap: f64,
        /// Over the smaller radius [–].
        share: f64,
        /// Allowed share [–].
        limit: f64,
    },
    /// A particle that is inserted becomes free inside a wall.
    #[error(
        "particle {id} comes in by {by} and becomes free at {} inside wall '{wall}': they overlap by {overlap:.3e} m",
        shown(position)
    )]
    FreeInWall {
        /// When [s].
        time: f64,
        /// Which particle.
        id: u32,
        /// What it comes in by.
        by: Entrance,
        /// Name of the wall.
        wall: String,
        /// Where; the centre of a clump [m].
        position: Vec3,
        /// By how much [m].
        overlap: f64,
    },
    /// A particle is to be inserted where another one is.
    #[error("{by} has no room for particle {id} at {}: particle {partner} is there", shown(position))]
    NoRoom {
        /// When [s].
        time: f64,
        /// Which particle.
        id: u32,
        /// What it comes in by.
        by: Entrance,
        /// Id of the one that is there.
        partner: u32,
        /// Where; the centre of a clump [m].
        position: Vec3,
    },
    /// A particle moved too far in one step, or its state is not a number.
    #[error(
        "particle {id} at {} moves {motion:.3e} m in one step, {:.1} % of its radius (limit {:.1} %)",
        shown(position), 100.0 * share, 100.0 * limit
    )]
    Motion {
        /// When [s].
        time: f64,
        /// Which particle.
        id: u32,
        /// Where [m].
        position: Vec3,
        /// How far [m].
        motion: f64,
        /// Over its radius [–].
        share: f64,
        /// Allowed share [–].
        limit: f64,
    },
    /// The state of a particle is not a number any more.
    #[error("particle {id} at {}: its force or its motion is not finite (NaN)", shown(position))]
    NotANumber {
        /// When [s].
        time: f64,
        /// Which particle.
        id: u32,
        /// Where it was last [m].
        position: Vec3,
    },
    /// The device that makes the steps has failed; the state is that of `time`.
    #[error("the device has failed: {what}")]
    Device {
        /// When [s].
        time: f64,
        /// What it says.
        what: String,
    },
    /// A strained cell in which a particle would meet itself.
    #[error("the domain is {length:.4e} m long along {axis}: particles need at least {least:.4e} m")]
    CellTooSmall {
        /// When [s].
        time: f64,
        /// x, y or z.
        axis: char,
        /// Its length [m].
        length: f64,
        /// Least length [m].
        least: f64,
    },
    /// The position of a wall that follows a force is not a number any more.
    #[error(
        "wall '{wall}', which follows a force, has a position that is not finite (NaN): the force of the particles on it was \
         {push:e} N"
    )]
    WallNotANumber {
        /// When [s].
        time: f64,
        /// Which wall.
        wall: String,
        /// Along the direction of its servo [N].
        push: f64,
    },
    /// A wall on a spring is faster than it may be.
    #[error("wall '{wall}' on its spring moves at {speed:.4e} m/s (limit {limit:.4e} m/s)")]
    WallTooFast {
        /// When [s].
        time: f64,
        /// Which wall.
        wall: String,
        /// How fast [m/s].
        speed: f64,
        /// Its limit [m/s].
        limit: f64,
    },
    /// A wall on a spring is so light that its contacts make the step unstable.
    #[error(
        "wall '{wall}' on its spring has a mass of {mass:.4e} kg; with {contacts} contacts the time step needs {least:.4e} kg"
    )]
    WallTooLight {
        /// When [s].
        time: f64,
        /// Which wall.
        wall: String,
        /// Its mass [kg].
        mass: f64,
        /// Contacts that push it.
        contacts: u32,
        /// The least mass that is stable [kg].
        least: f64,
    },
    /// A wall that follows a force has passed all particles.
    #[error(
        "wall '{wall}', which follows a force, touches nothing, and all particles are behind it: it has moved by {shift:.4e} m"
    )]
    WallPastAll {
        /// When [s].
        time: f64,
        /// Which wall.
        wall: String,
        /// How far it has moved along the direction of its servo [m].
        shift: f64,
    },
    /// Contacts or forces on walls are asked for, and the wrench of each contact is not kept
    /// ([`crate::Setup::record_wrenches`]).
    #[error("the wrench of each contact was not recorded")]
    NotKept {
        /// When [s].
        time: f64,
    },
    /// A particle has come back through an inlet, against the flow.
    #[error(
        "particle {id} at {} came in by inlet {inlet} and has gone back through all of its \
         zone, {behind:.3e} m behind the generation plane, where nothing of the plant is simulated",
        shown(position)
    )]
    CameBack {
        /// When [s].
        time: f64,
        /// Which particle.
        id: u32,
        /// Its inlet.
        inlet: u32,
        /// Where [m].
        position: Vec3,
        /// How far behind the generation plane [m].
        behind: f64,
    },
    /// A particle that is to come in is too fast for the time step.
    #[error(
        "particle {id} comes in by {by} at {speed:.4e} m/s, {:.1} % of its radius in one step of {dt:.3e} s \
         (limit {:.1} %)",
        100.0 * share, 100.0 * limit
    )]
    TooFast {
        /// When [s].
        time: f64,
        /// Which particle.
        id: u32,
        /// What it comes in by.
        by: Entrance,
        /// How fast [m/s].
        speed: f64,
        /// Time step [s].
        dt: f64,
        /// Distance in one step over its radius [–].
        share: f64,
        /// Allowed share [–].
        limit: f64,
    },
    /// Bonds that are made during the run are too stiff for its step.
    #[error(
        "bonds are made that need a time step below {critical:.4e} s (this run has {dt:.4e} s): those of particle {} ({}, \
         radius {:.4e} m)",
        particle.id, particle.material, particle.radius
    )]
    BondsTooStiff {
        /// When [s].
        time: f64,
        /// Time step [s].
        dt: f64,
        /// Critical step with these bonds [s].
        critical: f64,
        /// The particle that they join.
        particle: BondedParticle,
    },
    /// Bonds that are made during the run are refused.
    #[error("{error}")]
    Bonds {
        /// When [s].
        time: f64,
        /// Why.
        error: Box<SetupError>,
    },
    /// Energy came from nowhere.
    #[error(
        "the time step has made {made:.3e} J, {} of the {of:.3e} J that were exchanged or in motion and springs at most (limit {:.2} %)",
        share_of(*made, *of), 100.0 * limit
    )]
    Energy {
        /// When [s].
        time: f64,
        /// Energy made [J].
        made: f64,
        /// Energy exchanged and kinetic energy [J].
        of: f64,
        /// Allowed share [–].
        limit: f64,
    },
}

impl Halt {
    /// When it happened [s].
    pub fn time(&self) -> f64 {
        match self {
            Halt::Overlap { time, .. }
            | Halt::InletOverlap { time, .. }
            | Halt::FreeInWall { time, .. }
            | Halt::NoRoom { time, .. }
            | Halt::Motion { time, .. }
            | Halt::NotANumber { time, .. }
            | Halt::Device { time, .. }
            | Halt::CellTooSmall { time, .. }
            | Halt::WallNotANumber { time, .. }
            | Halt::WallTooFast { time, .. }
            | Halt::WallTooLight { time, .. }
            | Halt::WallPastAll { time, .. }
            | Halt::NotKept { time, .. }
            | Halt::CameBack { time, .. }
            | Halt::TooFast { time, .. }
            | Halt::BondsTooStiff { time, .. }
            | Halt::Bonds { time, .. }
            | Halt::Energy { time, .. } => *time,
        }
    }
}

/// What a contact must be made of to bear an approach.
#[derive(Debug, Clone, PartialEq)]
pub struct Stiffer {
    /// Speed of the approach [m/s]; 0 where nothing approaches.
    pub speed: f64,
    /// "young" or "stiffness".
    pub key: &'static str,
    /// Name of the material, or of both.
    pub of: String,
    /// Its least value, in `unit`.
    pub value: f64,
    /// What the hardest impact of the contacts and neighbours of these materials needs, at the fastest approach among them, in `unit`; no less than `value`.
    pub most: f64,
    /// Pa or N/m.
    pub unit: &'static str,
}

/// A position in messages.
fn shown(position: &Vec3) -> String {
    format!("({:.4e}, {:.4e}, {:.4e}) m", position.x, position.y, position.z)
}

/// What a particle overlaps.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Partner {
    /// A particle, by id.
    Particle(u32),
    /// A wall, by name.
    Wall(String),
}

impl Display for Partner {
    fn fmt(&self, f: &mut Formatter) -> std::fmt::Result {
        match self {
            Partner::Particle(id) => write!(f, "particle {id}"),
            Partner::Wall(name) => write!(f, "wall '{name}'"),
        }
    }
}

/// A share in words, also of nothing.
fn share_of(part: f64, whole: f64) -> String {
    if whole == 0.0 { "all".to_owned() } else { format!("{:.2} %", 100.0 * part / whole) }
}
