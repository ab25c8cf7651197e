//! Planes with regions in which particles move by a prescribed motion, and what passes them.

use crate::setup::{BondNumbers, Particle};
use geom::{Plane, Vec3};
use laws::effects::ContactHistory;
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

/// A plane with a region behind it in which particles move by a prescribed motion.
///
/// Outlet: `plane` is the storage plane, the exclusion plane lies `length` further along the normal.
/// Inlet: `plane` is the calculation plane, the generation plane lies `length` before it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Zone {
    /// The plane; its normal is the direction of flow.
    pub plane: Plane,
    /// L1 or L2 [m]; longer than the largest particle diameter.
    pub length: f64,
    /// The prescribed motion.
    #[serde(default)]
    pub motion: ZoneMotion,
    /// What of a particle must be past a plane for it to have passed.
    #[serde(default)]
    pub test: ZoneTest,
    /// Inlet: what becomes of a particle whose place is taken; `None`, as behind a cut of a plant: it comes in all the same, and keeps its motion whatever it meets.
    #[serde(default)]
    pub when_blocked: Option<WhenBlocked>,
}

/// What becomes of a particle that is inserted where there is no room for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum WhenBlocked {
    /// It comes in later, at its place, when that is free.
    #[default]
    Wait,
    /// It does not come in, and is counted.
    Skip,
    /// The run stops.
    Stop,
}

impl WhenBlocked {
    /// All there are.
    pub const ALL: [WhenBlocked; 3] = [WhenBlocked::Wait, WhenBlocked::Skip, WhenBlocked::Stop];

    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        match self {
            WhenBlocked::Wait => "wait",
            WhenBlocked::Skip => "skip",
            WhenBlocked::Stop => "stop",
        }
    }
}

/// How particles move in a zone, τ [s] after they were at x₀ with the velocity v₀.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ZoneMotion {
    /// x = x₀ + v₀ τ.
    #[default]
    Constant,
    /// x = x₀ + v₀ τ + ½ g τ²: free fall, without the fluid.
    Ballistic,
    /// Outlet: none, particles stay free, and the paths of those are recorded that come near the storage plane. Inlet: along these paths.
    Recorded,
}

/// What of a particle is tested against the planes of a zone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ZoneTest {
    /// Its centre; of a rigid clump, the centre of mass.
    #[default]
    Centre,
    /// The point of its surface that is foremost along the plane's normal: where the flow goes down, its lowest point.
    Lowest,
}

impl ZoneMotion {
    /// All there are.
    pub const ALL: [ZoneMotion; 3] = [ZoneMotion::Constant, ZoneMotion::Ballistic, ZoneMotion::Recorded];

    /// Its name in scenes and records.
    pub fn name(self) -> &'static str {
        match self {
            ZoneMotion::Constant => "constant",
            ZoneMotion::Ballistic => "ballistic",
            ZoneMotion::Recorded => "recorded",
        }
    }
}

impl ZoneTest {
    /// All there are.
    pub const ALL: [ZoneTest; 2] = [ZoneTest::Centre, ZoneTest::Lowest];

    /// Its name in scenes and records.
    pub fn name(self) -> &'static str {
        match self {
            ZoneTest::Centre => "centre",
            ZoneTest::Lowest => "lowest",
        }
    }
}

impl Zone {
    /// A zone of constant velocity in which centres are tested.
    pub fn new(plane: Plane, length: f64) -> Zone {
        Zone { plane, length, motion: ZoneMotion::Constant, test: ZoneTest::Centre, when_blocked: None }
    }

    /// What is tested of a sphere lies this far before its centre [m].
    pub fn lead(&self, radius: f64) -> f64 {
        match self.test {
            ZoneTest::Centre => 0.0,
            ZoneTest::Lowest => radius,
        }
    }

    /// How far what is tested of a sphere is past the plane [m].
    pub fn past(&self, centre: &Vec3, radius: f64) -> f64 {
        self.plane.signed_distance(centre) + self.lead(radius)
    }

    /// Acceleration [m/s²] of what moves in it, unless it follows a path.
    pub fn acceleration(&self, gravity: &Vec3) -> Vec3 {
        match self.motion {
            ZoneMotion::Constant => Vec3::zeros(),
            ZoneMotion::Ballistic | ZoneMotion::Recorded => *gravity,
        }
    }

    /// Time [s] that it takes from `past` [m] (below 0) to the plane, with a velocity [m/s]; `None`: it never gets there.
    pub fn arrives_after(&self, past: f64, velocity: &Vec3, gravity: &Vec3) -> Option<f64> {
        let (v, a) = (velocity.dot(&self.plane.normal), self.acceleration(gravity).dot(&self.plane.normal));
        let way = (-past).max(0.0);
        // ½ a τ² + v τ = way, the first time; written so that nothing cancels.
        let root = (v * v + 2.0 * a * way).sqrt();
        let time = if v >= 0.0 { 2.0 * way / (v + root) } else { (root - v) / a };
        (time >= 0.0 && time.is_finite() && (v > 0.0 || a > 0.0)).then_some(time)
    }
}

/// A particle that will enter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// When it is at `particle.position`, on the generation plane [s].
    pub time: f64,
    /// Which inlet.
    pub inlet: u32,
    /// State at that time; from it, the zone's motion leads to the calculation plane. Of a rigid clump: id of its first member, centre of
    /// mass, the sphere that holds it, and the angular velocity that it keeps up to the calculation plane.
    pub particle: Particle,
    /// What makes it a rigid clump.
    pub clump: Option<EntryClump>,
    /// Of a sphere that may be bonded: how it has turned by then since that was so; `None`: not at all.
    pub turn: Option<UnitQuaternion<f64>>,
    /// Its cluster; 0: none.
    pub cluster: u32,
}

/// The shape of an entry or a crossing that is a rigid clump.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EntryClump {
    /// Index of its shape.
    pub shape: u32,
    /// Size over that of the shape [–].
    pub scale: f64,
    /// From the frame that the shape was given in to space.
    pub orientation: UnitQuaternion<f64>,
}

impl EntryClump {
    /// Turned about a vector by its length [rad].
    pub fn turned(&self, by: &Vec3) -> EntryClump {
        EntryClump { orientation: crate::space::rotation::spun(by) * self.orientation, ..*self }
    }
}

/// State of a particle at a time of its path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// [s].
    pub time: f64,
    /// Centre [m].
    pub position: Vec3,
    /// [m/s].
    pub velocity: Vec3,
    /// [rad/s].
    pub spin: Vec3,
    /// As in [`Entry`]; of a rigid clump, its orientation.
    pub turn: Option<UnitQuaternion<f64>>,
}

impl Sample {
    /// Of an entry.
    pub fn of(entry: &Entry) -> Sample {
        let (p, time) = (&entry.particle, entry.time);
        let turn = entry.turn.or(entry.clump.map(|c| c.orientation));
        Sample { time, position: p.position, velocity: p.velocity, spin: p.spin, turn }
    }
}

/// News of a particle on its way in along a recorded path, that begins with its [`Entry`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Guide {
    /// It is there then.
    At(Sample),
    /// It is there then, and free from then on.
    Free(Sample),
    /// It goes back upstream: it is out of the calculation after the sample before.
    Gone,
}

/// A particle near a storage plane, now.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PathSample {
    /// Which outlet.
    pub outlet: u32,
    /// Its state.
    pub particle: Particle,
    /// What makes it a rigid clump.
    pub clump: Option<EntryClump>,
    /// How a sphere has turned, where there are bonds.
    pub turn: Option<UnitQuaternion<f64>>,
    /// Its cluster; 0: none.
    pub cluster: u32,
    /// Whether it has gone back upstream, out of reach of the plane.
    pub gone: bool,
}

/// A particle that has passed a storage plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Crossing {
    /// Passage time, interpolated within the step [s].
    pub time: f64,
    /// Which outlet.
    pub outlet: u32,
    /// State at that time (what is tested of it lies on the plane). Of a rigid clump: id of its first member, centre of mass, and the
    /// sphere that holds it.
    pub particle: Particle,
    /// What makes it a rigid clump.
    pub clump: Option<EntryClump>,
    /// How it has turned by then, where there are bonds.
    pub turn: Option<UnitQuaternion<f64>>,
    /// Its cluster; 0: none.
    pub cluster: u32,
    /// Its contacts, or those of all members.
    pub touching: Vec<Touch>,
    /// Its bonds that are whole.
    pub bonds: Vec<CrossingBond>,
}

/// A bond of a particle that crosses, or of two that come in.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CrossingBond {
    /// Id of the particle that crosses, or of one that comes in.
    pub id: u32,
    /// Id of the other.
    pub partner: u32,
    /// What makes it, of which `id` is the first end.
    pub bond: BondNumbers,
}

/// What bonds inlets may bring.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EntryBonds {
    /// Critical step of those bonds alone [s].
    pub step: f64,
    /// Length of the longest at rest [m].
    pub longest: f64,
}

impl EntryBonds {
    /// What holds for both.
    pub fn union(a: Option<EntryBonds>, b: Option<EntryBonds>) -> Option<EntryBonds> {
        match (a, b) {
            (Some(a), Some(b)) => {
                Some(EntryBonds { step: a.step.min(b.step), longest: a.longest.max(b.longest) })
            }
            _ => a.or(b),
        }
    }
}

/// One contact of a crossing.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Touch {
    /// Id of the particle that crosses, or of its member.
    pub id: u32,
    /// Id of the other particle; `None` for a wall.
    pub partner: Option<u32>,
    /// Normal force on the crossing particle [N].
    pub normal: Vec3,
    /// Tangential force on the crossing particle [N].
    pub tangential: Vec3,
    /// Its history.
    pub history: ContactHistory,
}

/// History that the contact of two that come in takes once the first of them is free.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PairHistory {
    /// Id of the one that is free first.
    pub id: u32,
    /// Id of the other.
    pub partner: u32,
    /// As `id` sees it.
    pub history: ContactHistory,
}
