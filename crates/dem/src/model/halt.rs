//! Why a run stops.

use thiserror::Error;

/// Why a run was stopped.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Halt {
    /// Two bodies overlap too far.
    #[error(
        "t = {time:.6e} s: particle {id} at ({x:.4e}, {y:.4e}, {z:.4e}) m overlaps {partner} by {overlap:.3e} m, {:.1} % of the smaller radius (limit {:.1} %): stiffen the material, shorten dt, or raise guards.overlap",
        100.0 * share, 100.0 * limit
    )]
    Overlap {
        /// When [s].
        time: f64,
        /// Which particle.
        id: u32,
        /// What it overlaps.
        partner: String,
        /// Where [m].
        x: f64,
        /// Where [m].
        y: f64,
        /// Where [m].
        z: f64,
        /// By how much [m].
        overlap: f64,
        /// Over the smaller radius [–].
        share: f64,
        /// Allowed share [–].
        limit: f64,
    },
    /// A particle comes in on top of another.
    #[error(
        "t = {time:.6e} s: particle {id} comes in by inlet {inlet} at ({x:.4e}, {y:.4e}, {z:.4e}) m on top of {partner}: they overlap by \
         {overlap:.3e} m, {:.1} % of the smaller radius (limit {:.1} %): keep its zone free at the start, let slow grains start farther \
         back (stage-replay --ahead), cut where nothing piles up to the plane, or raise guards.overlap",
        100.0 * share, 100.0 * limit
    )]
    InletOverlap {
        /// When [s].
        time: f64,
        /// Which particle.
        id: u32,
        /// Its inlet.
        inlet: u32,
        /// What it overlaps.
        partner: String,
        /// Where [m].
        x: f64,
        /// Where [m].
        y: f64,
        /// Where [m].
        z: f64,
        /// By how much [m].
        overlap: f64,
        /// Over the smaller radius [–].
        share: f64,
        /// Allowed share [–].
        limit: f64,
    },
    /// A particle moved too far in one step, or its state is not a number.
    #[error(
        "t = {time:.6e} s: particle {id} at ({x:.4e}, {y:.4e}, {z:.4e}) m moves {motion:.3e} m in one step, {:.1} % of its radius (limit {:.1} %): shorten dt or raise guards.motion",
        100.0 * share, 100.0 * limit
    )]
    Motion {
        /// When [s].
        time: f64,
        /// Which particle.
        id: u32,
        /// Where [m].
        x: f64,
        /// Where [m].
        y: f64,
        /// Where [m].
        z: f64,
        /// How far [m].
        motion: f64,
        /// Over its radius [–].
        share: f64,
        /// Allowed share [–].
        limit: f64,
    },
    /// The state of a particle is not a number any more.
    #[error(
        "t = {time:.6e} s: particle {id} at ({x:.4e}, {y:.4e}, {z:.4e}) m: the force on it or its motion is beyond all numbers (NaN): \
         its speed, spin or stiffness is far too large; look at what it started with, or shorten dt"
    )]
    NotANumber {
        /// When [s].
        time: f64,
        /// Which particle.
        id: u32,
        /// Where it was last [m].
        x: f64,
        /// Where it was last [m].
        y: f64,
        /// Where it was last [m].
        z: f64,
    },
    /// A wall that follows a force has no place any more.
    #[error(
        "t = {time:.6e} s: wall '{wall}', which follows a force, has no place any more (NaN): the force of the particles on it was \
         {push:e} N; look at the stiffness of its contacts, or shorten dt"
    )]
    WallNotANumber {
        /// When [s].
        time: f64,
        /// Which wall.
        wall: String,
        /// Along the direction of its servo [N].
        push: f64,
    },
    /// Contacts or forces on walls are asked for, and the run does not keep them.
    #[error(
        "t = {time:.6e} s: the load of each contact is asked for, which this run does not keep: record_loads(true) before its steps"
    )]
    NotKept {
        /// When [s].
        time: f64,
    },
    /// A grain has come back through an inlet, against the flow.
    #[error(
        "t = {time:.6e} s: particle {id} at ({x:.4e}, {y:.4e}, {z:.4e}) m came in by inlet {inlet} and has gone back through all of its \
         zone, {behind:.3e} m behind the generation plane, where nothing of the plant is simulated: cut the plant farther upstream, or \
         set guards.zones = false where grains get there by another way"
    )]
    CameBack {
        /// When [s].
        time: f64,
        /// Which particle.
        id: u32,
        /// Its inlet.
        inlet: u32,
        /// Where [m].
        x: f64,
        /// Where [m].
        y: f64,
        /// Where [m].
        z: f64,
        /// How far behind the generation plane [m].
        behind: f64,
    },
    /// A particle that is to come in is too fast for the time step.
    #[error(
        "t = {time:.6e} s: particle {id} comes in by inlet {inlet} at {speed:.4e} m/s, {:.1} % of its radius in one step of {dt:.3e} s \
         (limit {:.1} %): shorten dt, or raise guards.motion",
        100.0 * share, 100.0 * limit
    )]
    TooFast {
        /// When [s].
        time: f64,
        /// Which particle.
        id: u32,
        /// Its inlet.
        inlet: u32,
        /// How fast [m/s].
        speed: f64,
        /// Time step [s].
        dt: f64,
        /// Way in one step over its radius [–].
        share: f64,
        /// Allowed share [–].
        limit: f64,
    },
    /// Energy came from nowhere.
    #[error(
        "t = {time:.6e} s: the time step has made {made:.3e} J, {:.2} % of the {of:.3e} J that were exchanged or in motion and springs at most (limit {:.2} %): shorten dt (time.safety) or raise guards.energy",
        100.0 * made / of, 100.0 * limit
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
