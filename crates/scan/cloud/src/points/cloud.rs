//! The cloud: positions as `f64`, and every other property as it came.

use geom::Vec3;
use stream::Table;
use thiserror::Error;

/// Points of a scanned surface.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cloud {
    /// Positions [m].
    pub points: Vec<Vec3>,
    /// Every property besides x, y, z, in the order of the file; as many rows as points.
    pub attributes: Table,
    /// Whether x, y, z are `double` in the file (they are written as they came).
    pub double: bool,
    /// Place of x among the columns of the file (y and z follow it), so that order is kept.
    pub position_column: usize,
    /// Comment lines of the header.
    pub comments: Vec<String>,
    /// What a user should know of the file; not written.
    pub warnings: Vec<ReadWarning>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct LengthUnit {
    /// As the file names it.
    pub name: String,
    /// Its length [m].
    pub metres: f64,
}

/// What a reader noticed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ReadWarning {
    #[error("{0}")]
    LeftOut(String),
    #[error("{0}")]
    Digits(String),
    #[error(
        "the coordinate reference system counts in '{}' of {} m, and everything here is in metres: read it with --scale {}, or with \
         --scale 1 if it is in metres all the same", .0.name, .0.metres, .0.metres
    )]
    Unit(LengthUnit),
    #[error(
        "the coordinate reference system has x and y in '{}' of {} m and heights in '{}' of {} m: project them again, with metres for all, \
         e.g. pdal translate IN.las OUT.las reprojection --filters.reprojection.out_srs=EPSG:25832 with the code of the place",
        horizontal.name, horizontal.metres, vertical.name, vertical.metres
    )]
    TwoUnits { horizontal: LengthUnit, vertical: LengthUnit },
    #[error(
        "its header gives x, y and z in '{}' of {} m, and everything here is in metres: read it with --scale {}, or with --scale 1 if it \
         is in metres all the same", .0.name, .0.metres, .0.metres
    )]
    HeaderUnit(LengthUnit),
    #[error(
        "its header gives x in '{}', y in '{}' and z in '{}': write all three in one unit", .0[0].name, .0[1].name, .0[2].name
    )]
    HeaderUnits([LengthUnit; 3]),
    #[error(
        "line {line} ('{text}') is read as a remark, because it has {words} words and the first point {columns} columns: columns 1, 2 and 3 \
         are x, y and z. If they are not, name the columns with --columns"
    )]
    NamesInDoubt { line: usize, text: String, words: usize, columns: usize },
}

impl ReadWarning {
    /// Whether a scale that is given answers it.
    pub fn is_answered_by_scale(&self) -> bool {
        matches!(self, ReadWarning::Unit(_) | ReadWarning::HeaderUnit(_))
    }
}

/// Farther from the origin than any plant is [m]; a scanner's mark for "no echo", such as 3.4e38, is beyond it.
const FARTHEST: f64 = 1e9;

/// First word of a comment that says where a scanner stood.
const VIEWPOINT: &str = "viewpoint";

/// First words of a comment that names the system that coordinates are in.
pub(crate) const SYSTEM: &str = "coordinate reference system";

/// Whether a comment says where a scanner stood.
pub(crate) fn is_viewpoint(line: &str) -> bool {
    stated_viewpoint(line).is_some()
}

/// The position [m] in a comment that says where a scanner stood.
fn stated_viewpoint(line: &str) -> Option<Vec3> {
    let mut words = line.split_whitespace();
    let is_one = words.next() == Some(VIEWPOINT);
    let numbers: Option<Vec<f64>> =
        words.map(|word| word.parse().ok().filter(|c: &f64| c.is_finite())).collect();
    match numbers?[..] {
        [x, y, z] if is_one => Some(Vec3::new(x, y, z)),
        _ => None,
    }
}

/// A point that no scan has.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "point {index}: coordinates ({:e}, {:e}, {:e}) m are farther than {FARTHEST:e} m from the origin: remove it \
     first, e.g. with cloud-crop --keep SHAPE", at.x, at.y, at.z
)]
pub struct TooFar {
    /// Row of the point in the cloud, from 0.
    pub index: usize,
    /// Where it is [m].
    pub at: Vec3,
}

/// Refuses points, with their rows, so far away that their distances cannot be computed with.
pub(crate) fn check_reach<'a>(points: impl IntoIterator<Item = (usize, &'a Vec3)>) -> Result<(), TooFar> {
    let far = |p: &Vec3| p.iter().any(|c| c.is_finite() && c.abs() > FARTHEST);
    let found = points.into_iter().find(|(_, p)| far(p));
    found.map_or(Ok(()), |(index, at)| Err(TooFar { index, at: *at }))
}

/// How a comment begins that says that coordinates were scaled.
const SCALED: &str = "coordinates were multiplied by";

/// Whether comments say that a user has told the unit of the coordinates.
pub(crate) fn unit_is_known(comments: &[String]) -> bool {
    comments.iter().any(|line| line.starts_with(SCALED))
}

impl Cloud {
    /// Refuses points so far away that their distances cannot be computed with.
    ///
    /// # Errors
    /// The first of them.
    pub fn check_reach(&self) -> Result<(), TooFar> {
        check_reach((0..).zip(&self.points))
    }

    /// Multiplies every coordinate, as from millimetres to metres; they are 8-byte numbers from then on, and a comment says so.
    pub fn scale(&mut self, factor: f64) {
        self.points.iter_mut().for_each(|p| *p *= factor);
        self.double = true;
        let viewpoints: Vec<Vec3> = self.viewpoints().collect();
        self.comments.retain(|line| !is_viewpoint(line));
        viewpoints.iter().for_each(|eye| self.add_viewpoint(&(eye * factor)));
        self.comments.push(format!("{SCALED} {factor}"));
    }

    /// Says in the comments and to the user what of the file is not in the cloud.
    pub(crate) fn leave_out(&mut self, what: String) {
        self.comments.push(what.clone());
        self.warnings.push(ReadWarning::LeftOut(what));
    }

    /// Where the scanners stood [m], as comments say that tools pass on.
    pub fn viewpoints(&self) -> impl Iterator<Item = Vec3> + '_ {
        self.comments.iter().filter_map(|line| stated_viewpoint(line))
    }

    /// Adds a comment that says where a scanner stood [m].
    pub fn add_viewpoint(&mut self, eye: &Vec3) {
        self.comments.push(format!("{VIEWPOINT} {} {} {}", eye.x, eye.y, eye.z));
    }

    /// The given points with their properties, in that order.
    pub fn select(&self, rows: &[u32]) -> Cloud {
        Cloud {
            points: rows.iter().map(|&r| self.points[r as usize]).collect(),
            attributes: self.attributes.select(rows),
            comments: self.comments.clone(),
            warnings: self.warnings.clone(),
            ..*self
        }
    }

    /// The points whose coordinates are all finite, and how many were not.
    pub fn finite(self) -> (Cloud, usize) {
        let is_finite = |p: &Vec3| p.x.is_finite() && p.y.is_finite() && p.z.is_finite();
        let bad = self.points.iter().filter(|p| !is_finite(p)).count();
        if bad == 0 {
            return (self, 0);
        }
        let rows = (0u32..).zip(&self.points).filter(|(_, p)| is_finite(p)).map(|(i, _)| i);
        let rows: Vec<u32> = rows.collect();
        (self.select(&rows), bad)
    }
}

/// A viewpoint, as options give it: `x,y,z` [m].
///
/// # Errors
/// Another text.
pub fn viewpoint(text: &str) -> Result<Vec3, String> {
    let wrong = || format!("'{text}' is not x,y,z: give three numbers in m");
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|t| geom::number::finite(t.trim())).collect();
    match numbers.map_err(|_| wrong())?[..] {
        [x, y, z] => Ok(Vec3::new(x, y, z)),
        _ => Err(wrong()),
    }
}
