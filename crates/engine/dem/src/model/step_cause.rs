//! A critical time step, and what sets it.

use std::fmt::{Display, Formatter, Result};

/// A critical step and what sets it.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// Largest stable step [s].
    pub dt: f64,
    /// What sets it.
    pub cause: StepCause,
}

/// The root of A Δt²/4 + B Δt = 1.
pub(crate) fn root(a: f64, b: f64) -> f64 {
    2.0 / ((a + b * b).sqrt() + b)
}

/// What sets the critical time step: a pair, and what shortens the step further by a tenth or more.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StepCause {
    /// The pair with the smallest step; `None` where no contact can occur.
    pub pair: Option<CriticalPair>,
    /// Bonds that shorten the step.
    pub bonds: Option<CriticalBonds>,
    /// Drag that shortens the step.
    pub drag: Option<CriticalDrag>,
    /// The wall whose motion repeats fastest, where that bounds the step more than stability does.
    pub motion: Option<RepeatedMotion>,
}

impl Display for StepCause {
    fn fmt(&self, f: &mut Formatter) -> Result {
        if let Some(motion) = &self.motion {
            write!(f, "{motion}; ")?;
        }
        if let Some(drag) = &self.drag {
            write!(f, "drag {drag}; ")?;
        }
        match (&self.bonds, &self.pair) {
            (Some(bonds), Some(pair)) => write!(f, "{bonds}; {pair}"),
            (Some(bonds), None) => write!(f, "{bonds}"),
            (None, Some(pair)) => write!(f, "{pair}"),
            (None, None) => write!(f, "no contact can occur"),
        }
    }
}

/// Two that can touch.
#[derive(Debug, Clone, PartialEq)]
pub struct CriticalPair {
    /// A particle or clump.
    pub grain: CriticalGrain,
    /// What it touches.
    pub partner: CriticalPartner,
}

impl Display for CriticalPair {
    fn fmt(&self, f: &mut Formatter) -> Result {
        write!(f, "{} – {}", self.grain, self.partner)
    }
}

/// Particles of one size.
#[derive(Debug, Clone, PartialEq)]
pub enum CriticalGrain {
    /// Spheres.
    Sphere {
        /// Name of the material.
        material: String,
        /// Radius [m].
        radius: f64,
    },
    /// Clumps.
    Clump {
        /// Name of the shape.
        shape: String,
        /// Radius of the largest member [m].
        radius: f64,
    },
}

impl Display for CriticalGrain {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            CriticalGrain::Sphere { material, radius } => write!(f, "{material} (radius {radius:.4e} m)"),
            CriticalGrain::Clump { shape, radius } => write!(f, "clump '{shape}' (radius {radius:.4e} m)"),
        }
    }
}

/// What a particle or clump touches.
#[derive(Debug, Clone, PartialEq)]
pub enum CriticalPartner {
    /// Another one.
    Grain(CriticalGrain),
    /// A wall.
    Wall {
        /// Name of the material.
        material: String,
        /// Name of the wall.
        wall: String,
        /// How many times as stiff as one the wall spheres are that push at once, where they lie deep within each other [–].
        spheres: Option<f64>,
    },
}

impl Display for CriticalPartner {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            CriticalPartner::Grain(grain) => write!(f, "{grain}"),
            CriticalPartner::Wall { material, wall, spheres: None } => {
                write!(f, "{material} (wall '{wall}')")
            }
            CriticalPartner::Wall { material, wall, spheres: Some(count) } => {
                write!(f, "{material} (wall '{wall}', {count:.3} times as stiff as one of its spheres)")
            }
        }
    }
}

/// Bonds that shorten the step.
#[derive(Debug, Clone, PartialEq)]
pub struct CriticalBonds {
    /// The particle that they join; `None` for bonds that come in.
    pub particle: Option<BondedParticle>,
    /// The critical step of the bonds alone [s].
    pub alone: f64,
}

/// A particle that bonds join.
#[derive(Debug, Clone, PartialEq)]
pub struct BondedParticle {
    /// Its id.
    pub id: u32,
    /// Name of its material.
    pub material: String,
    /// Its radius [m].
    pub radius: f64,
}

impl Display for CriticalBonds {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let alone = self.alone;
        match &self.particle {
            None => write!(f, "the bonds that come in (alone {alone:.4e} s)"),
            Some(BondedParticle { id, material, radius }) => {
                write!(
                    f,
                    "the bonds of particle {id} ({material}, radius {radius:.4e} m, alone {alone:.4e} s)"
                )
            }
        }
    }
}

/// Least number of steps in a period of a wall's motion: the work of a vibration is then exact to a hundredth.
const STEPS_A_PERIOD: f64 = 20.0;

/// The motion of a wall that repeats.
#[derive(Debug, Clone, PartialEq)]
pub struct RepeatedMotion {
    /// The wall.
    pub wall: String,
    /// Its period [s].
    pub period: f64,
}

impl RepeatedMotion {
    /// The largest step that resolves it [s].
    pub fn step(&self) -> f64 {
        self.period / STEPS_A_PERIOD
    }
}

impl Display for RepeatedMotion {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let RepeatedMotion { wall, period } = self;
        write!(f, "the motion of wall '{wall}', {STEPS_A_PERIOD} steps in a period of {period:.4e} s")
    }
}

/// Drag that shortens the step.
#[derive(Debug, Clone, PartialEq)]
pub struct CriticalDrag {
    /// Radius that it acts on most [m].
    pub radius: f64,
    /// Time in which a velocity decays [s].
    pub relaxation_time: f64,
}

impl Display for CriticalDrag {
    fn fmt(&self, f: &mut Formatter) -> Result {
        write!(f, "on radius {:.4e} m (relaxation time {:.4e} s)", self.radius, self.relaxation_time)
    }
}
