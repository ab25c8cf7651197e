//! How a scene is calculated and written, and the fluid around its particles.

use super::unit;
use serde::Deserialize;

/// Precision in which contacts are computed; positions and velocities are always double.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Arithmetic {
    /// Double.
    #[default]
    F64,
    /// Single in contacts.
    Mixed,
    /// Single in contacts, their history, and sums of forces.
    F32,
}

/// `[time]`
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// End of the run [s]; may come from `--until`.
    #[serde(default, deserialize_with = "unit::seconds")]
    pub until: Option<f64>,
    /// Mean unbalanced over mean contact force [–] at which the run ends before `until`.
    #[serde(default, deserialize_with = "unit::plain")]
    pub until_unbalanced: Option<f64>,
    /// Kinetic energy [J] at which it does.
    #[serde(default, deserialize_with = "unit::joules")]
    pub until_kinetic: Option<f64>,
    /// Step.
    #[serde(default, deserialize_with = "unit::seconds")]
    pub dt: OrAuto,
    /// Share of the critical step when `dt` is "auto" [–]; absent: [`SAFETY`], or what `accuracy` needs.
    #[serde(default, deserialize_with = "unit::plain")]
    pub safety: Option<f64>,
    /// Largest error of an impact, for which the step is chosen [–].
    pub accuracy: Option<Accuracy>,
    /// Share by which the step is made shorter than the other keys say [–]: contacts then begin at another phase of it.
    #[serde(default, deserialize_with = "unit::plain")]
    pub shorten: Option<f64>,
    /// Which part of a step the force of a contact stands for.
    #[serde(default)]
    pub contacts: Sampling,
    /// How the contacts of two bodies act together.
    #[serde(default)]
    pub patch: Patches,
}

/// How the contacts of two bodies act together: a grain with the spheres of a wall, a clump with a wall, another clump or a grain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Patches {
    /// Neighbouring contacts as one, and each dashpot for the mass that it moves.
    #[default]
    Shared,
    /// Each by itself, for the mass of the whole bodies.
    Plain,
}

/// Which part of a step the force of a contact stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Sampling {
    /// The part in which both touch.
    #[default]
    Averaged,
    /// All of it, where both touch at its instant.
    Sampled,
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

/// `[local_damping]`
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LocalDamping {
    /// α [–].
    #[serde(default = "usual_factor", deserialize_with = "unit::plain")]
    pub factor: f64,
}

/// Cundall's α.
fn usual_factor() -> f64 {
    0.7
}

/// A share: `"1%"`, or 0.01.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy(pub f64);

/// A number; `None`: "auto", chosen by the program.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OrAuto(pub Option<f64>);

/// `[output]`
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Time between frames; absent: a hundredth of the run.
    #[serde(default, deserialize_with = "unit::seconds")]
    pub every: Option<Every>,
    /// Time between checkpoints [s]; absent: one at the end.
    #[serde(default, deserialize_with = "unit::seconds")]
    pub checkpoint: Option<f64>,
    /// Whether the force on each wall is written with each frame; absent: only if a wall has a servo, whose force is always written.
    #[serde(default)]
    pub wall_forces: Option<bool>,
    /// Whether the energy ledger is kept and written.
    #[serde(default)]
    pub energy: bool,
    /// Whether contacts are written with each frame.
    #[serde(default)]
    pub contacts: bool,
    /// Type of the numbers in frames.
    #[serde(default)]
    pub precision: Precision,
}

/// Time between frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Every {
    /// One at every step.
    Step,
    /// As given [s].
    Given(f64),
}

/// Type of the numbers in frames; checkpoints and crossings are always exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// Double.
    #[default]
    F64,
    /// Single.
    F32,
}

/// `[sleep]`
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sleep {
    /// Speed of the surface below which a particle is at rest [m/s].
    #[serde(deserialize_with = "unit::metres_a_second")]
    pub speed: f64,
    /// How long it must have been at rest [s].
    #[serde(default = "sleep_time", deserialize_with = "unit::seconds")]
    pub time: f64,
    /// Force that wakes it, over its weight [–].
    #[serde(default = "sleep_wake", deserialize_with = "unit::plain")]
    pub wake: f64,
}

fn sleep_time() -> f64 {
    0.02
}

fn sleep_wake() -> f64 {
    0.1
}

/// `[drag]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drag {
    /// How drag depends on speed.
    pub law: DragLaw,
    /// Viscosity of the fluid [Pa·s].
    #[serde(deserialize_with = "unit::pascal_seconds")]
    pub viscosity: f64,
    /// Density of the fluid [kg/m³]; "stokes" without buoyancy needs none.
    #[serde(default, deserialize_with = "unit::density")]
    pub density: Option<f64>,
    /// Velocity of the fluid [m/s].
    #[serde(default, deserialize_with = "unit::metres_a_second")]
    pub velocity: [f64; 3],
    /// Whether particles are lighter by the fluid that they displace.
    #[serde(default)]
    pub buoyancy: bool,
}

/// Law of drag.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DragLaw {
    /// Slow.
    Stokes,
    /// Up to Re = 2·10⁵.
    SchillerNaumann,
}

/// `[neighbours]`
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Neighbours {
    /// Margin of the neighbour lists [m]; absent: chosen by the program.
    #[serde(default, deserialize_with = "unit::metres")]
    pub skin: Option<f64>,
}

/// What becomes of a grain that goes back through all of its zone: `true`, `"remove"` or `false`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BackThroughZone {
    /// It stops the run.
    Stops,
    /// It is taken out and counted.
    IsRemoved,
    /// It moves on.
    Stays,
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

/// `[guards]`
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Guards {
    /// Largest overlap, as a share of the smaller radius [–].
    #[serde(default, deserialize_with = "unit::plain")]
    pub overlap: Option<f64>,
    /// Largest motion in one step, as a share of the radius [–].
    #[serde(default, deserialize_with = "unit::plain")]
    pub motion: Option<f64>,
    /// What becomes of a grain of an [[inlet]] that goes back through all of its zone; absent: it stops the run.
    pub zones: Option<BackThroughZone>,
    /// Largest energy that the time step may make, as a share of the energy that was exchanged and moves [–]; absent: [`Sampling::most_energy`] in a run that keeps the ledger anyway.
    pub energy: Option<EnergyGuard>,
    /// Most steps of a run; absent: [`MOST_STEPS`].
    pub steps: Option<f64>,
    /// Most frames, and most checkpoints, of a run; absent: [`MOST_FRAMES`].
    pub frames: Option<f64>,
}

/// Steps beyond which a run is taken for a typing error.
pub const MOST_STEPS: f64 = 1e12;
/// The same for frames.
pub const MOST_FRAMES: f64 = 1e7;
