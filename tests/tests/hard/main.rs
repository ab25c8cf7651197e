//! Hard cases: each stays stable, or is refused with a clear reason and nothing lost.
//!
//! The short forms run with every test; the long ones (10⁷ steps) are ignored and run by `make -C pipelines soak`.

mod bits;
mod bonds;
mod coefficients;
mod columns;
mod far;
mod jams;
mod periodic;
mod points;
mod ratios;
mod rest;
mod roughness;
mod speed;
mod starts;
mod step;
mod turning;
mod variants;
mod zones;
