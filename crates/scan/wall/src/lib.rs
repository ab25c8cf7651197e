//! From points on a surface to wall spheres: roughness, radii by equation (1), placement, attributes, leak check.
//!
//! One sphere for each point. Neighbours are the pairs of the Gabriel graph (see [`pairs`]); the radii follow from
//! their distances P and the roughness ζ (see [`equation`]).

mod assembly;
pub mod drawn;
mod radii;
mod regions;
mod settings;
mod surface;

pub use assembly::{Wall, WallReport, build, spacing, write_mcap};
pub use radii::{dents, equation, pairs, solve};
pub use regions::{Regions, RegionsError, SurfaceAttributes, attributes, steps, wear};
pub use settings::{Placement, Radius, Representative, WallError, WallSettings};
pub use surface::{bulge, leak, normals, sheets};
