//! Where particles are: periods and images, margins, spheres.

pub mod cell;
pub mod images;
pub mod margins;
pub mod sphere;
