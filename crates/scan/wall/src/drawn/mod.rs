//! Spheres of one radius inside a drawn structure, and a drawing beside a scan.

mod beside;
mod candidate;
mod cover;
mod place;
mod settle;
mod sides;
mod stretches;

pub use beside::{Beside, beside};
pub use candidate::Drawing;
pub use place::{Drawn, DrawnReport, place};
