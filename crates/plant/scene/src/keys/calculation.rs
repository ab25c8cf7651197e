//! How a scene is calculated and written, and the fluid around its particles.

use super::table::{table, words};
use dem::setup::CameBack;

/// Whole numbers up to here are exact.
const EXACT: f64 = 9e15;

words! {
    /// Precision in which contacts are computed; positions and velocities are always double.
    #[derive(Default)]
    Arithmetic {
        /// Double.
        #[default]
        F64 "f64",
        /// Single in contacts.
        Mixed "mixed",
        /// Single in contacts, their history, and sums of forces.
        F32 "f32",
    }
}

table! {
    /// `[time]`
    #[derive(Default)]
    Time section {
        /// End of the run.
        until: Option<f64> = absent("required, here or as `--until`"), "s", AboveZeroUpTo(record::LATEST), "1";
        /// End the run earlier, when the mean unbalanced force is at most this share of the mean contact force; see below.
        until_unbalanced: Option<f64> = absent("none"), "", Positive, "1e-5";
        /// End the run earlier, when the kinetic energy of all grains is at most this.
        until_kinetic: Option<f64> = absent("none"), "J", Positive, "1e-6";
        /// Time step.
        dt: OrAuto = absent("\"auto\""), "s", Positive, "1e-5";
        /// With "auto": time step over the critical step.
        safety: Option<f64> = absent("0.5; 0.2 for elastic grains: see below"), "", Within(1e-6, 1.0), "0.5";
        /// With "auto": largest error of an impact, such as "1%"; sets `safety` from measured curves, which have a smallest error: see below.
        accuracy: Option<Accuracy> = absent("none"), "", Within(1e-9, 1.0), "\"1%\"";
        /// Share by which the step is made shorter; contacts then begin at another phase of the step.
        shorten: Option<f64> = absent("0"), "", Within(0.0, 0.5), "0.1";
        /// The contacts of two bodies that touch at several places (a grain on a wall of spheres, a clump): act as one contact where they are
        /// neighbours, each dashpot for the mass that it moves; or each by itself, as other programs do.
        patch: Patches = absent("\"shared\""), "", Any, "\"plain\"";
        /// The force of a contact over a step: its mean over the part in which the two touch ("averaged"), or its value at one instant ("sampled").
        contacts: Sampling = absent("\"averaged\""), "", Any, "\"sampled\"";
    }
}

words! {
    /// How the contacts of two bodies act together: a grain with the spheres of a wall, a clump with a wall, another clump or a grain.
    #[derive(Default)]
    Patches {
        /// Neighbouring contacts as one, and each dashpot for the mass that it moves.
        #[default]
        Shared "shared",
        /// Each by itself, for the mass of the whole bodies.
        Plain "plain",
    }
}

words! {
    /// Which part of a step the force of a contact stands for.
    #[derive(Default)]
    Sampling {
        /// The part in which both touch.
        #[default]
        Averaged "averaged",
        /// All of it, where both touch at its instant.
        Sampled "sampled",
    }
}

impl Sampling {
    /// Share of the energy exchanged beyond which what the time step makes stops a run that keeps the ledger [–]. At the default step and up to 0.95
    /// of the critical one damped grains make at most 0.7 % (averaged); at the default step 2.3 % (sampled). docs/theory/time-step.md has the scenes.
    pub fn most_energy(self) -> f64 {
        match self {
            Sampling::Averaged => 0.02,
            Sampling::Sampled => 0.05,
        }
    }
}

table! {
    /// `[local_damping]`
    #[derive(Copy)]
    LocalDamping section {
        /// α: share of the unbalanced force that acts against the motion; 0.7 is usual.
        factor: f64 = default(0.7), "", Between(0.0, 1.0, ""), "0.5";
    }
}

/// A share: `"1%"`, or 0.01.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy(pub f64);

/// A number; `None`: "auto", chosen by the program.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OrAuto(pub Option<f64>);

table! {
    /// `[output]`
    #[derive(Default)]
    Output section {
        /// Time between frames; "step" writes every step.
        every: Option<Every> = absent("`until`/100"), "s", Positive, "\"20 ms\"";
        /// Time between checkpoints.
        checkpoint: Option<f64> = absent("one at the end"), "s", Positive, "0.5";
        /// Compute the energy ledger and write it with every frame.
        energy: bool = absent("false"), "", Any, "true";
        /// Write a row for each contact with every frame (topic `/contacts`).
        contacts: bool = absent("false"), "", Any, "true";
        /// Write with every frame what grains do to each wall: the force, and means over all steps since the frame before (topic `/wall_forces`); always on when a wall has a `servo`, where `false` prints a warning.
        wall_forces: Option<bool> = absent("false"), "", Any, "true";
        /// Write with every frame the load, sliding work and impacts of each wall sphere and triangle over all steps since the frame before (topic `/wall_wear`), and `/wall_forces` with sliding work.
        wear: bool = absent("false"), "", Any, "true";
        /// Type of the numbers in frames.
        precision: Precision = absent("\"f64\""), "", Any, "\"f32\"";
    }
}

/// Time between frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Every {
    /// One at every step.
    Step,
    /// As given [s].
    Given(f64),
}

words! {
    /// Type of the numbers in frames; checkpoints and crossings are always exact.
    #[derive(Default)]
    Precision {
        /// Double.
        #[default]
        F64 "f64",
        /// Single.
        F32 "f32",
    }
}

table! {
    /// `[sleep]`
    #[derive(Copy)]
    Sleep section {
        /// A particle falls asleep when the speed of its surface has stayed below this.
        speed: f64 = required, "m/s", Positive, "0.01";
        /// How long the speed must have stayed below.
        time: f64 = default(0.02), "s", Positive, "\"50 ms\"";
        /// Largest acceleration of a particle that falls asleep, as a share of g.
        wake: f64 = default(0.1), "", Between(0.0, 1.0, "from 1 on, a grain in free fall counts as one at rest"), "0.2";
    }
}

table! {
    /// `[drag]`
    Drag section {
        /// How drag depends on speed.
        law: DragLaw = required, "", Any, "\"stokes\"";
        /// Dynamic viscosity of the fluid.
        viscosity: f64 = required, "Pa·s", Positive, "1.8e-5";
        /// Density of the fluid; "schiller-naumann" and `buoyancy` need it.
        density: Option<f64> = absent("–"), "kg/m³", Positive, "1.2";
        /// Velocity of the fluid.
        velocity: [f64; 3] = absent("0"), "m/s", Finite, "[0, 0, 1]";
        /// Subtract the weight of the displaced fluid.
        buoyancy: bool = absent("false"), "", Any, "true";
    }
}

words! {
    /// Law of drag.
    DragLaw {
        /// Slow.
        Stokes "stokes",
        /// Up to Re = 2·10⁵.
        SchillerNaumann "schiller-naumann",
    }
}

table! {
    /// `[neighbours]`
    #[derive(Default)]
    Neighbours section {
        /// Slack of the neighbour lists, one for all particles.
        skin: Option<f64> = absent("chosen"), "m", Positive, "\"1 mm\"";
    }
}

/// What the time step may make of energy: a share, or `false`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EnergyGuard {
    /// At most this share stops no run [–].
    Share(f64),
    /// Nothing stops a run.
    Off,
}

impl Guards {
    /// The share that the scene gives; `None` without one, and where the guard is off.
    pub fn energy_share(&self) -> Option<f64> {
        match self.energy {
            Some(EnergyGuard::Share(share)) => Some(share),
            Some(EnergyGuard::Off) | None => None,
        }
    }
}

table! {
    /// `[guards]`
    #[derive(Default)]
    Guards section {
        /// Largest overlap, as a share of the smaller radius.
        overlap: Option<f64> = absent("0.25"), "", AboveZeroUpTo(1.0), "0.25";
        /// Largest motion in one step, as a share of the radius.
        motion: Option<f64> = absent("0.25"), "", Positive, "0.25";
        /// Stop when a grain of an `[[inlet]]` goes back through its whole zone; "remove" takes it out and counts it
        /// ([run.md](../how-to/run.md#guards)).
        zones: Option<CameBack> = absent("true"), "", Any, "\"remove\"";
        /// Largest energy that the time step may create, as a share of the energy exchanged plus the largest kinetic and elastic energy so far;
        /// false: no limit.
        energy: Option<EnergyGuard> = absent("0.02 (0.05 with `contacts = \"sampled\"`) with the energy ledger, else off"), "", Positive, "0.02";
        /// Refuse a run of more steps.
        steps: Option<f64> = absent("1e12"), "", Within(1.0, EXACT), "1e12";
        /// Refuse a run of more frames, or of more checkpoints.
        frames: Option<f64> = absent("1e7"), "", Within(1.0, EXACT), "1e7";
    }
}

/// Steps beyond which a run is taken for a typing error.
pub const MOST_STEPS: f64 = 1e12;
/// The same for frames.
pub const MOST_FRAMES: f64 = 1e7;
