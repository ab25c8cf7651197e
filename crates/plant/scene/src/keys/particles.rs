//! Particles: where they are, come from, and leave.

use super::{OrAuto, geometry, unit};
use dem::setup::{ZoneMotion, ZoneTest};
use serde::Deserialize;

/// One diameter or a range [m].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Diameter {
    /// Smallest [m].
    pub low: f64,
    /// Largest [m].
    pub high: f64,
}

/// What shares of sizes are of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ShareOf {
    /// Of mass, as sieves tell.
    #[default]
    Mass,
    /// Of number.
    Number,
}

/// `[[clump]]`: `spheres`, or `mesh` with `vertex_radius`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Clump {
    /// Name, by which other entries name it.
    pub name: String,
    /// Material.
    pub material: String,
    /// x, y, z, radius [m] of each sphere.
    #[serde(default, deserialize_with = "unit::metres")]
    pub spheres: Option<Vec<[f64; 4]>>,
    /// How the mass of overlapping spheres is computed.
    #[serde(default)]
    pub mass: ClumpMass,
    /// A closed surface (PLY): the body; a sphere on each of its vertices.
    pub mesh: Option<String>,
    /// Radius of the spheres on the vertices of `mesh`, before `scale` [m].
    #[serde(default, deserialize_with = "unit::metres")]
    pub vertex_radius: Option<f64>,
    /// With `mesh`: its vertices are thinned to those of a mesh of so many faces.
    pub faces: Option<u32>,
    /// With `spheres`: volume, centre and inertia of the true body, in the frame of the spheres and before `scale`.
    pub moments: Option<ClumpMoments>,
    /// Lengths are multiplied by this [–].
    #[serde(default = "one", deserialize_with = "unit::plain")]
    pub scale: f64,
}

/// `[[clump]] moments`: a body of density 1.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClumpMoments {
    /// Volume [m³].
    #[serde(deserialize_with = "unit::cubic_metres")]
    pub volume: f64,
    /// Centre of mass [m].
    #[serde(deserialize_with = "unit::metres")]
    pub centre: [f64; 3],
    /// Terms xx, yy, zz, xy, xz, yz of the inertia tensor of density 1 about the centre of mass [m⁵].
    #[serde(deserialize_with = "unit::plain")]
    pub inertia: [f64; 6],
}

impl ClumpMoments {
    /// The inertia tensor of density 1 [m⁵].
    pub fn tensor(&self) -> nalgebra::Matrix3<f64> {
        let [xx, yy, zz, xy, xz, yz] = self.inertia;
        nalgebra::Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }
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
    #[serde(deserialize_with = "unit::metres")]
    pub position: [f64; 3],
    /// Orientation: w, x, y, z.
    #[serde(default = "upright", deserialize_with = "unit::plain")]
    pub quaternion: [f64; 4],
    /// Velocity of the centre of mass [m/s].
    #[serde(default, deserialize_with = "unit::metres_a_second")]
    pub velocity: [f64; 3],
    /// Angular velocity [rad/s].
    #[serde(default, deserialize_with = "unit::radians_a_second")]
    pub spin: [f64; 3],
    /// Size over that of the clump [–].
    #[serde(default = "one", deserialize_with = "unit::plain")]
    pub scale: f64,
}

fn upright() -> [f64; 4] {
    [1.0, 0.0, 0.0, 0.0]
}

/// Lattices of equal spheres that touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Lattice {
    /// Six neighbours.
    Cubic,
    /// Twelve neighbours: layers of hexagons (hexagonal close packing).
    Hexagonal,
}

/// `[[particles]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Particles {
    /// CSV, PLY or run MCAP (its last frame).
    pub source: String,
    /// Material of all; needed unless the file is a run, which names its own.
    pub material: Option<String>,
    /// Name of a `[[clump]]`: a clump for each row.
    pub clump: Option<String>,
    /// Whether they stay where they are: spheres of a wall.
    #[serde(default)]
    pub fixed: bool,
    /// Factor on the lengths in the file: positions, radii and velocities [–]; this or `units`.
    #[serde(default, deserialize_with = "unit::plain")]
    pub scale: Option<f64>,
    /// Unit of the lengths in the file, such as "mm"; absent: metres.
    pub units: Option<String>,
    /// Cluster of all; absent: that of each row, if the file has them.
    pub cluster: Option<u32>,
    /// Materials by the number in the column `material` of a CSV or PLY, from 0.
    pub materials: Option<Vec<String>>,
}

impl Particles {
    /// Factor on the lengths in its file [–].
    pub fn length_factor(&self) -> f64 {
        super::wall::length_factor(self.scale, self.units.as_deref())
    }
}

/// `[[outlet]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outlet {
    /// Storage plane, its normal in the direction of flow.
    #[serde(deserialize_with = "geometry::plane")]
    pub plane: String,
    /// L1 [m]; "auto" is 1.2 times the largest diameter.
    #[serde(default, deserialize_with = "unit::metres")]
    pub length: OrAuto,
    /// Motion in the zone.
    #[serde(default)]
    pub motion: ZoneMotion,
    /// Which point of a particle crosses the planes.
    #[serde(default)]
    pub test: ZoneTest,
    /// Time between samples of paths, with motion "recorded" [s]; absent: ten steps.
    #[serde(default, deserialize_with = "unit::seconds")]
    pub samples: Option<f64>,
    /// Mark of the plant that the stage upstream was cut from (stage-split); it goes into the record.
    pub plant: Option<String>,
}

/// `[[inlet]]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Inlet {
    /// Calculation plane, its normal in the direction of flow.
    #[serde(deserialize_with = "geometry::plane")]
    pub plane: String,
    /// L2 [m]; "auto" is what the recorded stream was written with.
    #[serde(default, deserialize_with = "unit::metres")]
    pub length: OrAuto,
    /// Motion in the zone; absent: that of the stream.
    pub motion: Option<ZoneMotion>,
    /// Which point of a particle crosses the planes; absent: that of the stream.
    pub test: Option<ZoneTest>,
    /// Mark of the plant that the stage upstream was cut from (stage-split); a record of another plant is refused.
    pub plant: Option<String>,
    /// Inlet MCAP; absent: given on the command line.
    pub source: Option<String>,
}
