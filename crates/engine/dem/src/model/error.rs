//! What the engine refuses: each error has its numbers as fields, and says what is wrong; what to do about it is up to the caller.

use crate::model::{OutOfRange, Quantity, StepCause};
use crate::setup::{Clusters, Precision};
use laws::simd::Width;
use thiserror::Error;

/// Why a setup cannot run.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SetupError {
    /// Two materials can meet and have no contact law.
    #[error("no contact law between materials '{a}' and '{b}'")]
    NoContact {
        /// One material.
        a: String,
        /// The other.
        b: String,
    },
    /// The time step is not stable.
    #[error("time step {dt:.4e} s is above the critical step {critical:.4e} s of {cause}")]
    StepTooLarge {
        /// Time step [s].
        dt: f64,
        /// Critical step [s].
        critical: f64,
        /// What sets it.
        cause: Box<StepCause>,
    },
    /// The time step skips the motion of a wall.
    #[error("time step {dt:.4e} s is above the longest {most:.4e} s for {cause}")]
    StepAbovePeriod {
        /// Time step [s].
        dt: f64,
        /// Largest step that resolves the motion [s].
        most: f64,
        /// The motion, and what else bounds the step.
        cause: Box<StepCause>,
    },
    /// The time step is to be a share of the critical step, and no contact can occur.
    #[error("no contact can occur, so there is no critical time step")]
    NoStep,
    /// A quantity is outside its range.
    #[error("{0}")]
    OutOfRange(Box<OutOfRange>),
    /// Local damping beside something that it does not act on.
    #[error("local damping is not available yet with {0}")]
    LocalDampingWith(&'static str),
    /// Two particles of one id.
    #[error("particle id {0} is used twice")]
    DuplicateId(u32),
    /// A particle that enters with an id that is in use.
    #[error("particle id {id}, due at {time} s, is in the run already")]
    DuplicateEntryId {
        /// The id.
        id: u32,
        /// When it is due [s].
        time: f64,
    },
    /// A zone that ends before both ends of a bond are past its plane.
    #[error("zone of {length:.4e} m is not longer than a bond may be at rest, {longest:.4e} m")]
    ZoneShorterThanBond {
        /// Length of the zone [m].
        length: f64,
        /// Largest length of a bond at rest [m].
        longest: f64,
    },
    /// A zone that lets particles act across it.
    #[error("zone of {length:.4e} m is not longer than the largest particle diameter {diameter:.4e} m")]
    ZoneTooShort {
        /// Length of the zone [m].
        length: f64,
        /// Largest diameter [m].
        diameter: f64,
    },
    /// A periodic box in which a particle meets itself.
    #[error("period of {period:.4e} m along {axis} is too small: particles need at least {least:.4e} m")]
    PeriodTooSmall {
        /// x, y or z.
        axis: char,
        /// The period [m].
        period: f64,
        /// Least period [m].
        least: f64,
    },
    /// A skin with which a particle is listed with itself.
    #[error(
        "skin {skin:.4e} m and the largest diameter are more than the period of {period:.4e} m along {axis}"
    )]
    PeriodBelowSkin {
        /// x, y or z.
        axis: char,
        /// The period [m].
        period: f64,
        /// The skin [m].
        skin: f64,
        /// The largest skin [m].
        most: f64,
    },
    /// Something that a strained cell cannot have.
    #[error("a domain that is strained has no {0}")]
    StrainedWith(&'static str),
    /// An open axis that is to be strained.
    #[error("{axis} is to be strained and is not periodic")]
    StrainedOpen {
        /// x, y or z.
        axis: char,
    },
    /// Lanes that this machine does not have.
    #[error("this machine cannot compute with {0:?}")]
    NoWidth(Width),
    /// An entry out of order or later than it is due.
    #[error("particle {id} is due at {time} s, before {now} s")]
    EntryLate {
        /// Its id.
        id: u32,
        /// When it is due [s].
        time: f64,
        /// Now, or when the entry before is due [s].
        now: f64,
    },
    /// A particle on the wrong side of a plane.
    #[error("particle {id} starts {depth:.4e} m behind wall '{wall}'")]
    BehindPlane {
        /// Its id.
        id: u32,
        /// How far [m].
        depth: f64,
        /// The wall.
        wall: String,
    },
    /// A storage plane that tests the lowest point, in a setup with clumps of this shape.
    #[error("a storage plane tests only the centres of clumps (here '{0}')")]
    ClumpOutlet(String),
    /// Effects that are computed in double precision only.
    #[error("precision {} has no {}", precision.name(), effects_between(effects, between))]
    PrecisionWithout {
        /// The precision.
        precision: Precision,
        /// The effects.
        effects: Vec<&'static str>,
        /// The materials of their contact law.
        between: [String; 2],
    },
    /// Drag and sleep in one setup.
    #[error("drag does not act on sleeping particles yet")]
    DragAndSleep,
    /// Bonds in one setup with particles that sleep.
    #[error("bonds cannot be combined with sleep yet")]
    BondsAndSleep,
    /// A bond without a direction.
    #[error("particles {} and {} have the same centre", ids[0], ids[1])]
    BondOfZeroLength {
        /// Their ids.
        ids: [u32; 2],
    },
    /// Bonds of two materials that join no particles.
    #[error("bond {}–{}: no two particles of these materials{} are within a gap of {gap:.4e} m at the start", between[0], between[1], clusters.said())]
    BondJoinsNothing {
        /// The materials.
        between: [String; 2],
        /// Gap [m].
        gap: f64,
        /// Which clusters they may be of.
        clusters: Clusters,
    },
    /// Sleep in a setup with clumps of this shape.
    #[error("clumps (here '{0}') cannot sleep")]
    ClumpSleep(String),
    /// A particle that enters and becomes free on the wrong side of a plane.
    #[error("particle {id} would become free {depth:.4e} m behind wall '{wall}'")]
    EntryBehindPlane {
        /// Its id.
        id: u32,
        /// How far [m].
        depth: f64,
        /// The wall.
        wall: String,
    },
    /// A position so far away that its last digit is coarse.
    #[error(
        "{quantity}: {far:.4e} m from the origin, its position is known to {:.1e} of its radius {radius:.4e} m, and a millionth is needed",
        far * f64::EPSILON / radius
    )]
    TooFar {
        /// Which position.
        quantity: Box<Quantity>,
        /// Its largest coordinate [m].
        far: f64,
        /// Radius of the sphere [m].
        radius: f64,
    },
    /// A wall that moves through particles within a few steps.
    #[error("wall '{wall}': {speed:.4e} m/s is {:.1} % of the smallest radius in a step of {dt:.4e} s (limit {:.1} %)", 100.0 * share, 100.0 * limit)]
    WallTooFast {
        /// The wall.
        wall: String,
        /// Its largest speed [m/s].
        speed: f64,
        /// Time step [s].
        dt: f64,
        /// Distance in a step over the smallest radius [–].
        share: f64,
        /// Allowed [–].
        limit: f64,
    },
    /// A wall that carries particles so slowly that they would fall asleep on it.
    #[error(
        "wall '{wall}': {speed:.4e} m/s is less than twice the speed of sleep {sleep:.4e} m/s, so that particles that it carries would fall asleep"
    )]
    WallSlowerThanSleep {
        /// The wall.
        wall: String,
        /// Its largest speed [m/s].
        speed: f64,
        /// Speed of sleep [m/s].
        sleep: f64,
        /// Largest speed of sleep [m/s].
        most: f64,
    },
    /// A plane that rotates out of itself: the speed of its far points has no bound.
    #[error("wall '{0}': an unbounded plane can turn about its own normal only")]
    RotatingPlane(String),
    /// The surface of an unbounded plane would leave the plane.
    #[error(
        "wall '{0}': the surface of an unbounded plane can only move along the plane and rotate about its own normal"
    )]
    BeltLeavesPlane(String),
    /// A saved state of another setup.
    #[error("the saved state does not fit the setup: {0}")]
    OtherState(StateMismatch),
}

/// Effects with the materials of their contact law: "twisting_resistance (glass–steel)".
fn effects_between(effects: &[&str], [a, b]: &[String; 2]) -> String {
    format!("{} ({a}–{b})", effects.join(", "))
}

/// How a saved state differs from a setup.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum StateMismatch {
    /// A time step that is none.
    #[error("time step {0} s")]
    InvalidStep(f64),
    /// Another time step.
    #[error("time step {asked} s, saved {saved} s")]
    Step {
        /// Of the setup [s].
        asked: f64,
        /// Of the saved state [s].
        saved: f64,
    },
    /// Sleep.
    #[error("one has particles that sleep and the other has not")]
    Sleep,
    /// Rotation.
    #[error("one has rotation and the other has not")]
    Rotation,
    /// Servos.
    #[error("one has walls that follow a force and the other has not")]
    Servos,
    /// A strained cell.
    #[error("one has a domain that is strained and the other has not")]
    Strain,
    /// Walls on springs.
    #[error("one has walls on springs and the other has not")]
    Mounts,
    /// The number of bonds.
    #[error("another number of bonds")]
    Bonds,
    /// The number of contacts.
    #[error("another number of contacts")]
    Contacts,
    /// The number of wrenches.
    #[error("another number of wrenches")]
    Wrenches,
    /// A part with a length, an index or a number that no run writes.
    #[error("its {0} are not what a run writes: it was changed")]
    Content(&'static str),
}
