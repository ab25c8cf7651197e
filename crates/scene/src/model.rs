//! The keys of a scene, as they are written.

use dem::setup::{ZoneMotion, ZoneTest};
use serde::Deserialize;

/// A scene; see CLI.md of the project for an example. SI units.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// Acceleration of free fall [m/s²]; absent: none.
    #[serde(default)]
    pub gravity: [f64; 3],
    /// Id of the first particle that the scene itself makes; particles of an inlet keep theirs.
    #[serde(default)]
    pub first_id: u32,
    /// In which precision contacts are computed.
    #[serde(default)]
    pub precision: Arithmetic,
    /// Time.
    #[serde(default)]
    pub time: Time,
    /// What is written, and when.
    #[serde(default)]
    pub output: Output,
    /// Extent.
    #[serde(default)]
    pub domain: Domain,
    /// The fluid around the particles; absent: none.
    pub drag: Option<Drag>,
    /// Search for neighbours.
    #[serde(default)]
    pub neighbours: Neighbours,
    /// When particles at rest are passed over; absent: never.
    pub sleep: Option<Sleep>,
    /// When the run is stopped.
    #[serde(default)]
    pub guards: Guards,
    /// Materials.
    #[serde(default)]
    pub material: Vec<Material>,
    /// Laws between materials.
    #[serde(default)]
    pub contact: Vec<Contact>,
    /// Bonds between particles that are close at t = 0.
    #[serde(default)]
    pub bond: Vec<Bond>,
    /// Shapes of rigid clumps.
    #[serde(default)]
    pub clump: Vec<Clump>,
    /// Rigid clumps at t = 0.
    #[serde(default)]
    pub body: Vec<Body>,
    /// Shapes filled with particles at t = 0.
    #[serde(default)]
    pub fill: Vec<Fill>,
    /// Particles from files.
    #[serde(default)]
    pub particles: Vec<Particles>,
    /// Faucets.
    #[serde(default)]
    pub insert: Vec<Insert>,
    /// Walls.
    #[serde(default)]
    pub wall: Vec<Wall>,
    /// Storage planes with their zones.
    #[serde(default)]
    pub outlet: Vec<Outlet>,
    /// Zones that recorded particles enter by.
    #[serde(default)]
    pub inlet: Vec<Inlet>,
}

/// In which precision contacts are computed; places and sums are always double.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Arithmetic {
    /// Double.
    #[default]
    F64,
    /// Single in contacts.
    Mixed,
}

/// `[time]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// End of the run [s]; may come from `--until`.
    pub until: Option<f64>,
    /// Step.
    #[serde(default)]
    pub dt: OrAuto,
    /// Share of the critical step when `dt` is "auto" [–]; absent: [`SAFETY`], or what `accuracy` needs.
    pub safety: Option<f64>,
    /// Largest error of an impact, for which the step is chosen [–].
    pub accuracy: Option<Accuracy>,
}

/// Share of the critical step when the scene says nothing [–].
pub const SAFETY: f64 = 0.5;

/// A share: `"1%"`, or 0.01.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy(pub f64);

impl Default for Time {
    fn default() -> Time {
        Time { until: None, dt: OrAuto::Auto, safety: None, accuracy: None }
    }
}

/// A number, or "auto".
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum OrAuto {
    /// Chosen by the program.
    #[default]
    Auto,
    /// As given.
    Given(f64),
}

/// `[output]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Time between frames; absent: a hundredth of the run.
    pub every: Option<Every>,
    /// Time between checkpoints [s]; absent: one at the end.
    pub checkpoint: Option<f64>,
    /// Whether the force on each wall is written with each frame; walls that follow a force always tell.
    #[serde(default)]
    pub wall_forces: bool,
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

impl Default for Output {
    fn default() -> Output {
        Output {
            every: None,
            checkpoint: None,
            energy: false,
            contacts: false,
            wall_forces: false,
            precision: Precision::F64,
        }
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
    pub speed: f64,
    /// How long it must have been at rest [s].
    #[serde(default = "sleep_time")]
    pub time: f64,
    /// Force that wakes it, over its weight [–].
    #[serde(default = "sleep_wake")]
    pub wake: f64,
}

fn sleep_time() -> f64 {
    0.02
}

fn sleep_wake() -> f64 {
    0.1
}

/// `[domain]`
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// Periodic axes.
    #[serde(default)]
    pub periodic: Vec<Axis>,
    /// Lowest corner [m].
    pub low: Option<[f64; 3]>,
    /// Highest corner [m].
    pub high: Option<[f64; 3]>,
}

/// An axis of space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs)]
pub enum Axis {
    X,
    Y,
    Z,
}

/// `[drag]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drag {
    /// How drag depends on speed.
    pub law: DragLaw,
    /// Viscosity of the fluid [Pa·s].
    pub viscosity: f64,
    /// Density of the fluid [kg/m³]; "stokes" without buoyancy needs none.
    pub density: Option<f64>,
    /// Velocity of the fluid [m/s].
    #[serde(default)]
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
    /// Neighbours are listed up to this gap [m]; absent: chosen.
    pub skin: Option<f64>,
}

/// `[guards]`
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Guards {
    /// Largest overlap, as a share of the smaller radius [–].
    pub overlap: Option<f64>,
    /// Largest motion in one step, as a share of the radius [–].
    pub motion: Option<f64>,
    /// Whether a run stops when a grain of an [[inlet]] goes back through all of its zone; absent: it does.
    pub zones: Option<bool>,
    /// Largest energy that the time step may make, as a share of what was exchanged and moves [–]; absent: not looked at.
    pub energy: Option<f64>,
}

/// `[[material]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Name.
    pub name: String,
    /// Density [kg/m³]; walls need none.
    pub density: Option<f64>,
    /// Young's modulus [Pa].
    pub young: f64,
    /// Poisson's ratio [–].
    pub poisson: f64,
}

/// `[[contact]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Two names of materials; "*" stands for every one.
    pub between: [String; 2],
    /// Normal law.
    #[serde(default)]
    pub law: Law,
    /// k_n of "hooke" [N/m].
    pub stiffness: Option<f64>,
    /// Speed of impact at which "hooke" is as deep as "hertz" [m/s]; in place of `stiffness`.
    pub characteristic_velocity: Option<f64>,
    /// k_t/k_n of "hooke" [–].
    pub tangential_ratio: Option<f64>,
    /// Restitution [–].
    pub restitution: f64,
    /// w of "jkr" [J/m²].
    pub work_of_adhesion: Option<f64>,
    /// Cohesion of "hertz" and "hooke"; absent: none.
    pub cohesion: Option<Cohesion>,
    /// Its energy density [J/m³].
    pub cohesion_energy_density: Option<f64>,
    /// μ [–], or how it depends on speed; absent: frictionless.
    pub sliding_friction: Option<Friction>,
    /// μ_r [–]; absent: none.
    pub rolling_resistance: Option<f64>,
    /// Its model; absent: a spring.
    pub rolling_model: Option<RollingModel>,
    /// μ_w [–]; absent: none.
    pub twisting_resistance: Option<f64>,
}

/// `[[bond]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bond {
    /// Two names of materials.
    pub between: [String; 2],
    /// Largest gap between two surfaces at t = 0 that is bonded [m].
    pub gap: f64,
    /// Radius of a bond over the smaller of both particles' [–]; absent: 1.
    pub radius_ratio: Option<f64>,
    /// Young's modulus of bonds [Pa].
    pub young: f64,
    /// Their Poisson's ratio [–], for the shear modulus.
    pub poisson: f64,
    /// Tension at the rim that breaks one [Pa]; absent: none does.
    pub tensile_strength: Option<f64>,
    /// Shear that breaks one [Pa]; absent: none does.
    pub shear_strength: Option<f64>,
    /// γ of dashpots beside the springs [–]; absent: none.
    pub damping: Option<f64>,
}

/// Normal law of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Law {
    /// Hertz–Mindlin.
    #[default]
    Hertz,
    /// Linear.
    Hooke,
    /// Hertz with adhesion: Johnson, Kendall and Roberts.
    Jkr,
}

/// Model of cohesion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Cohesion {
    /// A pull proportional to the area of contact.
    Sjkr,
}

/// Model of rolling resistance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RollingModel {
    /// A spring and dashpot, capped.
    Spring,
    /// A couple of constant size.
    Constant,
}

/// μ: a number, or a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Friction {
    /// The same at every speed [–].
    Constant(f64),
    /// Weaker the faster the contact slides.
    Weakening(Weakening),
}

/// μ_d + (μ_s − μ_d)/(1 + (v/v_c)²)
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Weakening {
    /// μ_s, at rest [–].
    #[serde(rename = "static")]
    pub at_rest: f64,
    /// μ_d, far above the speed [–].
    pub dynamic: f64,
    /// v_c, at which it is half-way [m/s].
    pub speed: f64,
}

/// One diameter or a range [m].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Diameter {
    /// Smallest [m].
    pub low: f64,
    /// Largest [m].
    pub high: f64,
}

/// `[[clump]]`: `spheres`, or `mesh` with `vertex_radius`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Clump {
    /// Name, that others call it by.
    pub name: String,
    /// Material.
    pub material: String,
    /// x, y, z, radius [m] of each sphere.
    pub spheres: Option<Vec<[f64; 4]>>,
    /// What the mass of spheres is.
    #[serde(default)]
    pub mass: ClumpMass,
    /// A closed surface (PLY): the body; a sphere on each of its vertices.
    pub mesh: Option<String>,
    /// Radius of the spheres on the vertices of `mesh`, before `scale` [m].
    pub vertex_radius: Option<f64>,
    /// Lengths are multiplied by this [–].
    #[serde(default = "one")]
    pub scale: f64,
}

fn one() -> f64 {
    1.0
}

/// Mass, centre and inertia of a clump of spheres.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ClumpMass {
    /// Of the union.
    #[default]
    Union,
    /// Of the sum: where spheres overlap, twice.
    Sum,
}

/// `[[body]]`: one rigid clump.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Name of its `[[clump]]`.
    pub clump: String,
    /// Centre of mass [m].
    pub position: [f64; 3],
    /// Orientation: w, x, y, z.
    #[serde(default = "upright")]
    pub quaternion: [f64; 4],
    /// Velocity of the centre of mass [m/s].
    #[serde(default)]
    pub velocity: [f64; 3],
    /// Angular velocity [rad/s].
    #[serde(default)]
    pub spin: [f64; 3],
    /// Size over that of the clump [–].
    #[serde(default = "one")]
    pub scale: f64,
}

fn upright() -> [f64; 4] {
    [1.0, 0.0, 0.0, 0.0]
}

/// `[[fill]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fill {
    /// Material, unless there is a `clump`.
    #[serde(default)]
    pub material: String,
    /// Name of a `[[clump]]`: bodies in the place of spheres.
    pub clump: Option<String>,
    /// Sizes of bodies over that of the clump, uniform in the range [–].
    pub scale: Option<Diameter>,
    /// Where; spheres lie wholly inside.
    pub shape: String,
    /// Diameters, uniform in the range [m], unless there is a `clump`.
    #[serde(default)]
    pub diameter: Diameter,
    /// Mass [kg]; this or `count`.
    pub mass: Option<f64>,
    /// Number; this or `mass`.
    pub count: Option<u64>,
    /// Velocity at t = 0 [m/s].
    #[serde(default)]
    pub velocity: [f64; 3],
    /// Seed of the random numbers.
    #[serde(default)]
    pub seed: u64,
}

/// `[[particles]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Particles {
    /// CSV, PLY or run MCAP (its last frame).
    pub source: String,
    /// Material of all; needed unless the file is a run, which names its own.
    pub material: Option<String>,
    /// Name of a `[[clump]]`: a body for each row.
    pub clump: Option<String>,
}

/// `[[insert]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Insert {
    /// Material, unless there is a `clump`.
    #[serde(default)]
    pub material: String,
    /// Name of a `[[clump]]`: bodies in the place of spheres.
    pub clump: Option<String>,
    /// Sizes of bodies over that of the clump, uniform in the range [–].
    pub scale: Option<Diameter>,
    /// Cross-section, thicker along the velocity than the largest diameter.
    pub shape: String,
    /// Diameters, uniform in the range [m].
    #[serde(default)]
    pub diameter: Diameter,
    /// Velocity [m/s]; particles keep it until they leave the shape.
    pub velocity: [f64; 3],
    /// Rate [kg/s]; this or `rate_count`.
    pub rate: Option<f64>,
    /// Rate [1/s]; this or `rate`.
    pub rate_count: Option<f64>,
    /// When it opens [s].
    #[serde(default)]
    pub from: f64,
    /// When it closes [s]; absent: never.
    pub until: Option<f64>,
    /// Seed of the random numbers.
    #[serde(default)]
    pub seed: u64,
}

/// `[[wall]]`: one of `source`, `plane`, `mesh`, `box`, or none for walls of the command line.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// Name, for messages.
    pub name: Option<String>,
    /// Wall spheres: a walls MCAP.
    pub source: Option<String>,
    /// Unbounded plane; its normal points to the particles.
    pub plane: Option<String>,
    /// Triangles: a PLY file.
    pub mesh: Option<String>,
    /// Planes that look inward: lowest, highest corner [m].
    #[serde(rename = "box")]
    pub cuboid: Option<[f64; 6]>,
    /// Which faces of the box there are; absent: all six.
    pub faces: Option<Vec<Face>>,
    /// Material; walls of an MCAP name their own.
    pub material: Option<String>,
    /// Motion; absent: at rest.
    pub motion: Option<Motion>,
    /// A force that it follows besides; absent: none.
    pub servo: Option<Servo>,
}

/// A face of a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[allow(missing_docs)]
pub enum Face {
    #[serde(rename = "x-")]
    LowX,
    #[serde(rename = "x+")]
    HighX,
    #[serde(rename = "y-")]
    LowY,
    #[serde(rename = "y+")]
    HighY,
    #[serde(rename = "z-")]
    LowZ,
    #[serde(rename = "z+")]
    HighZ,
}

/// Motion of a wall.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Turn.
    pub rotate: Option<Rotate>,
    /// Shift [m/s].
    pub translate: Option<[f64; 3]>,
    /// Vibration.
    pub vibrate: Option<Vibrate>,
    /// When all of it starts [s].
    #[serde(default)]
    pub from: f64,
    /// When it stops, where the wall is then [s]; absent: never.
    pub until: Option<f64>,
}

/// A force that a wall follows.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Servo {
    /// Which way the wall pushes.
    pub direction: [f64; 3],
    /// Force on the particles [N]; this or `stress`.
    pub force: Option<f64>,
    /// Stress [Pa] on `area`; this or `force`.
    pub stress: Option<f64>,
    /// Area that `stress` acts on [m²].
    pub area: Option<f64>,
    /// Largest speed [m/s].
    pub speed_limit: f64,
}

/// A turn about a fixed axis.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rotate {
    /// Direction of the axis, right-handed.
    pub about: [f64; 3],
    /// A point of the axis [m].
    pub through: [f64; 3],
    /// Turns per minute.
    pub rpm: f64,
}

/// A harmonic vibration.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vibrate {
    /// Amplitude and direction [m].
    pub amplitude: [f64; 3],
    /// Frequency [Hz].
    pub frequency: f64,
}

/// `[[outlet]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outlet {
    /// Storage plane, its normal in the direction of flow.
    pub plane: String,
    /// L1 [m]; "auto" is 1.2 times the largest diameter.
    #[serde(default)]
    pub length: OrAuto,
    /// Motion in the zone.
    #[serde(default)]
    pub motion: ZoneMotion,
    /// What of a grain passes the planes.
    #[serde(default)]
    pub test: ZoneTest,
    /// Time between samples of paths, with motion "recorded" [s]; absent: ten steps.
    pub samples: Option<f64>,
    /// What the stage upstream was cut from (stage-split): goes into the record.
    pub plant: Option<String>,
}

/// `[[inlet]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Inlet {
    /// Calculation plane, its normal in the direction of flow.
    pub plane: String,
    /// L2 [m]; "auto" is what the recorded stream was written with.
    #[serde(default)]
    pub length: OrAuto,
    /// Motion in the zone; absent: that of the stream.
    pub motion: Option<ZoneMotion>,
    /// What of a grain passes the planes; absent: that of the stream.
    pub test: Option<ZoneTest>,
    /// What the stage upstream was cut from (stage-split): a record of another one is refused.
    pub plant: Option<String>,
    /// Inlet MCAP; absent: given on the command line.
    pub source: Option<String>,
}
