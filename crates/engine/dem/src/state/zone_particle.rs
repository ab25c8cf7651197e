//! A particle that moves by the prescribed motion of a zone.

use crate::setup::Particle;
use geom::Vec3;
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

/// Which zone a particle is in.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Direction {
    Out(u32),
    In(u32),
}

/// A particle in a zone: x(t) = x₀ + v₀ τ + ½ a τ², τ = t − t₀. A member of a clump turns about its centre with the spin that it began with.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ZoneParticle {
    pub at: u32,
    pub since: f64,
    /// Its state then; of a member of a clump, with the velocity of the centre.
    pub start: Particle,
    /// Id of what passes: its own, or that of the first member of its clump.
    pub passing_id: u32,
    /// What must be past the plane, at that time: the centre, or that of the whole clump [m].
    pub centre: Vec3,
    /// And how far before it the point lies that is tested [m].
    pub lead: f64,
    /// Principal axes of the clump to space at that time.
    pub turn: Option<[f64; 4]>,
    /// How a sphere had turned by then that may be bonded; orientation of the clump that comes in.
    pub turned: Option<UnitQuaternion<f64>>,
    pub direction: Direction,
    /// Whether it has been clear of walls since it came in: one that comes in through a wall is carried out of it.
    pub clear: bool,
}
