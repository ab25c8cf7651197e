//! Stones of real shape: what is measured of a closed mesh, spheres that stand for it, and how stones are placed in a soil.
//!
//! ```text
//! stone       a closed mesh that was checked: volume, centre, inertia, inside, nearest points
//! clean       any triangles or points → a stone
//! triangles   whether triangles meet: exact
//! crossing    whether meshes overlap: exact; whether a mesh crosses itself
//! shape       sieve size, elongation, flatness, convexity, sphericity
//! roundness   how blunt its corners are
//! samples     points inside a stone and on its surface
//! clump       spheres inside a stone: by inner distance, or tangent to the surface; how well they fit
//! library     a folder of stones: names, classes, sieve sizes
//! harmonics   the surface as a sum of spherical harmonics
//! variants    stones between measured ones
//! grading     classes of size with their shares
//! content     the stop rule
//! pack        random stones, one by one, without overlap
//! ```

pub mod clean;
pub mod clump;
pub mod content;
mod crossing;
mod distance;
pub mod grading;
pub mod harmonics;
pub mod library;
pub mod pack;
mod placed;
mod random;
mod roundness;
mod samples;
pub mod shape;
mod sphere;
pub mod stone;
mod tangent;
mod triangles;
pub mod variants;

pub use clean::{Changes, CleanError, CleanSettings, clean_cloud, clean_mesh};
pub use clump::{Clump, ClumpError, ClumpSettings, Fit, Method};
pub use grading::{Class, GradingError};
pub use harmonics::Harmonics;
pub use library::{Library, LibraryStone};
pub use pack::{PackError, PackSettings, Packing, Soil, pack};
pub use placed::PlacedStone;
pub use shape::ShapeMeasures;
pub use stone::{LONGEST, Stone, StoneError};
pub use variants::{Measured, Variant, variants};
