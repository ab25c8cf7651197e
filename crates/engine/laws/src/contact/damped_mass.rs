//! The mass for which the dashpot of one contact of two bodies is made.

/// Largest factor of a contact: those that hardly touch, of which nothing depends on it, stay within single precision.
pub const MOST: f64 = 1e6;

/// What moves one contact of two bodies.
#[derive(Debug, Clone, Copy)]
pub struct DampedMass {
    /// δ [m].
    overlap: f64,
    /// N, up to a factor.
    force: f64,
    /// What the contact yields to its own force [1/kg].
    own: f64,
    /// By what all forces of the pair of bodies accelerate it, as N/kg; 0 where its own force does more.
    by_all: f64,
}

impl DampedMass {
    /// Of a contact with a force N, which yields `own` [1/kg] to it, and is accelerated by `by_all` (as N/kg) by all forces of the pair of bodies.
    #[inline(always)]
    pub fn new(overlap: f64, force: f64, own: f64, by_all: f64) -> DampedMass {
        let by_all = if by_all > own * force && force > 0.0 { by_all } else { 0.0 };
        DampedMass { overlap, force, own, by_all }
    }

    /// S/m*, up to a factor: how fast the pair moves.
    #[inline(always)]
    pub fn pace(&self) -> f64 {
        if self.by_all > 0.0 { self.by_all / self.overlap } else { self.own * self.force / self.overlap }
    }

    /// By what m* and 1/m* are multiplied in a contact loop that knows `inverse_mass`. What a finite step does to its dashpot depends on how fast the pair
    /// moves, the `pace` of the deepest: 1/m* is such that this is its own, too.
    #[inline(always)]
    pub fn numbers(&self, pace: f64, inverse_mass: f64) -> [f64; 2] {
        let mass =
            if self.by_all > 0.0 { inverse_mass * self.force / self.by_all } else { inverse_mass / self.own };
        let inverse = if self.force > 0.0 {
            pace * self.overlap / (self.force * inverse_mass)
        } else {
            self.own / inverse_mass
        };
        [mass, inverse.min(MOST)]
    }
}
