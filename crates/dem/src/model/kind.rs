//! Kinds of contact: a pair of materials that particles have, or a wall and a material, with their composition of effects.

use crate::kernel::Kernel;

/// What the particles of a kind of contact meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum With {
    /// Each other.
    Particles,
    /// Each other across a periodic face.
    Images,
    /// The wall of this number.
    Wall(usize),
}

/// Contacts that share a law.
pub struct Kind {
    /// The law.
    pub kernel: Box<dyn Kernel>,
    /// Materials, lower first; of the particle, then of the wall.
    pub between: (u16, u16),
    /// What they meet.
    pub with: With,
}
