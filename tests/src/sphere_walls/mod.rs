//! Walls of spheres against the analytic plane: what spacing, roughness and sampling do to rebound, hold, flow and leaks.
//!
//! The centre of a grain of radius r that touches a wall of spheres of radius R lies on the surface at distance R + r from the
//! nearest wall sphere. All closed answers here are those of that surface.

pub mod chance;
pub mod drift;
pub mod filling;
pub mod grazing;
pub mod holding;
pub mod passing;
pub mod plates;
pub mod rebound;
