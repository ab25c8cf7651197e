//! Walls and how they move.

use super::forms::OneOrMore;
use super::table::{table, words};
use super::{Place, Placement, PlaneText, Servo, ShapeText};
use dem::setup::WallShape;
use geom::{Plane, Vec3};

table! {
    /// `[[wall]]`: one of `source`, `plane`, `mesh`, `solid`, `box`, or none for walls of the command line.
    #[derive(Default)]
    Wall section {
        /// Name in messages and output.
        name: Option<String> = absent("\"wall.N\""), "", Name, "\"hopper\"";
        /// Wall spheres (walls MCAP).
        source: Option<String> = absent("–"), "", File, "\"walls.mcap\"";
        /// Unbounded plane `px,py,pz,nx,ny,nz`; the normal points to the grains.
        plane: Option<PlaneText> = absent("–"), "m", Any, "[0, 0, 0, 0, 0, 1]";
        /// Triangles (PLY, STL, OBJ, text).
        mesh: Option<String> = absent("–"), "", File, "\"chute.stl\"";
        /// Surface of a solid: `box:…`, `cylinder:…`, `cone:…` or `sphere:…`; see below.
        solid: Option<ShapeText> = absent("–"), "m", Any, "\"cylinder:0,0,0,0,0,1,0.1\"";
        /// Unit of the lengths in the file of `mesh` or `source`: "µm", "mm", "cm", "m", "km", "in", "ft"; this or `scale`.
        units: Option<String> = absent("\"m\""), "", Any, "\"mm\"";
        /// Factor on the lengths in the file of `mesh` or `source`; this or `units`.
        scale: Option<f64> = absent("1"), "", Positive, "0.001";
        /// Unbounded planes that face inward: x0, y0, z0, x1, y1, z1; see below.
        cuboid as "box": Option<[f64; 6]> = absent("–"), "m", Finite, "[0, 0, 0, 0.1, 0.1, 0.3]";
        /// Which faces of the box exist.
        faces: Option<Vec<Face>> = absent("all six"), "", Any, "[\"x-\", \"z+\"]";
        /// Where the wall is put: a table, or a list of tables; see below.
        place: Option<OneOrMore<Place>> = absent("where it is drawn"), "", Any, "";
        /// Material of the wall; a walls MCAP names its own.
        material: Option<String> = absent("required"), "", Any, "\"steel\"";
        /// How the wall moves: a table, or a list of tables that act one after the other; see below.
        motion: Option<OneOrMore<Motion>> = absent("at rest"), "", Any, "";
        /// A belt: the wall is at rest, and its surface moves with this velocity.
        surface_velocity: Option<[f64; 3]> = absent("none"), "m/s", Finite, "[1, 0, 0]";
        /// A turntable: the wall is at rest, and its surface rotates.
        surface_rotation: Option<Rotate> = absent("none"), "", Any, "";
        /// Follows a force: see below.
        servo: Option<Servo> = absent("none"), "", Any, "";
        /// Is held by a spring, so that grains move it: see below.
        spring: Option<Spring> = absent("none"), "", Any, "";
    }
}

words! {
    /// A face of a box.
    #[allow(missing_docs)]
    Face {
        LowX "x-",
        HighX "x+",
        LowY "y-",
        HighY "y+",
        LowZ "z-",
        HighZ "z+",
    }
}

impl Face {
    /// Its coordinate along its axis, in a box between two corners [m].
    pub fn coordinate(self, corners: &[f64; 6]) -> f64 {
        corners[self as usize / 2 + 3 * (self as usize % 2)]
    }

    /// The name of it in a box of this name.
    pub fn of(self, name: &str) -> String {
        format!("{name} {}", self.name())
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

    /// Its name, as entry `i` of the scene.
    pub fn name_at(&self, i: usize) -> String {
        self.name.clone().unwrap_or_else(|| format!("wall.{i}"))
    }

    /// The names of its surfaces, whose own name is `name`: a box has one for each face.
    pub fn names(&self, name: &str) -> Vec<String> {
        match self.cuboid {
            Some(_) => self.faces().iter().map(|face| face.of(name)).collect(),
            None => vec![name.to_owned()],
        }
    }

    /// The faces of a box.
    fn faces(&self) -> &[Face] {
        self.faces.as_deref().unwrap_or(Face::ALL)
    }

    /// Factor on the lengths in its file [–]; a name that is no unit of length was refused.
    pub fn length_factor(&self) -> f64 {
        length_factor(self.scale, self.units.as_deref())
    }

    /// The faces of a box with their planes, where they are put; none of other walls.
    pub fn sides(&self) -> Vec<(Face, Plane)> {
        let Some(corners) = self.cuboid else { return Vec::new() };
        let (faces, place) = (self.faces(), self.placement());
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

table! {
    /// Motion of a wall.
    #[derive(Default)]
    Motion section {
        /// Rotation; an unbounded plane can rotate about its own normal only.
        rotate: Option<Rotate> = absent("none"), "", Any, "";
        /// Constant velocity.
        translate: Option<[f64; 3]> = absent("none"), "m/s", Finite, "[0.5, 0, 0]";
        /// Harmonic vibration.
        vibrate: Option<Vibrate> = absent("none"), "", Any, "";
        /// Rotation forth and back.
        swing: Option<Swing> = absent("none"), "", Any, "";
        /// A table over time: see below.
        path: Option<Path> = absent("none"), "", Any, "";
        /// Start of the motion. Below 0 it began before the run: the wall starts where it has come to by t = 0, and a warning says so.
        from: f64 = absent("0"), "s", Finite, "2";
        /// End of the motion; the wall then stays where it is.
        until: Option<f64> = absent("never"), "s", Any, "2.4";
        /// Time in which the speed rises from 0 after `from`, and in which it falls to 0 before `until`.
        ramp: f64 = absent("0"), "s", Finite, "0.1";
        /// The motion starts again this long after `from`, and again, each time from where it has come; a `path` then begins again, a `vibrate`
        /// or `swing` goes on in its phase. At least `until` − `from`; a `path` needs no `until`.
        repeat: Option<f64> = absent("never"), "s", Positive, "5";
    }
}

impl Motion {
    /// When it stops for the first time [s]: what repeats runs for a period at most.
    pub fn ends(&self) -> Option<f64> {
        self.until.or(self.repeat.map(|period| self.from + period))
    }
}

table! {
    /// A swing about a fixed axis.
    Swing inline {
        /// Direction of the axis, right-handed.
        about: [f64; 3] = required, "", Finite, "[0, 1, 0]";
        /// A point of the axis.
        through: [f64; 3] = required, "m", Finite, "[0, 0, 0]";
        /// Largest angle to either side.
        amplitude: f64 = required, "rad", Finite, "\"15 deg\"";
        /// Frequency.
        frequency: f64 = required, "Hz", Positive, "0.5";
    }
}

table! {
    /// A motion as a table over time.
    Path inline {
        /// A CSV file with the columns `t` [s], `x`, `y`, `z` [m] and `angle` [rad].
        source: String = required, "", File, "\"path.csv\"";
        /// Axis of the column `angle`, right-handed.
        about: Option<[f64; 3]> = absent("–"), "", Finite, "[0, 1, 0]";
        /// A point of this axis.
        through: Option<[f64; 3]> = absent("–"), "m", Finite, "[0, 0, 0]";
    }
}

table! {
    /// A spring and a dashpot that hold a wall.
    Spring section {
        /// Direction in which the wall can move.
        direction: [f64; 3] = required, "", Finite, "[0, 0, 1]";
        /// Stiffness of the spring.
        stiffness: f64 = required, "N/m", Positive, "1e4";
        /// Of the dashpot.
        damping: f64 = absent("0"), "N·s/m", Within(0.0, 1e12), "100";
        /// Mass of the wall.
        mass: f64 = required, "kg", Positive, "5";
        /// Largest speed that is expected; a faster wall stops the run.
        speed_limit: f64 = required, "m/s", Positive, "1";
    }
}

table! {
    /// A rotation about a fixed axis.
    Rotate inline {
        /// Direction of the axis, right-handed.
        about: [f64; 3] = required, "", Finite, "[0, 0, 1]";
        /// A point of the axis.
        through: [f64; 3] = required, "m", Finite, "[0, 0, 0]";
        /// Turns per minute.
        rpm: f64 = required, "rpm", Finite, "8";
    }
}

table! {
    /// A harmonic vibration.
    Vibrate inline {
        /// Amplitude and direction.
        amplitude: [f64; 3] = required, "m", Finite, "[0, 0, 0.001]";
        /// Frequency.
        frequency: f64 = required, "Hz", Positive, "50";
    }
}
