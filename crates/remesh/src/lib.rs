//! Closed meshes from what is not one: the surface of sampled signed distances.
//!
//! ```text
//! samples   signed distances on a grid
//! composed  samples whose surface is a manifold everywhere
//! nets      their surface, as triangles
//! ```

mod composed;
pub mod nets;
pub mod samples;

pub use nets::surface;
pub use samples::Samples;
