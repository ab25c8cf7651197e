//! The time step, what a force stands for in it, and what is added up over every step.

/// What is added up of walls over every step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WallDetail {
    /// Nothing, at no cost.
    #[default]
    Off,
    /// Whole walls.
    Whole,
    /// Walls, and each wall sphere and triangle that is touched.
    Parts,
}

/// How the time step is chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// This share of the critical step [–].
    Auto(f64),
    /// This step [s]; refused when above the critical one.
    Fixed(f64),
}

/// Which part of a step the force of a contact stands for: contacts begin and end inside a step (docs/theory/time-step.md).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sampling {
    /// The part in which both touch, from half a step before the instant to half a step after it; damping is matched to the step.
    #[default]
    Averaged,
    /// The whole step, where both touch at its instant.
    Sampled,
}

impl Sampling {
    /// How far ahead in time contacts are looked for in steps of `dt` [s].
    pub fn ahead(self, dt: f64) -> f64 {
        match self {
            Sampling::Averaged => 0.5 * dt,
            Sampling::Sampled => 0.0,
        }
    }
}
