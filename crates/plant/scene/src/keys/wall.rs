//! Walls and how they move.

use super::{Place, Placement, Servo, forms, geometry, unit};
use dem::setup::WallShape;
use geom::{Plane, Vec3};
use serde::Deserialize;

/// `[[wall]]`: one of `source`, `plane`, `mesh`, `box`, or none for walls of the command line.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// Name, for messages.
    pub name: Option<String>,
    /// Wall spheres: a walls MCAP.
    pub source: Option<String>,
    /// Unbounded plane; its normal points to the particles.
    #[serde(default, deserialize_with = "geometry::plane")]
    pub plane: Option<String>,
    /// Triangles: a PLY, STL or OBJ file.
    pub mesh: Option<String>,
    /// Surface of a solid: `box:…`, `cylinder:…`, `cone:…` or `sphere:…`.
    #[serde(default, deserialize_with = "geometry::shape")]
    pub solid: Option<String>,
    /// Factor on the lengths in the file of `mesh` or `source` [–]; this or `units`.
    #[serde(default, deserialize_with = "unit::plain")]
    pub scale: Option<f64>,
    /// Unit of the lengths in the file of `mesh` or `source`, such as "mm"; absent: metres.
    pub units: Option<String>,
    /// Planes that look inward: lowest, highest corner [m].
    #[serde(default, rename = "box", deserialize_with = "unit::metres")]
    pub cuboid: Option<[f64; 6]>,
    /// Which faces of the box there are; absent: all six.
    pub faces: Option<Vec<Face>>,
    /// Where it is put, step by step; absent: where it is drawn.
    #[serde(default, deserialize_with = "forms::one_or_more")]
    pub place: Option<Vec<Place>>,
    /// Material; walls of an MCAP name their own.
    pub material: Option<String>,
    /// Motion, or several that act one after the other; absent: at rest.
    #[serde(default, deserialize_with = "forms::one_or_more")]
    pub motion: Option<Vec<Motion>>,
    /// Velocity of its surface, which moves on it as that of a belt [m/s].
    #[serde(default, deserialize_with = "unit::metres_a_second")]
    pub surface_velocity: Option<[f64; 3]>,
    /// Turn of its surface, which moves on it as that of a turntable.
    pub surface_rotation: Option<Rotate>,
    /// A force that it follows in addition; absent: none.
    pub servo: Option<Servo>,
    /// A spring that holds it, so that grains move it; absent: none.
    pub spring: Option<Spring>,
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

impl Face {
    /// All faces.
    pub const ALL: [Face; 6] = [Face::LowX, Face::HighX, Face::LowY, Face::HighY, Face::LowZ, Face::HighZ];

    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        ["x-", "x+", "y-", "y+", "z-", "z+"][self as usize]
    }

    /// Its coordinate along its axis, in a box between two corners [m].
    pub fn coordinate(self, corners: &[f64; 6]) -> f64 {
        corners[self as usize / 2 + 3 * (self as usize % 2)]
    }

    /// Its plane in a box between two corners; the normal points into the box.
    pub fn plane(self, corners: &[f64; 6]) -> Plane {
        let (axis, high) = (self as usize / 2, self as usize % 2);
        let point = Vec3::from_column_slice(&corners[3 * high..3 * high + 3]);
        Plane { point, normal: Vec3::ith(axis, if high == 1 { -1.0 } else { 1.0 }) }
    }
}

impl Wall {
    /// Whether it is a surface that the entry itself describes, not wall spheres.
    pub fn is_surface(&self) -> bool {
        self.plane.is_some() || self.mesh.is_some() || self.cuboid.is_some() || self.solid.is_some()
    }

    /// Factor on the lengths in its file [–]; a name that is no unit of length was refused.
    pub fn length_factor(&self) -> f64 {
        length_factor(self.scale, self.units.as_deref())
    }

    /// The faces of a box with their planes, where they are put; none of other walls.
    pub fn sides(&self) -> Vec<(Face, Plane)> {
        let Some(corners) = self.cuboid else { return Vec::new() };
        let (faces, place) = (self.faces.as_deref().unwrap_or(&Face::ALL), self.placement());
        let put = |plane: Plane| place.map_or(plane, |place| place.plane(&plane));
        faces.iter().map(|face| (*face, put(face.plane(&corners)))).collect()
    }

    /// Where it is put; `None` where it is drawn.
    pub fn placement(&self) -> Option<Placement> {
        Placement::of(self.place.as_deref()?)
    }

    /// The matrix from where its file has a point to where it is, row by row; `None` where both are one.
    pub fn of_file(&self) -> Option<[f64; 16]> {
        let (place, factor) = (self.placement(), self.length_factor());
        (place.is_some() || factor != 1.0).then(|| place.unwrap_or_else(Placement::still).rows(factor))
    }

    /// A surface of it that is drawn like this, where it is put.
    pub fn put(&self, shape: WallShape) -> WallShape {
        match self.placement() {
            Some(place) => place.shape(shape),
            None => shape,
        }
    }
}

/// Factor on the lengths in a file [–], of the keys `scale` and `units`.
pub(super) fn length_factor(scale: Option<f64>, units: Option<&str>) -> f64 {
    scale.or(units.and_then(|name| geom::units::factor(name, "m").ok())).unwrap_or(1.0)
}

/// Motion of a wall.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Turn.
    pub rotate: Option<Rotate>,
    /// Shift [m/s].
    #[serde(default, deserialize_with = "unit::metres_a_second")]
    pub translate: Option<[f64; 3]>,
    /// Vibration.
    pub vibrate: Option<Vibrate>,
    /// Swing about an axis.
    pub swing: Option<Swing>,
    /// A table over time.
    pub path: Option<Path>,
    /// When all of it starts [s].
    #[serde(default, deserialize_with = "unit::seconds")]
    pub from: f64,
    /// When it stops, where the wall is then [s]; absent: never.
    #[serde(default, deserialize_with = "unit::seconds")]
    pub until: Option<f64>,
    /// Time in which it starts, and in which it ends [s].
    #[serde(default, deserialize_with = "unit::seconds")]
    pub ramp: f64,
    /// Time after which it starts again [s]; absent: never.
    #[serde(default, deserialize_with = "unit::seconds")]
    pub repeat: Option<f64>,
}

impl Motion {
    /// When it stops for the first time [s]: what repeats runs for a period at most.
    pub fn ends(&self) -> Option<f64> {
        self.until.or(self.repeat.map(|period| self.from + period))
    }
}

/// A swing about a fixed axis.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Swing {
    /// Direction of the axis, right-handed.
    #[serde(deserialize_with = "unit::plain")]
    pub about: [f64; 3],
    /// A point of the axis [m].
    #[serde(deserialize_with = "unit::metres")]
    pub through: [f64; 3],
    /// Largest angle to either side [rad].
    #[serde(deserialize_with = "unit::radians")]
    pub amplitude: f64,
    /// Frequency [Hz].
    #[serde(deserialize_with = "unit::hertz")]
    pub frequency: f64,
}

/// A motion as a table over time.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Path {
    /// CSV with the columns t [s], x y z [m] and angle [rad].
    pub source: String,
    /// Axis of the column `angle`, right-handed.
    #[serde(default, deserialize_with = "unit::plain")]
    pub about: Option<[f64; 3]>,
    /// A point of the axis [m].
    #[serde(default, deserialize_with = "unit::metres")]
    pub through: Option<[f64; 3]>,
}

/// A spring and a dashpot that hold a wall.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spring {
    /// Direction in which the wall can move.
    #[serde(deserialize_with = "unit::plain")]
    pub direction: [f64; 3],
    /// Of the spring [N/m].
    #[serde(deserialize_with = "unit::newtons_a_metre")]
    pub stiffness: f64,
    /// Of the dashpot [N·s/m].
    #[serde(default, deserialize_with = "unit::newton_seconds_a_metre")]
    pub damping: f64,
    /// Mass of the wall [kg].
    #[serde(deserialize_with = "unit::kilograms")]
    pub mass: f64,
    /// Largest speed [m/s].
    #[serde(deserialize_with = "unit::metres_a_second")]
    pub speed_limit: f64,
}

/// A turn about a fixed axis.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rotate {
    /// Direction of the axis, right-handed.
    #[serde(deserialize_with = "unit::plain")]
    pub about: [f64; 3],
    /// A point of the axis [m].
    #[serde(deserialize_with = "unit::metres")]
    pub through: [f64; 3],
    /// Turns per minute.
    #[serde(deserialize_with = "unit::turns_a_minute")]
    pub rpm: f64,
}

/// A harmonic vibration.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vibrate {
    /// Amplitude and direction [m].
    #[serde(deserialize_with = "unit::metres")]
    pub amplitude: [f64; 3],
    /// Frequency [Hz].
    #[serde(deserialize_with = "unit::hertz")]
    pub frequency: f64,
}
