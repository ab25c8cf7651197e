//! What the engine refuses, and what stops it.

use crate::simd::Width;
use thiserror::Error;

/// Why a setup cannot run.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SetupError {
    /// Two materials can meet and have no law.
    #[error("contact: no law between '{a}' and '{b}': add a [[contact]] with between = [\"{a}\", \"{b}\"]")]
    NoContact {
        /// One material.
        a: String,
        /// The other.
        b: String,
    },
    /// The time step is not stable.
    #[error(
        "time.dt: {dt:.4e} s is above the critical step {critical:.4e} s of {pair}: use dt = \"auto\", a smaller dt, or softer materials"
    )]
    StepTooLarge {
        /// Asked for [s].
        dt: f64,
        /// Critical [s].
        critical: f64,
        /// What sets it.
        pair: String,
    },
    /// No contact can occur, so no step follows.
    #[error("time.dt: \"auto\" needs a pair that can touch, and there is none: give dt in seconds")]
    NoStep,
    /// A quantity is outside its range.
    #[error("{what}: {value} {unit} is outside {range}")]
    Range {
        /// Where and what.
        what: String,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// What is allowed.
        range: String,
    },
    /// Two particles of one id.
    #[error("particle id {0} is used twice: give each particle its own")]
    IdTwice(u32),
    /// An entry whose id is in use.
    #[error(
        "inlet: particle id {id}, due at {time} s, is in the run already: give the particles of this scene other ids (first_id), or the \
         replayed ones (stage-replay --first-id)"
    )]
    EntryTwice {
        /// The id.
        id: u32,
        /// When it is due [s].
        time: f64,
    },
    /// A zone that ends before both ends of a bond are past its plane.
    #[error("zone of {length:.4e} m is not longer than a bond may be at rest, {longest:.4e} m: use at least {:.4e} m, or a smaller gap in [[bond]]", 1.2 * longest)]
    ZoneShorterThanBond {
        /// L [m].
        length: f64,
        /// Length of a bond at rest [m].
        longest: f64,
    },
    /// A zone that lets particles act across it.
    #[error("zone of {length:.4e} m is not longer than the largest particle diameter {diameter:.4e} m: use at least {:.4e} m", 1.2 * diameter)]
    ZoneTooShort {
        /// Its length [m].
        length: f64,
        /// Largest diameter [m].
        diameter: f64,
    },
    /// A periodic box in which a particle meets itself.
    #[error(
        "domain: period of {period:.4e} m along {axis} is too small: particles need at least {least:.4e} m"
    )]
    PeriodTooSmall {
        /// x, y or z.
        axis: char,
        /// The period [m].
        period: f64,
        /// Least [m].
        least: f64,
    },
    /// A skin with which a particle is listed with itself.
    #[error(
        "neighbours.skin: {skin:.4e} m and the largest diameter are more than the period of {period:.4e} m along {axis}: use at most {most:.4e} m, \
         or leave the key out"
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
    /// Lanes that this machine does not have.
    #[error("lanes: this machine cannot compute with {0:?}: use one of Width::available()")]
    NoWidth(Width),
    /// An entry out of order or later than it is due.
    #[error("inlet: particle {id} is due at {time} s, before {now} s: crossings must come in time order")]
    EntryLate {
        /// Its id.
        id: u32,
        /// Its time [s].
        time: f64,
        /// Now, or the time of the entry before [s].
        now: f64,
    },
    /// A particle that no plane can hold.
    #[error(
        "particle {id} starts {depth:.4e} m behind wall '{wall}': move it to the side that the plane's normal points to"
    )]
    BehindPlane {
        /// Its id.
        id: u32,
        /// How far [m].
        depth: f64,
        /// The wall.
        wall: String,
    },
    /// A storage plane in a scene with clumps.
    #[error(
        "outlet: of clumps (the scene has '{0}') only centres are tested: use test = \"centre\" in [[outlet]]"
    )]
    ClumpOutlet(String),
    /// An effect that is computed in double precision only.
    #[error(
        "precision: \"{precision}\" has no {what}: leave the key out for double precision, or that effect"
    )]
    PrecisionWithout {
        /// The precision asked for.
        precision: &'static str,
        /// The effect, and between what.
        what: String,
    },
    /// Particles that the fluid does not act on.
    #[error("drag: not available yet with [sleep]: leave out one of them")]
    DragAndSleep,
    /// What bonds are not followed through.
    #[error("bond: not available yet with {0}: leave out one of them")]
    BondWith(&'static str),
    /// A bond that has no direction.
    #[error("bond: particles {} and {} have one centre: move one of them", ids[0], ids[1])]
    BondOfNoLength {
        /// Their ids.
        ids: [u32; 2],
    },
    /// A bond that joins no two particles.
    #[error(
        "bond {between}: no two particles of these materials are within a gap of {gap:.4e} m at the start: give a larger gap, or leave it out"
    )]
    BondOfNobody {
        /// Materials.
        between: String,
        /// Gap [m].
        gap: f64,
    },
    /// Sleep in a scene with clumps.
    #[error("sleep: clumps (the scene has '{0}') do not sleep: leave out [sleep], or use spheres")]
    ClumpSleep(String),
    /// An entry that no plane can hold.
    #[error(
        "inlet: particle {id} would become free {depth:.4e} m behind wall '{wall}': move the inlet's plane or the wall, or turn the wall's normal round"
    )]
    EntryBehindPlane {
        /// Its id.
        id: u32,
        /// How far [m].
        depth: f64,
        /// The wall.
        wall: String,
    },
    /// A place so far away that its last digit is coarse.
    #[error(
        "{what}: {far:.4e} m from the origin, its position is known to {:.1e} of its radius {radius:.4e} m, and a millionth is needed: shift the scene to the origin",
        far * f64::EPSILON / radius
    )]
    TooFar {
        /// What.
        what: String,
        /// Its largest coordinate [m].
        far: f64,
        /// Its radius [m].
        radius: f64,
    },
    /// A wall that a particle cannot see coming.
    #[error("wall '{wall}': {speed:.4e} m/s is {:.1} % of the smallest radius in a step of {dt:.4e} s (limit {:.1} %): shorten dt, or slow the wall", 100.0 * share, 100.0 * limit)]
    WallTooFast {
        /// The wall.
        wall: String,
        /// Its largest speed [m/s].
        speed: f64,
        /// Step [s].
        dt: f64,
        /// Way in a step over the smallest radius [–].
        share: f64,
        /// Allowed [–].
        limit: f64,
    },
    /// A rotating plane, whose speed has no bound.
    #[error(
        "wall '{0}': an unbounded plane can turn about its own normal only: use a mesh or wall spheres, or rotate.about along the normal"
    )]
    TurningPlane(String),
    /// A saved state of another setup.
    #[error("resume: the saved state does not fit this scene: {0}")]
    OtherState(String),
}
