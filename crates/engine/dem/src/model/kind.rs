//! Kinds of contact: those that share a law.

use laws::contact::Composition;
use laws::contact::touch::PatchLaw;

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

impl With {
    /// Whether they meet a wall.
    pub fn is_wall(self) -> bool {
        matches!(self, With::Wall(_))
    }
}

/// Contacts that share a law.
pub struct Kind {
    /// The law.
    pub composition: Box<dyn Composition>,
    /// Materials, lower first; of the particle, then of the wall.
    pub between: (u16, u16),
    /// What they meet.
    pub with: With,
    /// How the contacts of a grain with spheres of a wall share it; `None` where each contact acts by itself.
    pub patch: Option<PatchLaw>,
}
