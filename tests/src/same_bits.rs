//! The same bits, whatever computes them.

use crate::setups::particles;
use dem::simd::Width;
use dem::{Setup, Simulation};
use geom::Vec3;

/// Advances a run by so many steps.
///
/// # Panics
/// When a guard stops the run.
pub fn steps(count: u64) -> impl Fn(&mut Simulation) + Sync {
    move |sim| (0..count).for_each(|_| sim.step().expect("within the guards"))
}

/// Every bit of every particle.
pub fn particle_bits(sim: &mut Simulation) -> Vec<u64> {
    bits(particles(sim).iter().flat_map(|p| [p.position, p.velocity, p.spin]))
}

/// Every bit of every particle, and of the force on each wall and how far it has moved.
///
/// # Panics
/// When a guard has tripped.
pub fn wall_bits(sim: &mut Simulation) -> Vec<u64> {
    let walls = sim.wall_forces().expect("sound");
    [particle_bits(sim), bits(walls.iter().flat_map(|w| [w.force, w.shift]))].concat()
}

/// Every bit of vectors.
pub fn bits(vectors: impl Iterator<Item = Vec3>) -> Vec<u64> {
    vectors.flat_map(|v| [v.x, v.y, v.z]).map(f64::to_bits).collect()
}

/// A run in two parts, and what is compared at its end.
pub struct Run<'a, B> {
    /// What is simulated.
    pub setup: &'a (dyn Fn() -> Setup + Sync),
    /// Leads to where the run is saved, and from there to its end.
    pub parts: [&'a (dyn Fn(&mut Simulation) + Sync); 2],
    /// What asks for a result while the run lasts.
    pub look: &'a (dyn Fn(&mut Simulation) + Sync),
    /// What is compared.
    pub bits: &'a (dyn Fn(&mut Simulation) -> B + Sync),
}

impl<B: PartialEq + Send> Run<'_, B> {
    /// Checks that the end is the same for every width of lanes, any number of threads, and when the run is saved and resumed, looked at or
    /// not; returns it.
    ///
    /// # Panics
    /// When it is not the same.
    pub fn check(&self) -> B {
        let new = || Simulation::new((self.setup)()).expect("sound");
        let whole = self.end(new());
        for width in Width::available() {
            let sim = Simulation::with_width((self.setup)(), width).expect("sound");
            assert!(self.end(sim) == whole, "{width:?}");
        }
        for threads in [1, 2, 3, 7] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            assert!(pool.install(|| self.end(new())) == whole, "{threads} threads");
        }
        for looked in [false, true] {
            let mut first = new();
            (self.parts[0])(&mut first);
            if looked {
                (self.look)(&mut first);
            }
            let state = first.checkpoint().to_static();
            let mut second = Simulation::resume((self.setup)(), state).expect("the same setup");
            (self.parts[1])(&mut second);
            assert!((self.bits)(&mut second) == whole, "resumed, looked at: {looked}");
        }
        whole
    }

    /// What is compared at the end of a whole run.
    pub fn end(&self, mut sim: Simulation) -> B {
        self.parts.iter().for_each(|part| part(&mut sim));
        (self.bits)(&mut sim)
    }
}
