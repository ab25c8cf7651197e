//! What hard cases are tried on: every normal law, in every precision that it is offered in.

use dem::setup::*;
use dem::{Setup, Simulation};
use geom::Vec3;
use grainpipe_tests::normals::{Normal, name_of, precisions};
use scene::advice::explain_halt;

/// A normal law in a precision.
#[derive(Debug, Clone, Copy)]
pub struct Variant {
    /// Law, and what adheres.
    pub normal: Normal,
    /// Precision.
    pub precision: Precision,
}

/// All of them; what adheres is offered in double precision only.
pub fn variants() -> Vec<Variant> {
    precisions().map(|(normal, precision)| Variant { normal, precision }).collect()
}

impl Variant {
    /// For messages.
    pub fn name(&self) -> String {
        name_of(&self.normal, self.precision)
    }

    /// Whether contacts are computed in single precision.
    pub fn mixed(&self) -> bool {
        self.precision != Precision::Double
    }

    /// Whether grains adhere.
    pub fn adheres(&self) -> bool {
        self.normal.adheres()
    }

    /// Two materials with this law for every pair, and nothing that rubs.
    pub fn smooth(&self, restitution: f64) -> Setup {
        Setup { precision: self.precision, ..self.normal.setup(restitution) }
    }

    /// With sliding friction, rolling resistance and, where it is offered, twisting resistance.
    pub fn rough(&self, restitution: f64, friction: f64) -> Setup {
        let mut setup = self.smooth(restitution);
        for c in &mut setup.contacts {
            c.set("sliding_friction", friction);
            c.set("rolling_resistance", 0.3);
            c.set("twisting_resistance", Some(0.2).filter(|_| !self.mixed()));
        }
        setup
    }
}

/// A setup that is sound.
pub fn simulation(setup: Setup) -> Simulation {
    Simulation::new(setup).expect("a sound setup")
}

/// So many steps, none of which may trip a guard.
pub fn run(sim: &mut Simulation, steps: u64) {
    for _ in 0..steps {
        sim.step().expect("no guard trips");
    }
}

/// Steps until a guard trips; what it says.
pub fn halt(sim: &mut Simulation, steps: u64) -> Option<String> {
    (0..steps).find_map(|_| sim.step().err()).map(|halt| explain_halt(&halt))
}

/// Largest speed [m/s] and spin [rad/s].
pub fn fastest(all: &[Particle]) -> (f64, f64) {
    let most = |of: fn(&Particle) -> Vec3| all.iter().map(|p| of(p).norm()).fold(0.0, f64::max);
    (most(|p| p.velocity), most(|p| p.spin))
}

/// Largest distance between two states of the same particles [m].
pub fn farthest(a: &[Particle], b: &[Particle]) -> f64 {
    assert_eq!(a.len(), b.len(), "particles were lost");
    a.iter().zip(b).map(|(a, b)| (a.position - b.position).norm()).fold(0.0, f64::max)
}
