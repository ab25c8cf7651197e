//! Closed meshes from what is not one: signed distances of any triangles, their surface, and fewer faces.
//!
//! ```text
//! samples   signed distances on a grid
//! composed  samples whose surface is a manifold everywhere
//! nets      their surface, as triangles
//! winding   how often triangles wind around a place
//! soup      any triangles → samples
//! pieces    what hangs together
//! surfels   a cloud → triangles
//! decimate  fewer faces
//! ```

mod composed;
pub mod decimate;
pub mod nets;
pub mod pieces;
pub mod samples;
pub mod soup;
pub mod surfels;
pub mod winding;

pub use decimate::decimate;
pub use nets::surface;
pub use samples::Samples;
pub use winding::Winding;
