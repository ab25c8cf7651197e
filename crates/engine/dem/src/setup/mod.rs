//! What a simulation is made of: plain data, checked and resolved by [`crate::Simulation::new`].
//!
//! [`Setup::default`] is an empty scene with gravity; a contact law is a table of models and numbers under their keys
//! ([`ContactLaw`]).

pub mod bond;
pub mod clump_shape;
pub mod clumps;
pub mod earlier_contacts;
mod mount;
mod removal;
mod servo;
mod step;
mod strain;
mod zone;

pub use crate::setup::bond::{
    Bond, BondKind, BondNumbers, BondSprings, BondStrength, Clusters, Spread, cluster_of,
};
pub use crate::setup::clump_shape::ClumpShape;
pub use earlier_contacts::{KeptContact, KeptPartner};
pub use laws::effects::{ContactHistory, ContactLaw, Material};
pub use laws::simd::number::Precision;
pub use laws::slowing::fluid::{Drag, DragLaw};
pub use mount::Mount;
pub use removal::{Removal, Removed};
pub use servo::{Length, Servo, Target};
pub use step::{Sampling, Step, WallDetail};
pub use strain::Strain;
pub use zone::{
    Crossing, CrossingBond, Entry, EntryBonds, EntryClump, Guide, PairHistory, PathSample, Sample, Touch,
    WhenBlocked, Zone, ZoneMotion, ZoneTest,
};

pub use geom::Motion;
pub use geom::motion::SurfaceMotion;

use geom::mesh::TriMesh;
use geom::{Plane, Vec3};
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

/// Everything that a run needs. SI units throughout.
#[derive(Debug, Clone)]
pub struct Setup {
    /// Acceleration of free fall [m/s²].
    pub gravity: Vec3,
    /// The fluid around the particles; `None`: none.
    pub drag: Option<Drag>,
    /// α of local damping [–] ([`crate::passes::local_damping`] says how); `None`: none.
    pub local_damping: Option<f64>,
    /// Materials, by index.
    pub materials: Vec<Material>,
    /// Laws of contact between pairs of materials; a pair that can meet must have one.
    pub contacts: Vec<ContactLaw>,
    /// Particles at t = 0.
    pub particles: Vec<Particle>,
    /// Histories of their contacts at t = 0, of particles that an earlier run has left; empty: all contacts begin without history.
    pub kept: Vec<KeptContact>,
    /// Rigid clumps; empty where the scene has none.
    pub clumps: Clumps,
    /// Bonds between particles that are close to each other; empty where the scene has none.
    pub bonds: Vec<Bond>,
    /// Clusters of particles by id, in their order; those that are not listed have none.
    pub clusters: Vec<(u32, u32)>,
    /// Bonds that inlets may bring, of which `bonds` is not empty then; `None`: they bring none.
    pub entry_bonds: Option<EntryBonds>,
    /// Walls: they act on particles and are not moved by them.
    pub walls: Vec<Wall>,
    /// Storage planes with their zones (JP5440448B2).
    pub outlets: Vec<Zone>,
    /// Regions that free particles are taken out of.
    pub removals: Vec<Removal>,
    /// Zones that particles enter by; `Entry::inlet` is an index of this list.
    pub inlets: Vec<Zone>,
    /// Largest radius [m] that inlets will bring; 0 when there is none.
    pub largest_entry: f64,
    /// Smallest radius [m] that inlets will bring; 0 when there is none.
    pub smallest_entry: f64,
    /// Materials that inlets will bring.
    pub entry_materials: Vec<u16>,
    /// Time step [s], or the share of the critical one.
    pub step: Step,
    /// Periodic extent (lowest, highest) [m] along x, y, z; `None` along an open axis.
    pub periodic: [Option<(f64, f64)>; 3],
    /// What periodic axes follow; an axis without it keeps its length.
    pub strain: [Option<Strain>; 3],
    /// Which part of a step the force of a contact stands for.
    pub sampling: Sampling,
    /// Whether the spheres of a wall that a grain touches at once act as one contact ([`laws::contact::patch`]); else each acts by itself.
    pub patches: bool,
    /// In which precision contacts are computed.
    pub precision: Precision,
    /// Neighbours are listed up to this gap [m]; `None` chooses.
    pub skin: Option<f64>,
    /// When particles at rest are passed over; `None`: never.
    pub sleep: Option<Sleep>,
    /// Whether the energy ledger is kept (it costs time).
    pub ledger: bool,
    /// Whether the wrench of each contact is kept when a run is observed: 64 bytes a contact that only
    /// [`crate::Simulation::record_contacts`] and [`crate::Simulation::wall_forces`] want.
    pub record_wrenches: bool,
    /// Whether the sliding work of contacts that are no longer listed is held until [`crate::Simulation::record_contacts`] takes it; with the ledger.
    pub record_sliding: bool,
    /// What is added up of walls over every step, until [`crate::Simulation::take_wall_sums`] takes it.
    pub wall_sums: WallDetail,
    /// When a run is stopped.
    pub guards: Guards,
}

/// Nothing but gravity, the automatic step at a fifth of the critical one, and the usual guards.
impl Default for Setup {
    fn default() -> Setup {
        Setup {
            gravity: Vec3::new(0.0, 0.0, -9.81),
            drag: None,
            local_damping: None,
            materials: Vec::new(),
            contacts: Vec::new(),
            particles: Vec::new(),
            kept: Vec::new(),
            clumps: Clumps::default(),
            bonds: Vec::new(),
            clusters: Vec::new(),
            entry_bonds: None,
            walls: Vec::new(),
            outlets: Vec::new(),
            removals: Vec::new(),
            inlets: Vec::new(),
            largest_entry: 0.0,
            smallest_entry: 0.0,
            entry_materials: Vec::new(),
            step: Step::Auto(0.2),
            periodic: [None; 3],
            strain: [const { None }; 3],
            sampling: Sampling::default(),
            patches: true,
            precision: Precision::Double,
            skin: None,
            sleep: None,
            ledger: false,
            record_wrenches: true,
            record_sliding: false,
            wall_sums: WallDetail::Off,
            guards: Guards::default(),
        }
    }
}

/// A sphere.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Particle {
    /// Unique number.
    pub id: u32,
    /// Index of its material.
    pub material: u16,
    /// Radius [m].
    pub radius: f64,
    /// Centre [m].
    pub position: Vec3,
    /// Velocity of the centre [m/s].
    pub velocity: Vec3,
    /// Angular velocity [rad/s].
    pub spin: Vec3,
}

/// Rigid clumps: their shapes, and the clumps of these shapes at t = 0.
#[derive(Debug, Clone, Default)]
pub struct Clumps {
    /// Shapes.
    pub shapes: Vec<ClumpShape>,
    /// Clumps at t = 0.
    pub placed: Vec<Body>,
    /// Scales of the clumps that inlets will bring.
    pub entries: Vec<ClumpScales>,
}

/// The scales of clumps of one shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClumpScales {
    /// Index of the shape.
    pub shape: u32,
    /// Smallest size over that of the shape [–].
    pub least: f64,
    /// Largest size over that of the shape [–].
    pub most: f64,
}

/// A rigid clump. Its members have the ids from `id` on, one each.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// Id of its first member.
    pub id: u32,
    /// Index of its shape.
    pub shape: u32,
    /// Size over that of the shape [–].
    pub scale: f64,
    /// Centre of mass [m].
    pub position: Vec3,
    /// From the frame that the shape was given in to space.
    pub orientation: UnitQuaternion<f64>,
    /// Velocity of the centre of mass [m/s].
    pub velocity: Vec3,
    /// Angular velocity [rad/s].
    pub spin: Vec3,
}

/// A wall: a shape that moves as one rigid body, as its motion prescribes and by as much as its servo has moved it.
#[derive(Debug, Clone)]
pub struct Wall {
    /// Name, for messages and reports.
    pub name: String,
    /// Index of its material.
    pub material: u16,
    /// Where its surface is at t = 0.
    pub shape: WallShape,
    /// Prescribed motion.
    pub motion: Motion,
    /// How its surface moves on it, as that of a belt.
    pub surface: SurfaceMotion,
    /// A force that it follows besides.
    pub servo: Option<Servo>,
    /// A spring that holds it; not with a servo.
    pub mount: Option<Mount>,
}

impl Wall {
    /// A wall at rest.
    pub fn new(name: impl Into<String>, material: u16, shape: WallShape) -> Wall {
        Wall {
            name: name.into(),
            material,
            shape,
            motion: Motion::still(),
            surface: SurfaceMotion::still(),
            servo: None,
            mount: None,
        }
    }

    /// Whether its place changes; that of a belt does not.
    pub fn moves(&self) -> bool {
        self.motion.moves() || self.servo.is_some() || self.mount.is_some()
    }
}

/// The surface of a wall.
#[derive(Debug, Clone)]
pub enum WallShape {
    /// Wall spheres: centre [m], radius [m].
    Spheres(Vec<(Vec3, f64)>),
    /// An unbounded plane; particles are on the side that the normal points to.
    Plane(Plane),
    /// Triangles; both sides act.
    Mesh(TriMesh),
}

/// One element of a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WallElement {
    /// A wall sphere: centre [m], radius [m].
    Sphere(Vec3, f64),
    /// The whole plane.
    Plane(Plane),
    /// Corners of a triangle [m].
    Triangle([Vec3; 3]),
}

impl WallShape {
    /// Its elements in the order in which the engine counts them.
    pub fn elements(&self) -> Vec<WallElement> {
        match self {
            WallShape::Spheres(spheres) => {
                let order = crate::space::wall_sphere_order::order_of_spheres(spheres);
                let of = |&k: &u32| spheres[k as usize];
                order.iter().map(of).map(|(centre, radius)| WallElement::Sphere(centre, radius)).collect()
            }
            WallShape::Plane(plane) => vec![WallElement::Plane(*plane)],
            WallShape::Mesh(mesh) => mesh.triangles().map(WallElement::Triangle).collect(),
        }
    }
}

/// When particles sleep ([`crate::passes::sleep`] says what that does).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sleep {
    /// Speed of the surface, |v| + r|ω|, below which a particle is at rest [m/s].
    pub speed: f64,
    /// How long it must have been [s].
    pub time: f64,
    /// Force that wakes it, over its weight [–].
    pub wake: f64,
}

/// What becomes of a particle that came in by a cut and has gone back through its whole zone, to where nothing of the plant is simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum CameBack {
    /// It stops the run.
    #[default]
    Stops,
    /// It is taken out and counted; so is one that is behind the calculation plane and in the way of a particle that comes in.
    IsRemoved,
    /// It moves on.
    Stays,
}

/// When a run is stopped.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Guards {
    /// Largest overlap, as a share of the smaller radius [–].
    pub overlap: f64,
    /// Largest motion in one step, as a share of the radius [–].
    pub motion: f64,
    /// How many inlets, from the first on, are cuts of a plant: grains that go back through them are counted [–].
    pub cuts: u32,
    /// What becomes of a grain that goes back through the whole zone of a cut.
    pub zones: CameBack,
    /// Largest energy that the finite time step may make, as a share of what was exchanged and the most that moved or was in springs [–]; ∞: not checked. It
    /// needs the ledger.
    pub energy: f64,
}

impl Default for Guards {
    fn default() -> Guards {
        Guards { overlap: 0.25, motion: 0.25, energy: f64::INFINITY, cuts: 0, zones: CameBack::Stops }
    }
}
