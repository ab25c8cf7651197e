//! Contacts that an earlier run has left.

use laws::effects::ContactHistory;

/// History of a contact at the end of a run, from which another one starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KeptContact {
    /// Id of a particle.
    pub id: u32,
    /// What it touches.
    pub partner: KeptPartner,
    /// As `id` sees it.
    pub history: ContactHistory,
}

impl KeptContact {
    /// Whether it is one with a wall.
    pub fn is_of_wall(&self) -> bool {
        matches!(self.partner, KeptPartner::Wall { .. })
    }
}

/// What a particle touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum KeptPartner {
    /// The particle of this id.
    Particle(u32),
    /// An element of a wall: a sphere or a triangle; 0 of a plane.
    Wall {
        /// Index of the wall.
        wall: u32,
        /// Index of its element, in the order of [`WallShape::elements`](crate::setup::WallShape::elements).
        element: u32,
    },
}
