//! Finds by trial where a configuration turns unstable: contacts that are closed and stay closed, motions so small that everything
//! is linear.

use dem::setup::*;
use dem::{Setup, Simulation, critical_step};
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};

/// True limits of no more than twice the bound.
pub const MEANT: Case =
    case("Time step", "true limit over the bound, for configurations that the bound is made for: at most 2");
/// What is below the bound, as a share of it.
pub const SAFE: Case =
    case("Time step", "true limit, found by bisection, is not below the bound: missing share");
/// Growth at 0.95 of the bound.
pub const STABLE: Case =
    case("Time step", "0.95 of the bound: largest speed within 20 000 steps, over that of the start");

/// Root mean square of the first speeds [m/s]: way below what would open a contact or make it slide.
const SPEED: f64 = 1e-10;
/// Growth that only an instability has [–].
const GROWTH: f64 = 1e4;

/// A configuration at rest under its own pressure.
pub struct Trial {
    pub name: &'static str,
    pub setup: Setup,
    /// Directions that it is stirred along, 0 or 1 [–]; spins only where all are.
    pub ways: Vec3,
}

/// Everywhere.
pub const ALL: Vec3 = Vec3::new(1.0, 1.0, 1.0);

impl Trial {
    /// Gives every grain and clump a small velocity and spin, no two alike.
    fn stirred(&self) -> Simulation {
        let mut setup = self.setup.clone();
        let mut seed = 11u64;
        let mut throw = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let mut vector = |scale: f64| Vec3::new(throw(), throw(), throw()) * (2.0 * scale);
        for p in &mut setup.particles {
            let turns = if self.ways == ALL { 1.0 } else { 0.0 };
            (p.velocity, p.spin) =
                (vector(SPEED).component_mul(&self.ways), turns * vector(SPEED / p.radius));
        }
        for b in &mut setup.clumps.placed {
            (b.velocity, b.spin) = (vector(SPEED), vector(SPEED / 0.01));
        }
        setup.step = Step::Auto(0.5);
        Simulation::new(setup).expect("the setup is sound")
    }

    /// Largest speed of any surface within some steps, over that of the start.
    fn growth(&self, dt: f64, steps: u64) -> f64 {
        let mut sim = self.stirred();
        sim.set_step_unchecked(dt);
        let mut most = 0.0f64;
        for k in 0..steps {
            if sim.step().is_err() {
                return f64::INFINITY;
            }
            if k % 20 == 19 {
                let Ok(particles) = sim.particles() else { return f64::INFINITY };
                let fastest = particles.iter().map(|p| p.velocity.norm().max(p.spin.norm() * p.radius));
                most = fastest.fold(most, |a, b| if b.is_nan() { f64::INFINITY } else { a.max(b) });
                if most > GROWTH * SPEED {
                    return most / SPEED;
                }
            }
        }
        most / SPEED
    }

    /// The bound, and the true limit over it [–], to half a per cent.
    pub fn limit(&self) -> (f64, f64) {
        let bound = critical_step(&self.setup).expect("laws for all pairs").dt;
        let unstable = |share: f64| self.growth(share * bound, 4000) > GROWTH;
        let (mut low, mut high) = (0.5, 8.0);
        assert!(unstable(high), "{}: nothing grows at 8 times the bound", self.name);
        assert!(!unstable(low), "{}: unstable at half of the bound", self.name);
        while high / low > 1.005 {
            let middle = (low * high).sqrt();
            if unstable(middle) { high = middle } else { low = middle }
        }
        (bound, low)
    }

    /// Safe: notes the true limit over the bound, and how the configuration behaves at 0.95.
    pub fn safe(&self) -> f64 {
        let (bound, share) = self.limit();
        println!("{}: bound {bound:.4e} s, true limit {share:.3} of it", self.name);
        SAFE.within(
            &format!("{} (true limit {share:.2} × the bound)", self.name),
            (1.0 - share).max(0.0),
            "–",
            0.005,
        );
        let grown = self.growth(0.95 * bound, 20_000);
        // Where nothing is lost a motion of all may gather in one grain.
        STABLE.within(self.name, grown, "–", 50.0);
        share
    }

    /// Safe, and not wasteful.
    pub fn meant(&self) {
        let share = self.safe();
        MEANT.within(self.name, share, "–", 2.01);
    }
}
