//! How a measure tells what it is, what it can be asked, and how it is made.

use crate::profile::Turn;
use crate::{MeasureError, Observer, Which};
use geom::{Plane, Shape, Vec3};

/// A measure, as programs offer it.
pub trait Measure {
    /// Its name; its option is `--NAME`.
    const NAME: &'static str;
    /// What it measures, in one line.
    const HELP: &'static str;
    /// What must be given with its option.
    const ARGUMENT: ArgumentKind = ArgumentKind::None;
    /// Which frames it sees.
    const FRAMES: Frames;
    /// Options of how to measure that it takes, without dashes.
    const OPTIONS: &'static [&'static str] = &[];
    /// Its named results.
    const FIGURES: &'static [Figure] = &[];

    /// The measure with what was asked.
    ///
    /// # Errors
    /// Settings that it cannot have.
    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError>;
}

/// A named result, as `cost-curve --measure` takes it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Figure {
    pub name: &'static str,
    /// The value of the summary, or the column, that holds it.
    pub value: &'static str,
    /// Whether it is a column: a number for each row instead of one.
    pub is_column: bool,
}

/// One number of a run.
pub(crate) const fn number(name: &'static str, value: &'static str) -> Figure {
    Figure { name, value, is_column: false }
}

/// A number for each row.
pub(crate) const fn column(name: &'static str, value: &'static str) -> Figure {
    Figure { name, value, is_column: true }
}

/// What an option of a measure must be given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ArgumentKind {
    /// Nothing.
    None,
    /// A plane, called `PLANE` in the help.
    Plane,
    /// An axis through a point, up along it: `AXIS`.
    Axis,
    /// A shape: `SHAPE`.
    Shape,
    /// A shape whose volume is needed: `SHAPE`.
    Room,
    /// Ids of particles: `ID,ID,…`.
    Ids,
    /// A side of the domain: `SIDE`.
    Side,
}

impl ArgumentKind {
    /// What the help calls it.
    pub fn value_name(self) -> Option<&'static str> {
        match self {
            ArgumentKind::None => None,
            ArgumentKind::Plane => Some("PLANE"),
            ArgumentKind::Axis => Some("AXIS"),
            ArgumentKind::Shape | ArgumentKind::Room => Some("SHAPE"),
            ArgumentKind::Ids => Some("ID,ID,…"),
            ArgumentKind::Side => Some("SIDE"),
        }
    }
}

/// Which frames a measure sees when none are chosen, and which can be chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frames {
    /// The last one; others, or several, can be chosen.
    Last,
    /// One, the last where no other is chosen.
    One,
    /// Every one; one can be chosen.
    Every,
    /// Every one from a time to a time.
    OverTime,
    /// All: what is counted are events with times of their own.
    Events,
}

impl Frames {
    /// Whether one frame, such as the last, can be chosen.
    pub fn has_single(self) -> bool {
        matches!(self, Frames::Last | Frames::One | Frames::Every)
    }
}

/// A shape and its text.
#[derive(Debug, Clone)]
pub struct GivenShape {
    /// As given.
    pub text: String,
    pub shape: Shape,
}

/// Numbers of bins.
#[derive(Debug, Clone, Copy)]
pub enum Bins {
    /// Along the axis.
    One(usize),
    /// Along x, y, z.
    All([usize; 3]),
}

/// What was given with the option of a measure.
#[derive(Debug, Clone)]
pub enum Argument {
    /// Nothing.
    None,
    /// A plane, or an axis.
    Plane(Plane),
    Shape(GivenShape),
    /// Ids of particles.
    Ids(Vec<u64>),
    /// A side of the domain.
    Side(Vec3),
}

/// The corners [m] of the box around all particles of chosen frames, along axes that may be turned; `None`: unknown before the run is measured.
pub type BoxOf<'a> = &'a dyn Fn(Which, Option<Turn>) -> Result<Option<(Vec3, Vec3)>, MeasureError>;

/// What was asked of a measure. Options that it does not take are `None`.
pub struct Asked<'a> {
    /// What was given with its option.
    pub argument: Argument,
    /// The volume [m³] of that, where [`ArgumentKind::Room`] asks for it and its file tells it; else NaN.
    pub volume: f64,
    /// The frames that it will see.
    pub which: Which,
    /// Time between which events count [s].
    pub between: (f64, f64),
    /// Looks at the frames before they are measured.
    pub box_of: BoxOf<'a>,
    pub up: Option<Vec3>,
    /// Number of sectors or lanes.
    pub sectors: Option<usize>,
    /// Radius of the outermost ring [m].
    pub outer: Option<f64>,
    /// Shares of a height or a length between which a line is fitted [–].
    pub fractions: Option<[f64; 2]>,
    /// Width of the bins of a profile [m].
    pub bin: Option<f64>,
    /// Height of the ground [m].
    pub ground: Option<f64>,
    /// The side at which a heap leans on a wall.
    pub side: Option<Vec3>,
    /// Only what this holds.
    pub within: Option<GivenShape>,
    /// Length of the spans of time [s].
    pub span: Option<f64>,
    /// Axis of the bins: 0, 1, 2 for x, y, z.
    pub axis: Option<usize>,
    pub bins: Option<Bins>,
    /// How the axes of the grid are turned.
    pub turn: Option<Turn>,
    /// Whether one profile is averaged over the frames.
    pub mean: bool,
    /// More columns of particles.
    pub fields: Vec<String>,
    /// Side of the cells [m].
    pub cell: Option<f64>,
    /// The size that divides two kinds [m].
    pub split: Option<f64>,
    /// The material of the first kind.
    pub kind: Option<String>,
    /// Openings of the sieves [m].
    pub sieves: Option<Vec<f64>>,
    /// The wall that counts, by name or index.
    pub wall: Option<String>,
    /// Worn volume per sliding work [m³/J]: of a material by name, or of all.
    pub wear_coefficients: Vec<(Option<String>, f64)>,
    /// Thickness of walls [m].
    pub thickness: Option<f64>,
    /// Whether forces on walls are meant.
    pub on_walls: bool,
    /// Whether forces are those of the instants of frames, not means over the steps between them.
    pub instants: bool,
}

impl Asked<'_> {
    /// The shape of [`Asked::within`].
    pub fn shape_within(&self) -> Option<Shape> {
        self.within.as_ref().map(|given| given.shape.clone())
    }

    /// The plane or the axis that was given.
    ///
    /// # Errors
    /// Something else was given.
    pub fn plane(&self) -> Result<Plane, AskError> {
        if let Argument::Plane(plane) = self.argument {
            Ok(plane)
        } else {
            Err(AskError::Argument("a plane"))
        }
    }

    /// The shape that was given.
    ///
    /// # Errors
    /// Something else was given.
    pub fn shape(&self) -> Result<&GivenShape, AskError> {
        if let Argument::Shape(given) = &self.argument {
            Ok(given)
        } else {
            Err(AskError::Argument("a shape"))
        }
    }

    /// The side that was given.
    ///
    /// # Errors
    /// Something else was given.
    pub fn given_side(&self) -> Result<Vec3, AskError> {
        if let Argument::Side(side) = self.argument { Ok(side) } else { Err(AskError::Argument("a side")) }
    }

    /// The ids that were given.
    ///
    /// # Errors
    /// Something else was given.
    pub fn ids(&self) -> Result<&[u64], AskError> {
        if let Argument::Ids(ids) = &self.argument { Ok(ids) } else { Err(AskError::Argument("ids")) }
    }
}

/// Why a measure cannot be made from what was asked.
#[derive(Debug, thiserror::Error)]
pub enum AskError {
    /// Options that contradict each other.
    #[error("{0}")]
    Usage(String),
    /// Settings that the measure cannot have.
    #[error("{0}")]
    Setting(#[from] MeasureError),
    /// A look at the frames has failed.
    #[error("{0}")]
    Look(MeasureError),
    /// An argument of another kind.
    #[error("needs {0}: give it after its option")]
    Argument(&'static str),
}
