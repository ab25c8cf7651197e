//! What a wall is asked for, and why it cannot be built.

use crate::regions::RegionsError;
use crate::regions::attributes::AttributeError;
use geom::{Shown, Vec3};
use serde::Serialize;
use thiserror::Error;

/// How the radii are found.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Radius {
    /// Point by point, from equation (1) for every pair of neighbours.
    #[default]
    Solve,
    /// One for all, from a representative distance.
    Uniform,
    /// Given [m].
    Given(f64),
}

/// The distance that stands for all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Representative {
    /// Mean over the pairs of neighbours.
    #[default]
    Mean,
    /// Median over the pairs of neighbours.
    Median,
}

/// Where a sphere sits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Placement {
    /// Its centre on the point.
    #[default]
    Centre,
    /// Its surface on the point, on the flow side.
    Surface,
}

/// What is wanted.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WallSettings {
    pub radius: Radius,
    /// Distance that stands for all.
    pub representative: Representative,
    /// Place of the spheres.
    pub placement: Placement,
    /// Direction to the flow side; needed for [`Placement::Surface`].
    pub facing: Option<Vec3>,
    /// A position in the flow [m], instead of a direction.
    pub flow_at: Option<Vec3>,
    /// Where scanners stood [m], which saw the side of the flow; they count where neither direction nor position is given.
    pub seen_from: Vec<Vec3>,
    /// Diameter of the smallest particle [m]: checks gaps and sizes.
    pub smallest_particle: Option<f64>,
    /// Diameter of the largest particle [m]: checks sizes.
    pub largest_particle: Option<f64>,
    /// Whether the widest gap is looked for where no smallest particle is given.
    pub gaps: bool,
    /// Whether the points are the centres of a drawing's spheres, whose dents the drawing's report gives.
    pub of_drawing: bool,
    /// Whether the report lists the pairs whose ζ was changed.
    pub list_changes: bool,
}

/// What a wall refuses.
#[derive(Debug, Error)]
pub enum WallError {
    #[error(
        "the cloud has {0} points: a wall needs at least 2 at different positions; check the previous tool"
    )]
    TooFew(usize),
    #[error(
        "most of the {0} points have the same position as another one: sample the cloud first, e.g. with bluenoise-sample"
    )]
    OnePlace(usize),
    #[error(
        "point {index}: coordinates ({x}, {y}, {z}) m are not finite: remove it first, e.g. with cloud-crop"
    )]
    NotFinite { index: usize, x: f64, y: f64, z: f64 },
    #[error(
        "points {first} and {second} at ({x}, {y}, {z}) m have the same position: sample the cloud first, e.g. with bluenoise-sample"
    )]
    Duplicate { first: u32, second: u32, x: f64, y: f64, z: f64 },
    #[error(
        "roughness {roughness:?} m: must be positive, at most half the distance of neighbours, and not so small that the radius, their distance squared over 8 times the roughness, is not a number"
    )]
    NotPositive { roughness: f64 },
    #[error(
        "roughness {} m is more than half of the {which} {} m ({place}): no sphere has dents that deep; \
         use a roughness of at most {} m, or points at least {} m apart",
        Shown(*roughness), Shown(*spacing), Shown(*most), Shown(*need)
    )]
    TooRough { roughness: f64, spacing: f64, which: &'static str, place: String, most: f64, need: f64 },
    #[error("roughness {} m: must be positive and at most the radius of the spheres, {} m", Shown(*roughness), Shown(*radius))]
    DeeperThanRadius { roughness: f64, radius: f64 },
    #[error("the mesh has no triangle with an area: check the drawing")]
    NoArea,
    #[error(
        "roughness and radius give a spacing of {} m: {count:.1e} spheres on {} m² are too many; is the mesh in millimetres? \
         If not, use a larger radius or more roughness", Shown(*spacing), Shown(*area)
    )]
    TooManySpheres { spacing: f64, area: f64, count: f64 },
    #[error("radius {0} m: must be a positive length")]
    BadRadius(f64),
    #[error("a roughness is needed to find the radii: give one, or give the radius itself")]
    NoRoughness,
    #[error(
        "placement on the surface needs the flow side: give its direction, e.g. --facing 0,0,1, or a point in the \
         flow, --flow-at x,y,z"
    )]
    NoFacing,
    #[error(
        "--facing cannot tell the side of this surface: {share:.0} % of what lies most squarely to it faces away, as at ({:.4}, {:.4}, {:.4}) m, as it \
         does in a pipe or around a box; give a position in the flow, --flow-at x,y,z", at[0], at[1], at[2]
    )]
    FacesBothWays { share: f64, at: [f64; 3] },
    #[error(
        "--facing cannot tell the side of this surface, which lies along it (within {angle:.0} degrees): give a direction out of the surface, or a \
         position in the flow, --flow-at x,y,z"
    )]
    FacesAside { angle: f64 },
    #[error("facing ({x}, {y}, {z}): has no direction")]
    BadFacing { x: f64, y: f64, z: f64 },
    #[error("smallest particle {0} m: must be a positive diameter")]
    BadParticle(f64),
    #[error(
        "wall spheres of radius {} m are larger than the whole cloud: the cloud is {} m wide: is it in millimetres? \
         Give all lengths in metres; else use a smaller spacing or more roughness: the radius is about spacing² over 8 times the roughness",
        Shown(*radius), Shown(*width)
    )]
    LargerThanCloud { radius: f64, width: f64 },
    #[error("no point has a neighbour within {} m: a wall needs points of about equal spacing", Shown(*reach))]
    NoPairs { reach: f64 },
    #[error(transparent)]
    Attribute(#[from] AttributeError),
    #[error(transparent)]
    Regions(#[from] RegionsError),
    #[error(transparent)]
    Sample(#[from] sampling::SampleError),
    #[error("column: {0}")]
    Table(#[from] stream::table::TableError),
}
